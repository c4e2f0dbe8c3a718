#include "src/arrays.hpp"

#include <algorithm>

namespace grelha::python {
namespace {

/// Moves an array's axes but the last into one, by a copy where they do not lie so.
py::array flattened(const py::array& array, const Shape& shape, std::size_t count) {
  for (std::size_t i = 0; i + 1 < shape.size(); ++i)
    if (array.strides(py::ssize_t(i)) != array.strides(py::ssize_t(i) + 1) * shape[i + 1])
      return py::array(array.attr("reshape")(count, 3));
  return array;
}

/// numpy.ma.MaskedArray, looked for where an array is not numpy's own. Its mask would be lost.
bool is_masked(py::handle given) {
  // never destroyed: the interpreter may be gone before it
  static const auto* const plain = new py::object(py::module_::import("numpy").attr("ndarray"));
  if (py::type::handle_of(given).is(*plain) || !py::isinstance<py::array>(given))
    return false;
  static const auto* const masked =
      new py::object(py::module_::import("numpy").attr("ma").attr("MaskedArray"));
  return py::isinstance(given, *masked);
}

/// Any array. Throws TypeError for what is none.
py::array array_in(py::handle given, const char* name, const std::string& what) {
  if (is_masked(given))
    throw py::type_error(std::string(name) + ": expected " + what +
                         ", found a masked array; its mask would be lost: fill it first");
  py::array array = py::array::ensure(given);
  if (!array || array.dtype().kind() == 'O')
    wrong_type(name, what, given);
  return array;
}

/// A view of a shape that the array's own broadcasts to.
py::array repeated(const py::array& array, const Shape& shape) {
  static const auto* const to = new py::object(py::module_::import("numpy").attr("broadcast_to"));
  py::tuple axes(shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i)
    axes[i] = shape[i];
  return (*to)(array, axes);
}

/// The numbers of such a view, row after row.
template <class T>
auto repeated_as(const py::array& array, const Shape& shape) {
  using Rows = py::array_t<T, py::array::c_style | py::array::forcecast>;
  return Rows(shape_of(array) == shape ? array : repeated(array, shape));
}

}  // namespace

Shape shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

std::size_t size_of(const Shape& shape) {
  std::size_t count = 1;
  for (const py::ssize_t n : shape)
    count *= std::size_t(n);
  return count;
}

bool broadcast(Shape& shape, const Shape& with) {
  if (with.empty() || with == shape)
    return true;
  Shape both = shape.size() < with.size() ? with : shape;
  const std::size_t common = std::min(shape.size(), with.size());
  for (std::size_t i = 1; i <= common; ++i) {
    const py::ssize_t a = shape[shape.size() - i];
    const py::ssize_t b = with[with.size() - i];
    if (a != b && a != 1 && b != 1)
      return false;
    both[both.size() - i] = a == 1 ? b : a;
  }
  shape = both;
  return true;
}

std::string text_of(const Shape& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i ? ", " : "") + std::to_string(shape[i]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string text_of(py::handle given) {
  if (!py::isinstance<py::array>(given))
    return std::string(py::str(py::type::of(given).attr("__name__")));
  const auto array = py::reinterpret_borrow<py::array>(given);
  return std::string(py::str(array.dtype())) + " array of shape " + text_of(shape_of(array));
}

void wrong_type(const char* name, const std::string& what, py::handle given) {
  throw py::type_error(std::string(name) + ": expected " + what + ", found " + text_of(given));
}
void wrong_value(const char* name, const std::string& what, const std::string& given) {
  throw py::value_error(std::string(name) + ": expected " + what + ", found " + given);
}

py::array numbers_in(py::handle given, const char* name, const char* shape) {
  py::array array = array_in(given, name, std::string("numbers of shape ") + shape);
  const py::dtype type = array.dtype();
  if (type.kind() != 'f' && type.kind() != 'i' && type.kind() != 'u')
    wrong_type(name, std::string("numbers of shape ") + shape, array);
  const bool native = type.byteorder() == '=' || type.byteorder() == '|';
  if (type.kind() == 'f' && (type.itemsize() == 4 || type.itemsize() == 8) && native)
    return array;
  return py::array(array.attr("astype")(type.itemsize() == 2 && type.kind() == 'f' ? "f4" : "f8"));
}

Triples::Triples(py::handle given, const char* name)
    : array_(numbers_in(given, name, "(..., 3)")), rows_(array_) {
  const Shape all = shape_of(array_);
  if (all.empty() || all.back() != 3)
    wrong_value(name, "shape (..., 3)", text_of(all));
  shape_.assign(all.begin(), all.end() - 1);
  points_.name = name;
  look();
}

void Triples::look() {
  points_.count = size_of(shape_);
  rows_ = shape_.size() > 1 ? flattened(array_, shape_, points_.count) : array_;
  points_.in_double = rows_.itemsize() == 8;
  points_.data = static_cast<const char*>(rows_.data());
  points_.axis_stride = rows_.strides(rows_.ndim() - 1);
  points_.stride = rows_.ndim() > 1 ? rows_.strides(rows_.ndim() - 2) : 0;
}

void Triples::repeat(const Shape& shape) {
  if (shape_ == shape || shape_.empty())
    return;
  if (count() == 1) {  // one for all needs no copy for each
    array_ = py::array(array_.attr("reshape")(3));
    shape_.clear();
  } else {
    shape_ = shape;
    array_ = repeated(array_, full_shape());
  }
  look();
}

Shape Triples::full_shape() const {
  Shape shape = shape_;
  shape.push_back(3);
  return shape;
}

bool Triples::lies_as_floats() const {
  constexpr std::ptrdiff_t kSize = sizeof(float);
  return !in_double() && points_.stride % kSize == 0 && points_.axis_stride % kSize == 0 &&
         reinterpret_cast<std::uintptr_t>(points_.data) % alignof(float) == 0;
}

std::vector<Float3> Triples::in_frame(const Frame& frame) const {
  std::vector<Float3> points(count());
  const auto inside = [&](std::size_t i, std::size_t axis) {
    return as_float((points_.at(i, axis) - frame.offset[axis]) * frame.scale);
  };
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {inside(i, 0), inside(i, 1), inside(i, 2)};
  return points;
}

std::span<const Float3> Triples::in_frame(const Frame& frame, std::vector<Float3>& copy) const {
  const bool is_dense = lies_as_floats() && points_.axis_stride == sizeof(float) &&
                        (points_.stride == sizeof(Float3) || count() == 1);
  if (is_dense && frame == Frame{})
    return {reinterpret_cast<const Float3*>(points_.data), count()};
  copy = in_frame(frame);
  return copy;
}

template <class T>
NumbersOf<T>::NumbersOf(py::handle given, const char* name) {
  if (PyFloat_Check(given.ptr())) {
    all = PyFloat_AS_DOUBLE(given.ptr());
    return;
  }
  const py::array array = numbers_in(given, name, "(...)");
  shape_ = shape_of(array);
  if (shape_.empty())
    all = array.cast<double>();
  array_ = array;
}

template <class T>
void NumbersOf<T>::repeat(const Shape& shape) {
  if (shape_.empty())
    return;
  const auto numbers = repeated_as<T>(py::reinterpret_borrow<py::array>(array_), shape);
  each.assign(numbers.data(), numbers.data() + numbers.size());
}

template <class T>
void NumbersOf<T>::fill(const Shape& shape) {
  repeat(shape);
  if (shape_.empty())
    each.assign(size_of(shape), static_cast<T>(all));
}
template class NumbersOf<float>;
template class NumbersOf<double>;

py::array_t<std::int64_t> whole_numbers(py::handle given, const char* name, const char* shape) {
  const std::string what = std::string("whole numbers of shape ") + shape;
  const py::array array = array_in(given, name, what);
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u' && array.size() > 0)
    wrong_type(name, what, array);
  return py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
}

Wholes::Wholes(py::handle given, const char* name) : name_(name) {
  if (given.is_none())
    return;
  const py::array array = whole_numbers(given, name, "(...)");
  shape_ = shape_of(array);
  array_ = array;
}

template <class T>
std::vector<T> Wholes::repeat(const Shape& shape,
                              const std::string& expected,
                              std::int64_t least,
                              std::size_t end) const {
  const auto numbers = repeated_as<std::int64_t>(py::reinterpret_borrow<py::array>(array_), shape);
  std::vector<T> all(std::size_t(numbers.size()));
  std::transform(numbers.data(), numbers.data() + all.size(), all.begin(), [&](std::int64_t n) {
    if (n < least || n >= std::int64_t(end))
      wrong_value(name_, expected, std::to_string(n));
    return static_cast<T>(n);
  });
  return all;
}
template std::vector<std::uint8_t> Wholes::repeat(const Shape&,
                                                  const std::string&,
                                                  std::int64_t,
                                                  std::size_t) const;
template std::vector<std::uint32_t> Wholes::repeat(const Shape&,
                                                   const std::string&,
                                                   std::int64_t,
                                                   std::size_t) const;

double number_in(py::handle given, const char* name) {
  if (PyBool_Check(given.ptr()))
    wrong_type(name, "a number", given);
  const double value = PyFloat_AsDouble(given.ptr());
  if (value == -1 && PyErr_Occurred()) {
    const bool is_large = PyErr_ExceptionMatches(PyExc_OverflowError) != 0;
    PyErr_Clear();
    if (is_large)
      wrong_value(name, "a number of at most 1e308", "a larger one");
    wrong_type(name, "a number", given);
  }
  return value;
}

int whole_number_in(py::handle given, const char* name, int least, int most) {
  if (PyBool_Check(given.ptr()))
    wrong_type(name, "a whole number", given);
  const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  if (!index) {
    PyErr_Clear();
    wrong_type(name, "a whole number", given);
  }
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  if (overflow != 0 || value < least || value > most)
    wrong_value(
        name, std::to_string(least) + " to " + std::to_string(most), std::string(py::str(index)));
  return static_cast<int>(value);
}

int threads_in(py::handle given) {
  constexpr int kMost = 65536;
  return whole_number_in(given, "threads", 0, kMost);
}

}  // namespace grelha::python
