#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scene/cutting_sweep.hpp"
#include "frontend/scene/sweep_line.hpp"

namespace grelha {

/// The outline of a polygon. If necessary it is arranged: cut into edges that meet only at their
/// ends.
///
/// A sweep finds where sides cross, touch or lie on each other (Bentley and Ottmann 1979) and cuts
/// them there. A point where two cross is rounded, which may move a side over another; so sweeps
/// follow until one finds nothing. That one proves it, and fills what the outline holds. Of n sides
/// with k crossings a sweep takes (n + k) log n steps.
class Outline {
 public:
  enum class State {
    kSimple,    ///< sides share nothing but the corner between neighbours
    kWasCut,    ///< sides met elsewhere, and were cut there
    kCutLimit,  ///< it would take more than kMostCuts cuts, or too many sweeps
  };
  static constexpr std::size_t kMostCuts = std::size_t(1) << 19;

  /// Corners in turn; the last is joined to the first.
  explicit Outline(std::span<const Point2> corner_points);

  State arrange();

  /// The inside of a cut outline, over the corners and, behind them, the intersections.
  const EvenOddFill& fill() const { return fill_; }
  const std::vector<OutlineCrossing>& intersections() const { return intersections_; }
  /// How far along a side a point is, as a share of it.
  double share_of(std::uint32_t side, const Point2& point) const;

 private:
  bool simplify();
  void merge_equal_edges();
  bool try_fill();
  double grid_step() const;

  std::vector<Point2> corner_points_;   ///< in a plane that may be sheared, as are all points
  std::vector<Point2> points_;          ///< as they are swept
  std::vector<std::uint32_t> numbers_;  ///< [points] of the corner or, behind them, the crossing
  std::vector<OutlineCrossing> intersections_;
  std::vector<OutlineEdge> edges_;
  EvenOddFill fill_;
  bool is_doubled_ = false;  ///< sides that lie on each other turn round the inside more than once
};

}  // namespace grelha
