#pragma once
// What callers give: arrays of numbers, looked at without a copy where their layout allows it.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <pybind11/numpy.h>

#include "frontend/scene/scene_file.hpp"
#include "grelha/coordinates.hpp"

namespace grelha::python {

namespace py = pybind11;

using Shape = std::vector<py::ssize_t>;

Shape shape_of(const py::array& array);
std::size_t size_of(const Shape& shape);  ///< the number of elements
/// Broadcasts a shape with another by numpy's rules. Returns false where these forbid it.
bool broadcast(Shape& shape, const Shape& with);

std::string text_of(const Shape& shape);  ///< "(4, 3)"
/// "float64 array of shape (4, 2)", or the type of what is no array.
std::string text_of(py::handle given);

/// The nearest float; infinity beyond the largest.
inline float as_float(double value) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (std::abs(value) > kLargest)
    return std::copysign(std::numeric_limits<float>::infinity(), value > 0 ? 1.f : -1.f);
  return static_cast<float>(value);
}

/// Throws TypeError "name: expected what, found given".
[[noreturn]] void wrong_type(const char* name, const std::string& what, py::handle given);
/// Throws ValueError "name: expected what, found given".
[[noreturn]] void wrong_value(const char* name, const std::string& what, const std::string& given);

/// Returns an array of float32 or float64 in the machine's byte order; other numbers become these.
py::array numbers_in(py::handle given, const char* name, const char* shape);

/// Points or directions in an array of shape (..., 3), of float32 or float64.
class Triples {
 public:
  /// Throws TypeError or ValueError that name the argument.
  Triples(py::handle given, const char* name);
  /// Broadcasts to a shape, without the last axis. One for all stays one, of an empty shape.
  void repeat(const Shape& shape);

  const Shape& shape() const { return shape_; }  ///< without the last axis
  const PointArray& points() const { return points_; }
  std::size_t count() const { return points_.count; }
  bool in_double() const { return points_.in_double; }
  Shape full_shape() const;  ///< with the last axis

  /// True if the kernel can read the array where it lies.
  bool lies_as_floats() const;

  /// Returns a copy as floats in a frame.
  std::vector<Float3> in_frame(const Frame& frame) const;
  /// Returns the floats where they lie as Float3 in this frame, else fills a copy. Needs no lock.
  std::span<const Float3> in_frame(const Frame& frame, std::vector<Float3>& copy) const;

 private:
  void look();  ///< at the array: where its rows lie

  py::array array_, rows_;  ///< as given; with two axes
  Shape shape_;
  PointArray points_;  ///< all rows
};

/// One number for all rays or points, or one for each, of float or double.
template <class T>
class NumbersOf {
 public:
  /// Throws TypeError that names the argument.
  NumbersOf(py::handle given, const char* name);
  const Shape& shape() const { return shape_; }
  void repeat(const Shape& shape);  ///< broadcasts to a shape: fills `each`
  void fill(const Shape& shape);    ///< the same of one number for all

  double all = 0;
  std::vector<T> each;  ///< empty: `all`

 private:
  py::object array_;  ///< null for a float: an empty array takes long to make
  Shape shape_;
};
using Numbers = NumbersOf<float>;
using Doubles = NumbersOf<double>;

/// Returns whole numbers of an array as int64, row after row. Throws TypeError for other numbers.
py::array_t<std::int64_t> whole_numbers(py::handle given, const char* name, const char* shape);

/// Whole numbers for all rays, or one for each, or None.
class Wholes {
 public:
  /// Throws TypeError that names the argument.
  Wholes(py::handle given, const char* name);
  explicit operator bool() const { return bool(array_); }  ///< false for None
  const Shape& shape() const { return shape_; }
  /// Broadcasts to a shape, unless it is None. Throws ValueError for numbers below `least` or from
  /// `end` on. T is std::uint8_t or std::uint32_t; -1 becomes its largest.
  template <class T>
  std::vector<T> repeat(const Shape& shape,
                        const std::string& expected,
                        std::int64_t least,
                        std::size_t end) const;

 private:
  const char* name_;
  py::object array_;  ///< null for None
  Shape shape_;
};

/// One number. Throws TypeError for what is none.
double number_in(py::handle given, const char* name);
/// One whole number between two others. Throws TypeError or ValueError.
int whole_number_in(py::handle given, const char* name, int least, int most);
/// The number of threads, 0 for all.
int threads_in(py::handle given);

}  // namespace grelha::python
