#include "src/arrays.hpp"

#include <cstring>
#include <stdexcept>

namespace grelha::python {
namespace {

/// Moves an array's axes but the last into one, by a copy where they do not lie so.
py::array flattened(const py::array& array, const Shape& shape, std::size_t count) {
  for (std::size_t i = 0; i + 1 < shape.size(); ++i)
    if (array.strides(py::ssize_t(i)) != array.strides(py::ssize_t(i) + 1) * shape[i + 1])
      return py::array(array.attr("reshape")(count, 3));
  return array;
}

}  // namespace

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
  const Shape shape(array.shape(), array.shape() + array.ndim());
  return std::string(py::str(array.dtype())) + " array of shape " + text_of(shape);
}

void wrong_type(const char* name, const std::string& what, py::handle given) {
  throw py::type_error(std::string(name) + ": expected " + what + ", found " + text_of(given));
}
void wrong_value(const char* name, const std::string& what, const std::string& given) {
  throw py::value_error(std::string(name) + ": expected " + what + ", found " + given);
}

py::array numbers_in(py::handle given, const char* name, const char* shape) {
  const std::string what = std::string("numbers of shape ") + shape;
  py::array array = py::array::ensure(given);
  if (!array || array.dtype().kind() == 'O')
    wrong_type(name, what, given);
  const py::dtype type = array.dtype();
  if (type.kind() != 'f' && type.kind() != 'i' && type.kind() != 'u')
    wrong_type(name, what, array);
  const bool native = type.byteorder() == '=' || type.byteorder() == '|';
  if (type.kind() == 'f' && (type.itemsize() == 4 || type.itemsize() == 8) && native)
    return array;
  return py::array(array.attr("astype")(type.itemsize() == 2 && type.kind() == 'f' ? "f4" : "f8"));
}

Triples::Triples(py::handle given, const char* name) : array_(numbers_in(given, name, "(..., 3)")) {
  const py::ssize_t axes = array_.ndim();
  if (axes == 0 || array_.shape(axes - 1) != 3)
    wrong_value(name, "shape (..., 3)", text_of(Shape(array_.shape(), array_.shape() + axes)));
  shape_.assign(array_.shape(), array_.shape() + axes - 1);
  for (const py::ssize_t n : shape_)
    count_ *= std::size_t(n);
  if (shape_.size() > 1)
    array_ = flattened(array_, shape_, count_);
  in_double_ = array_.itemsize() == 8;
  data_ = static_cast<const char*>(array_.data());
  axis_stride_ = array_.strides(array_.ndim() - 1);
  stride_ = array_.ndim() > 1 ? array_.strides(array_.ndim() - 2) : 0;
}

double Triples::at(std::size_t i, std::size_t axis) const {
  const char* const from =
      data_ + std::ptrdiff_t(i) * stride_ + std::ptrdiff_t(axis) * axis_stride_;
  if (in_double_) {
    double value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, from, sizeof value);
  return double{value};
}

Shape Triples::full_shape() const {
  Shape shape = shape_;
  shape.push_back(3);
  return shape;
}

bool Triples::lies_as_floats() const {
  constexpr std::ptrdiff_t kSize = sizeof(float);
  return !in_double_ && stride_ % kSize == 0 && axis_stride_ % kSize == 0 &&
         reinterpret_cast<std::uintptr_t>(data_) % alignof(float) == 0;
}
const float* Triples::floats(std::size_t axis) const {
  return reinterpret_cast<const float*>(data_ + std::ptrdiff_t(axis) * axis_stride_);
}
std::ptrdiff_t Triples::stride() const {
  return stride_ / std::ptrdiff_t{sizeof(float)};
}
bool Triples::is_dense() const {
  return lies_as_floats() && axis_stride_ == sizeof(float) &&
         (stride_ == sizeof(Float3) || count_ == 1);
}

std::vector<Float3> Triples::in_frame(const Frame& frame) const {
  std::vector<Float3> points(count_);
  const auto inside = [&](std::size_t i, std::size_t axis) {
    return as_float((at(i, axis) - frame.offset[axis]) * frame.scale);
  };
  for (std::size_t i = 0; i < count_; ++i)
    points[i] = {inside(i, 0), inside(i, 1), inside(i, 2)};
  return points;
}

void expect_rows(const Triples& triples, const char* name) {
  if (triples.shape().size() != 1)
    wrong_value(name, "shape (n, 3)", text_of(triples.full_shape()));
}

Numbers numbers_for(py::handle given, const char* name, const Shape& shape) {
  Numbers numbers;
  if (PyFloat_Check(given.ptr())) {
    numbers.all = PyFloat_AS_DOUBLE(given.ptr());
    return numbers;
  }
  const std::string what = "a number or shape " + text_of(shape);
  const py::array array = numbers_in(given, name, text_of(shape).c_str());
  if (array.ndim() == 0) {
    numbers.all = array.cast<double>();
    return numbers;
  }
  const Shape found(array.shape(), array.shape() + array.ndim());
  if (found != shape)
    wrong_value(name, what, text_of(found));
  const auto floats = py::array_t<float, py::array::c_style | py::array::forcecast>(array);
  numbers.each.assign(floats.data(), floats.data() + floats.size());
  return numbers;
}

py::array_t<std::int64_t> whole_numbers(py::handle given, const char* name, const char* shape) {
  const std::string what = std::string("whole numbers of shape ") + shape;
  const py::array array = py::array::ensure(given);
  if (!array || array.dtype().kind() == 'O')
    wrong_type(name, what, given);
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u' && array.size() > 0)
    wrong_type(name, what, array);
  return py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
}

double number_in(py::handle given, const char* name) {
  const double value = PyFloat_AsDouble(given.ptr());
  if (value == -1 && PyErr_Occurred()) {
    PyErr_Clear();
    wrong_type(name, "a number", given);
  }
  return value;
}

int whole_number_in(py::handle given, const char* name, int least, int most) {
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
