#pragma once
// Rays to a light through a grid in its perspective: one way more of Grelha's.

#include <optional>

#include "grelha/point_grid.hpp"
#include "perf/trace/cell.hpp"

namespace grelha::perf {

class PointWay {
 public:
  PointWay(const World& world, const Float3& light) : world_(world), light_(light) {}
  /// Builds the grid and enters it as a way of the cell that traces these rays, which must outlive
  /// the cell as this must. False: its answers are not those of the World for the rays from the
  /// same points to the light.
  bool enter(const RayBuffer& rays, Cell& cell);

 private:
  bool is_right(const Points& points) const;
  void time_building(Cell& cell) const;

  const World& world_;
  Float3 light_;
  std::optional<PointGrid> grid_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace grelha::perf
