#pragma once
// The rays of one call.

#include <cstdint>
#include <span>
#include <vector>

#include "grelha/rays.hpp"
#include "src/arrays.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// What a caller says of rays.
struct RayArguments {
  py::handle origins, directions, t_min, t_max, skip, mask;
  py::handle masks;  ///< of the primitives: uint8 (primitives,), or None
};

/// Rays as the kernel reads them, from the caller's arrays where they lie so.
class RayBatch {
 public:
  /// Throws TypeError or ValueError that name the argument. Needs Python's lock.
  RayBatch(const Model& model, const RayArguments& given);

  const Shape& shape() const { return shape_; }  ///< of the answers; empty: of one ray
  std::size_t count() const { return count_; }

  /// Copies what does not lie as the kernel wants it. Needs no lock.
  Rays rays();
  std::span<const std::uint8_t> masks() const { return masks_; }  ///< QueryOptions::mask

 private:
  struct Column {
    Triples given;
    std::vector<Float3> copy{};
    /// Points to the floats, and says how far they are apart.
    void place(const Frame& frame, const float* (&axes)[3], std::ptrdiff_t& stride);
  };
  void share_shape(const Wholes& skip, const Wholes& mask);
  void place_range(Rays& rays);

  const Model& model_;
  Column origins_, directions_;
  Shape shape_;
  std::size_t count_ = 1;
  Numbers t_min_, t_max_;
  std::vector<std::uint32_t> skip_;
  std::vector<std::uint8_t> mask_;
  std::span<const std::uint8_t> masks_;
};

}  // namespace grelha::python
