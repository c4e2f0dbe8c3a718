#include "grelha/render.hpp"

#include <algorithm>
#include <atomic>

#include "grelha/accumulator.hpp"
#include "kernel/render/bands.hpp"
#include "kernel/picture/point_tracer.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/picture/refiner.hpp"
#include "kernel/render/workspace.hpp"
#include "kernel/picture/told.hpp"

namespace grelha {
namespace {

Image render_whole(const World::Impl& world,
                   const Camera& camera,
                   const Setup& setup,
                   const RenderOptions& options,
                   RenderStats& stats) {
  const int samples = setup.plan.samples;
  const auto bands = static_cast<std::size_t>((camera.height + kBandRows - 1) / kBandRows);
  Image image(camera.width, camera.height);
  std::atomic<std::size_t> begun = 0;
  const auto next = [&](Band& band) {
    band.number = begun++;
    const int y = static_cast<int>(band.number) * kBandRows;
    band.part = {{y, std::min(y + kBandRows, camera.height)}, {0, samples}};
    return band.number < bands;
  };
  std::size_t done = 0;
  render_bands(
      world,
      setup,
      options,
      bands,
      next,
      [&](const Band& band, const std::int64_t* sums) {
        mean_light(sums, samples, image, band.part.rows);
        bool go_on = true;
#pragma omp critical(grelha_progress)
        {
          ++done;
          if (options.progress)
            go_on = options.progress(static_cast<double>(done) / static_cast<double>(bands));
        }
        return go_on;
      },
      stats);
  return image;
}

}  // namespace

std::vector<Isa> isas() {
  std::vector<Isa> out;
  for (const std::string_view name : {"scalar", "sse2", "avx2", "avx512"}) {
    const Variant* const v = find_variant(name);
    out.push_back({name, v != nullptr, v != nullptr && v->runs_here()});
  }
  return out;
}

Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps) {
  if (options.subdivision.on) {
    Subdivided s = make_subdivided(camera.width, camera.height);
    render_subdivided(world, camera, options, s, stats);
    return std::move(s.image);
  }
  if (options.refine.on()) {
    Refinement r = make_refinement(camera);
    refine(world, camera, options, r, stats, maps);
    return picture_so_far(r);
  }
  const Told told(options);
  Image image =
      render_whole(world.impl(), camera, set_up(world, camera, options), told.options(), stats);
  told.rethrow();
  return image;
}

std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options) {
  const auto bands = static_cast<std::size_t>((camera.height + kBandRows - 1) / kBandRows);
  const std::size_t sums = static_cast<std::size_t>(camera.width) * kBandRows;
  const auto threads = static_cast<std::uint64_t>(thread_count(options, bands));
  return threads * Workspace::bytes(sums, options.depth, options.sampling.gloss_rays);
}

}  // namespace grelha
