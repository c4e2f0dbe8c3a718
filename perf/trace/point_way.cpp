#include "perf/trace/point_way.hpp"

#include <algorithm>

#include "perf/timing.hpp"

namespace grelha::perf {
namespace {

constexpr int kBuilds = 3;

}  // namespace

bool PointWay::enter(const RayBuffer& rays, Cell& cell) {
  time_building(cell);
  grid_.emplace(world_, light_);
  const Points points{.at = {rays.ox.data(), rays.oy.data(), rays.oz.data()},
                      .count = rays.size(),
                      .leaves = rays.leaves.data()};
  blocked_.resize(rays.size());
  if (!is_right(points))
    return false;
  cell.point_grid = cell.ways.size();
  cell.ways.push_back(
      {kGrelha, "point grid", [this, points] { occluded(*grid_, points, blocked_.data()); }, {}});
  return true;
}

bool PointWay::is_right(const Points& points) const {
  std::vector<Ray> rays(points.count);
  for (std::size_t i = 0; i < points.count; ++i) {
    const Float3 from{points.at[0][i], points.at[1][i], points.at[2][i]};
    rays[i] = {from, {light_.x - from.x, light_.y - from.y, light_.z - from.z}, 0, 1};
  }
  std::vector<std::uint8_t> wanted(points.count), found(points.count);
  occluded(world_, rays, wanted);
  occluded(*grid_, points, found.data());
  return found == wanted;
}

void PointWay::time_building(Cell& cell) const {
  cell.point_grid_ns = 1e300;
  for (int i = 0; i < kBuilds; ++i) {
    const double from = cpu_ns();
    const PointGrid built(world_, light_, 1);
    cell.point_grid_ns = std::min(cell.point_grid_ns, cpu_ns() - from);
  }
}

}  // namespace grelha::perf
