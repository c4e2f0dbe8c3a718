#include "kernel/subdivision/point_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include <omp.h>

#include "kernel/world/world_impl.hpp"
#include "kernel/subdivision/subdivider.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/render/workspace.hpp"

namespace grelha {
namespace {

constexpr int kMostPoints = 2048;  ///< a thread takes at a time

/// What one thread needs.
struct PointSpace {
  PointSpace(int depth, const SamplePlan& plan, const TraceLoops* in_double)
      : space(kMostPoints, depth, plan, in_double) {}

  void place(std::span<const LatticePoint> points) {
    std::uint32_t* const names = space.pixels().data();
    for (std::size_t i = 0; i < points.size(); ++i) {  // exact: no coordinate is above 2^24
      x[i] = static_cast<float>(points[i].x) / kLatticeSteps;
      y[i] = static_cast<float>(points[i].y) / kLatticeSteps;
      names[i] = lattice_hash(points[i]);
    }
  }

  Workspace space;
  float x[kMostPoints], y[kMostPoints];
  TraceCounts trace;
  RayCounts rays;
};

/// Traces lists of points in parallel.
class PointTracer {
 public:
  PointTracer(const World::Impl& world,
              const Setup& setup,
              const RenderOptions& options,
              GuardedProgress& progress,
              int threads)
      : world_(world), setup_(setup), options_(options), progress_(progress) {
    for (int i = 0; i < threads; ++i)
      spaces_.push_back(std::make_unique<PointSpace>(
          options.depth, setup.plan, loops_of(setup.variant, options.precision)));
  }

  std::size_t operator()(std::span<const LatticePoint> points,
                         Float3* colours,
                         double from,
                         double to) {
    const std::size_t chunk = chunk_of(points.size());
    const std::size_t chunks = (points.size() + chunk - 1) / chunk;
    const std::size_t team = std::min(spaces_.size(), std::max<std::size_t>(chunks, 1));
    std::atomic<std::size_t> begun = 0;
    std::size_t done = 0;
#pragma omp parallel num_threads(static_cast <int>(team))
    while (!progress_.stopped()) {
      // what has a number is done, so that what is done is the first so many
      const std::size_t c = begun++;
      if (c >= chunks)
        break;
      const std::size_t first = c * chunk;
      const auto mine = points.subspan(first, std::min(chunk, points.size() - first));
      trace(*spaces_[static_cast<std::size_t>(omp_get_thread_num())], mine, colours + first);
#pragma omp critical(grelha_progress)
      tell(from + (to - from) * static_cast<double>(++done) / static_cast<double>(chunks));
    }
    return std::min(begun * chunk, points.size());
  }

  void count(RenderStats& stats) const {
    for (const auto& s : spaces_) {
      stats.trace += s->trace;
      stats.rays += s->rays;
      stats.phases += s->space.phases();
    }
  }

 private:
  /// Points a thread takes at a time: whole packets, large enough to be worth taking, small enough
  /// that no thread waits long for the last.
  std::size_t chunk_of(std::size_t points) const {
    return std::clamp<std::size_t>(points / (8 * spaces_.size()) / 64 * 64, 64, kMostPoints);
  }

  void tell(double share) {
    if (!progress_.stopped())
      progress_.tell(share);
  }

  void trace(PointSpace& s, std::span<const LatticePoint> points, Float3* colours) const {
    s.place(points);
    const PointList list{s.x, s.y, static_cast<int>(points.size())};
    const BandWork work = s.space.work(options_, 0, true);
    setup_.variant.loops.render_points(
        world_.view, setup_.shading, setup_.frame, list, work, s.trace, s.rays);
    const double share = 1 / (kLightUnit * setup_.plan.samples);
    const auto colour = [share](std::int64_t sum) {
      return static_cast<float>(static_cast<double>(sum) * share);
    };
    const std::int64_t* sum = s.space.sums().data();
    for (std::size_t i = 0; i < points.size(); ++i, sum += 3)
      colours[i] = {colour(sum[0]), colour(sum[1]), colour(sum[2])};
    s.space.done(options_);
  }

  const World::Impl& world_;
  const Setup& setup_;
  const RenderOptions& options_;
  GuardedProgress& progress_;
  std::vector<std::unique_ptr<PointSpace>> spaces_;
};

void check(const SubdivisionState& picture, const Camera& camera, const RenderOptions& options) {
  if (!options.subdivision.on)
    throw std::invalid_argument("this picture is one by subdivision");
  if (picture.image.width != camera.width || picture.image.height != camera.height)
    throw std::invalid_argument("this picture has another size than the camera's");
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
  stats = {};
  stats.threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  stats.isa = setup.variant.name.data();
  GuardedProgress progress(options.progress, should_continue);
  PointTracer tracer(world.impl(), setup, options, progress, stats.threads);
  const bool finished = subdivide(
      picture, options.subdivision, std::ref(tracer), 0, [&] { return progress.resume(); });
  tracer.count(stats);
  progress.rethrow();
  return finished;
}

}  // namespace grelha
