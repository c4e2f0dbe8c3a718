#pragma once
// Whether points see one point, asked for many of them: a light, a camera.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "grelha/geometry.hpp"
#include "grelha/query.hpp"
#include "grelha/world.hpp"

namespace grelha {

/// What is seen of a World from one point, in tiles of directions. Many rays that end at the point
/// meet what is in their way in one look-up each, where a World has to walk. It pays from some 10
/// rays a primitive on (docs/perspective.md). It does not change; any number of threads may ask it.
class PointGrid {
 public:
  /// Built by `threads` threads, or with 0 by one per processor. The World must outlive it. Throws
  /// std::invalid_argument for a point that is no number.
  PointGrid(const World& world, Float3 point, int threads = 0);
  /// The other is empty afterwards.
  PointGrid(PointGrid&&) noexcept;
  /// The same.
  PointGrid& operator=(PointGrid&&) noexcept;
  ~PointGrid();

  /// The point.
  Float3 point() const;
  /// Memory of the tiles; 0: rays walk through the World's own grids, since the point is too far
  /// away or since more than a hundred primitives stand one behind another.
  std::size_t bytes() const;

  struct Impl;
  /// For the library's own use.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// A view of points in arrays that the caller owns.
struct Points {
  const float* at[3] = {};  ///< component a of point i: at[a][i * stride]
  std::size_t count = 0;
  std::ptrdiff_t stride = 1;  ///< in floats
  /// [count] the primitive that each point lies on, where it cannot hide the grid's point from it.
  /// That is a triangle, or one that is round and left outwards. It is not tested, which saves time
  /// and changes no answer. kNoPrimitive: none. Null: none of any.
  const std::uint32_t* leaves = nullptr;

  /// A view of an array of points.
  static Points of(std::span<const Float3> points);
};

/// Whether anything is between each point and the grid's: blocked[i] becomes 1 or 0. The answer is
/// that of occluded() for the ray that starts at the point, goes to the grid's point in direction
/// (grid's point - point) and ends there, at t = 1. Points on a surface start at leave(). Throws
/// as occluded() does.
void occluded(const PointGrid& grid,
              const Points& points,
              std::uint8_t* blocked,
              const QueryOptions& options = {},
              TraceCounts* counts = nullptr);

}  // namespace grelha
