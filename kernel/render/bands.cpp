#include "kernel/render/bands.hpp"

#include <atomic>
#include <memory>

#include <omp.h>

#include "kernel/render/workspace.hpp"

namespace grelha {

void render_bands(const World::Impl& world,
                  const Setup& setup,
                  const RenderOptions& options,
                  std::size_t most,
                  const NextBand& next,
                  const TakeBand& take,
                  RenderStats& stats) {
  const std::size_t width = static_cast<std::size_t>(setup.frame.width);
  stats = {};
  stats.threads = thread_count(options, most);
  stats.isa = setup.variant.name.data();
  // Allocated here, where running out of memory can still be told: an exception must not leave a
  // parallel region.
  std::vector<std::unique_ptr<Workspace>> spaces;
  for (int i = 0; i < stats.threads; ++i)
    spaces.push_back(std::make_unique<Workspace>(
        width * kBandRows, options.depth, setup.plan, loops_of(setup.variant, options.precision)));
  std::atomic<bool> stopped = false;
#pragma omp parallel num_threads(stats.threads)
  {
    Workspace& space = *spaces[static_cast<std::size_t>(omp_get_thread_num())];
    TraceCounts trace;
    RayCounts rays;
    for (Band band; !stopped && next(band);) {
      const auto first_pixel =
          static_cast<std::uint32_t>(band.part.rows.begin) * static_cast<std::uint32_t>(width);
      setup.variant.loops.render_band(world.view,
                                      world.shading,
                                      setup.frame,
                                      band.part,
                                      space.work(options, first_pixel),
                                      trace,
                                      rays);
      if (!take(band, space.sums().data()))
        stopped = true;
      space.done(options);
    }
#pragma omp critical(grelha_stats)
    stats.trace += trace, stats.rays += rays, stats.phases += space.phases();
  }
}

}  // namespace grelha
