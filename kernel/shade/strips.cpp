#include "kernel/shade/strips.hpp"

#include <atomic>
#include <memory>

#include <omp.h>

#include "kernel/shade/workspace.hpp"

namespace grelha {

namespace {

using Spaces = std::vector<std::unique_ptr<Workspace>>;

/// A workspace a thread. Allocated before the threads start, where running out of memory can still
/// be told: an exception must not leave a parallel region.
Spaces strip_spaces(const Setup& setup, const RenderOptions& options, int threads) {
  const std::size_t sums = static_cast<std::size_t>(setup.frame.width) * kStripRows;
  Spaces spaces;
  for (int i = 0; i < threads; ++i)
    spaces.push_back(std::make_unique<Workspace>(sums, options.depth, setup.plan));
  return spaces;
}

void add_counts(const RenderStats& mine, RenderStats& all) {
  all.trace += mine.trace;
  all.rays += mine.rays;
  all.phases += mine.phases;
}

}  // namespace

void render_strips(const World::Impl& world,
                   const Setup& setup,
                   const RenderOptions& options,
                   std::size_t most,
                   const NextStrip& next,
                   const TakeStrip& take,
                   RenderStats& stats) {
  stats = {};
  stats.threads = thread_count(options, most);
  stats.isa = setup.variant.name.data();
  const Spaces spaces = strip_spaces(setup, options, stats.threads);
  const auto first_pixel = [&](const Strip& strip) {
    return static_cast<std::uint32_t>(strip.part.rows.begin) *
           static_cast<std::uint32_t>(setup.frame.width);
  };
  std::atomic<bool> stopped = false;
#pragma omp parallel num_threads(stats.threads)
  {
    Workspace& space = *spaces[static_cast<std::size_t>(omp_get_thread_num())];
    RenderStats mine;
#pragma omp for schedule(dynamic) nowait
    for (std::size_t turn = 0; turn < most; ++turn) {
      Strip strip;
      if (stopped || !next(turn, strip)) {
        stopped = true;
        continue;
      }
      const StripWork work = space.work(options, first_pixel(strip));
      setup.variant.loops.render_strip(
          world.view, setup.shading, setup.frame, strip.part, work, mine.trace, mine.rays);
      if (!take(strip, space.sums().data()))
        stopped = true;
      space.done(options);
    }
    mine.phases = space.phases();
#pragma omp critical(grelha_stats)
    add_counts(mine, stats);
  }
}

}  // namespace grelha
