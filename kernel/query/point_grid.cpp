#include "grelha/point_grid.hpp"

#include <cmath>
#include <stdexcept>

#include <omp.h>

#include "kernel/world/world_impl.hpp"
#include "kernel/query/options.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

struct PointGrid::Impl {
  const World::Impl& world;
  Float3 point;
  std::unique_ptr<ViewedGrid> built;  ///< null: the point is too far away
};

PointGrid::PointGrid(const World& world, Float3 point, int threads) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
    throw std::invalid_argument("a point grid: expected a point, found what is no number");
  if (threads < 0)
    throw std::invalid_argument("threads must not be negative");
  const World::Impl& w = world.impl();
  const int some = threads > 0 ? threads : omp_get_num_procs();
  const LookLoops& loops = best_variant().loops.look;
  impl_ = std::make_unique<Impl>(Impl{w, point, w.light_grids->build(point, some, loops)});
}
PointGrid::PointGrid(PointGrid&&) noexcept = default;
PointGrid& PointGrid::operator=(PointGrid&&) noexcept = default;
PointGrid::~PointGrid() = default;

Float3 PointGrid::point() const {
  return impl_->point;
}

std::size_t PointGrid::bytes() const {
  return impl_->built ? impl_->built->grid.bytes() : 0;
}

Points Points::of(std::span<const Float3> points) {
  if (points.empty())
    return {};
  const Float3& p = points.front();
  return {
      .at = {&p.x, &p.y, &p.z}, .count = points.size(), .stride = sizeof(Float3) / sizeof(float)};
}

void occluded(const PointGrid& grid,
              const Points& points,
              std::uint8_t* blocked,
              const QueryOptions& options,
              TraceCounts* counts) {
  const PointGrid::Impl& g = grid.impl();
  for (const float* const array : points.at)
    if (points.count > 0 && !array)
      throw std::invalid_argument("points: expected an array of each of x, y and z, found null");
  if (points.count > 0 && !blocked)
    throw std::invalid_argument("occluded: expected an array of answers, found null");
  const PointGridView* const view = g.built ? &g.built->view : nullptr;
  TraceCounts unread;
  choose_variant(options.isa)
      .loops.occluded_to(g.world.view,
                         {view, g.point, points},
                         blocked,
                         options_of(options.packet),
                         counts ? *counts : unread);
}

}  // namespace grelha
