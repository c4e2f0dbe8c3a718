#include "kernel/picture/point_tracer.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include <omp.h>

#include "kernel/shade/setup.hpp"
#include "kernel/shade/workspace.hpp"
#include "kernel/base/parallel_for.hpp"
#include "kernel/picture/subdivider.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

constexpr std::size_t kMostPoints = 2048;  ///< traced at a time

/// Traces points, on one thread.
class PointTracer {
 public:
  PointTracer(const World::Impl& world, const Setup& setup, const RenderOptions& options)
      : world_(world),
        setup_(setup),
        options_(options),
        space_(kMostPoints, options.depth, setup.plan) {}

  void operator()(std::span<const LatticePoint> points, Float3* colours) {
    for (std::size_t first = 0; first < points.size(); first += kMostPoints)
      trace(points.subspan(first, std::min(kMostPoints, points.size() - first)), colours + first);
  }

  void count(RenderStats& stats) const {
    stats.trace += trace_;
    stats.rays += rays_;
    stats.phases += space_.phases();
  }

 private:
  void trace(std::span<const LatticePoint> points, Float3* colours) {
    for (std::size_t i = 0; i < points.size(); ++i) {  // exact: no coordinate is above 2^24
      x_[i] = static_cast<float>(points[i].x) / kLatticeSteps;
      y_[i] = static_cast<float>(points[i].y) / kLatticeSteps;
      space_.pixels()[i] = lattice_hash(points[i]);
    }
    const PointList list{x_, y_, static_cast<int>(points.size())};
    const StripWork work = space_.work(options_, 0, true);
    setup_.variant.loops.render_points(
        world_.view, setup_.shading, setup_.frame, list, work, trace_, rays_);
    const double share = 1 / (kLightUnit * setup_.plan.samples);
    const auto colour = [share](std::int64_t sum) {
      return static_cast<float>(static_cast<double>(sum) * share);
    };
    const std::int64_t* sum = space_.sums().data();
    for (std::size_t i = 0; i < points.size(); ++i, sum += 3)
      colours[i] = {colour(sum[0]), colour(sum[1]), colour(sum[2])};
    space_.done(options_);
  }

  const World::Impl& world_;
  const Setup& setup_;
  const RenderOptions& options_;
  Workspace space_;
  float x_[kMostPoints], y_[kMostPoints];
  TraceCounts trace_;
  RayCounts rays_;
};

void check(const SubdivisionState& picture, const Camera& camera, const RenderOptions& options) {
  if (!options.subdivision.on)
    throw std::invalid_argument("this picture is one by subdivision");
  if (picture.image.width != camera.width || picture.image.height != camera.height)
    throw std::invalid_argument("this picture has another size than the camera's");
  check_subdivision(options.subdivision);
}

/// Makes the tiles that are not done, until progress says to stop.
void make_tiles(const Tiles& tiles,
                const RenderOptions& options,
                GuardedProgress& progress,
                const std::vector<std::unique_ptr<PointTracer>>& tracers,
                SubdivisionState& picture) {
  const auto note = [&](std::size_t tile) {
    picture.done[tile] = 1;
    const auto done = std::count(picture.done.begin(), picture.done.end(), std::uint8_t{1});
    picture.share = static_cast<double>(done) / static_cast<double>(tiles.size());
    if (!progress.stopped())
      progress.report(picture.share);
  };
  Thrown thrown;
#pragma omp parallel for num_threads(static_cast <int>(tracers.size())) schedule(dynamic)
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    thrown.in([&] {
      PointTracer& tracer = *tracers[static_cast<std::size_t>(omp_get_thread_num())];
      if (picture.done[tile] != 0 || progress.stopped())
        return;
      subdivide(tiles[tile], options.subdivision, std::ref(tracer), picture.image);
#pragma omp critical(grelha_progress)
      note(tile);
    });
  thrown.on();
}

}  // namespace

bool render_subdivided(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       SubdivisionState& picture,
                       RenderStats& stats,
                       const ShouldContinue& should_continue) {
  const Setup setup = set_up(world, camera, options);
  check(picture, camera, options);
  const Tiles tiles(picture.image, options.subdivision);
  if (picture.done.empty())
    picture.done.resize(tiles.size());
  if (picture.done.size() != tiles.size())
    throw std::invalid_argument("this picture was made in tiles of another size");
  stats = {};
  stats.threads = thread_count(options, tiles.size());
  stats.isa = setup.variant.name.data();
  GuardedProgress progress(options.progress, should_continue);
  std::vector<std::unique_ptr<PointTracer>> tracers;
  for (int i = 0; i < stats.threads; ++i)
    tracers.push_back(std::make_unique<PointTracer>(world.impl(), setup, options));
  do
    make_tiles(tiles, options, progress, tracers, picture);
  while (picture.share < 1 && progress.stopped() && progress.resume());
  for (const auto& tracer : tracers)
    tracer->count(stats);
  progress.rethrow();
  return picture.share == 1;
}

}  // namespace grelha
