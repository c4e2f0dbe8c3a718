#include "kernel/render.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <omp.h>

#include "kernel/frame.hpp"
#include "kernel/point_tracer.hpp"
#include "kernel/refinement.hpp"
#include "kernel/variants.hpp"
#include "kernel/workspace.hpp"
#include "kernel/world.hpp"

namespace grelha {
namespace {

const Variant& choose(std::string_view name) {
  const Variant* const v = find_variant(name);
  if (!v) throw std::invalid_argument("this build has no instruction set \"" + std::string(name) + "\"");
  if (!v->runs_here()) throw std::invalid_argument("this processor has no " + std::string(name));
  return *v;
}

void check(const Camera& camera, const RenderOptions& o) {
  if (!camera_is_sound(camera)) throw std::invalid_argument("the camera cannot see: check eye, at, up, angle and size");
  if (o.depth < 1 || o.depth > kMostDepth) throw std::invalid_argument("depth must be from 1 to " + std::to_string(kMostDepth));
  if (o.packet != 1 && o.packet != 16 && o.packet != 64 && o.packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  const SampleOptions& s = o.sampling;
  if (s.samples < 1 || s.samples > kMostSamples) throw std::invalid_argument("samples must be from 1 to " + std::to_string(kMostSamples));
  if (s.light_rays < 1 || s.light_rays > 4096) throw std::invalid_argument("shadow rays to an area light must be from 1 to 4096");
  if (s.gloss_rays < 0 || s.gloss_rays > 256) throw std::invalid_argument("rays around the mirror direction must be from 0 to 256");
  const RefineOptions& r = o.refine;
  if (!(r.error >= 0) || !(r.seconds >= 0)) throw std::invalid_argument("an error and a time must not be negative");
  if (r.on() && is_jittered(s.sampler))
    throw std::invalid_argument("jittered samples must be counted before they are taken: to meet an error, use sobol or random");
  if (r.on() && s.light_rays > 1) throw std::invalid_argument("to meet an error every sample sends one ray to a light");
  if (r.on() && o.subdivision.on) throw std::invalid_argument("samples are spent by error or by subdivision, not by both");
  if (o.threads < 0) throw std::invalid_argument("threads must not be negative");
}

/// Near-square strata for `count` samples, never fewer.
Strata strata_for(int count) {
  std::uint32_t columns = 1;
  const auto n = static_cast<std::uint32_t>(count);
  while ((columns + 1) * (columns + 1) <= n) ++columns;
  return {columns, (n + columns - 1) / columns};
}

/// Dimensions for the effects that are there, and no others.
SamplePlan plan_samples(const SampleOptions& o, const Camera& camera, const ShadingView& shading) {
  SamplePlan p;
  p.samples = o.samples, p.seed = o.seed, p.light_rays = o.light_rays, p.gloss_rays = shading.gloss ? o.gloss_rays : 0;
  switch (o.sampler) {
    case Sampler::kSobol: p.kind = SamplePlan::kSobol; break;
    case Sampler::kJitter: p.kind = SamplePlan::kJitter; break;
    case Sampler::kUnshuffled: p.kind = SamplePlan::kUnshuffled; break;
    case Sampler::kRandom: p.kind = SamplePlan::kRandom; break;
  }
  int next = 2;
  const auto pair = [&next](bool present) { return present ? (next += 2) - 2 : -1; };
  p.lens = pair(camera.aperture > 0), p.light = pair(shading.area), p.gloss = pair(shading.gloss);
  p.on = o.samples > 1 || next > 2;
  p.pixel_strata = strata_for(o.samples);
  p.light_strata = strata_for(o.samples * o.light_rays);
  p.gloss_strata = strata_for(o.samples * std::max(p.gloss_rays, 1));
  return p;
}

void finish_rows(const std::vector<std::int64_t>& sums, int samples, Image& image, int y0, int y1) {
  const double share = 1 / (kLightUnit * samples);
  float* const out = image.row(y0);
  const std::size_t n = static_cast<std::size_t>(y1 - y0) * static_cast<std::size_t>(image.width) * 3;
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<float>(static_cast<double>(sums[i]) * share);
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

Image render(const World& world, const Camera& camera, const RenderOptions& options, RenderStats& stats, SampleMaps* maps) {
  check(camera, options);
  const Variant& variant = choose(options.isa);
  const World::Impl& w = world.impl();
  const FrameView frame = make_frame(camera);
  SampleOptions sampling = options.sampling;
  const bool to_sample = camera.aperture > 0 || w.shading.area || w.shading.gloss;
  if (options.subdivision.on && !to_sample) sampling.samples = 1;  // rays through one point would all see the same
  SamplePlan plan = plan_samples(sampling, camera, w.shading);
  if (options.subdivision.on) return render_subdivided(w, camera, frame, plan, variant, options, stats);
  if (options.refine.on()) {
    plan.on = true, plan.samples = kMostSamples;
    return refine(w, camera, frame, plan, variant, options, stats, maps);
  }
  Image image(camera.width, camera.height);
  const int bands = (camera.height + kBandRows - 1) / kBandRows;
  const int threads = std::min(options.threads > 0 ? options.threads : omp_get_num_procs(), std::max(bands, 1));
  // Allocated here, where running out of memory can still be told: an exception must not leave a parallel region.
  std::vector<std::unique_ptr<Workspace>> spaces;
  for (int i = 0; i < threads; ++i) spaces.push_back(std::make_unique<Workspace>(static_cast<std::size_t>(camera.width) * kBandRows, options.depth, plan));
  stats = {};
  stats.threads = threads;
  stats.isa = variant.name.data();
  std::atomic<bool> stopped = false;
  int done = 0;
#pragma omp parallel num_threads(threads)
  {
    Workspace& space = *spaces[static_cast<std::size_t>(omp_get_thread_num())];
    TraceCounts trace;
    RayCounts rays;
#pragma omp for schedule(dynamic)
    for (int band = 0; band < bands; ++band) {
      if (stopped) continue;
      const int y0 = band * kBandRows, y1 = std::min(y0 + kBandRows, camera.height);
      variant.loops.render_band(w.view, w.shading, frame, y0, y1, space.work(options, static_cast<std::uint32_t>(y0) * static_cast<std::uint32_t>(camera.width)), trace, rays);
      finish_rows(space.sums(), plan.samples, image, y0, y1);
      space.done(options);
#pragma omp critical(grelha_progress)
      {
        ++done;
        if (options.progress && !stopped && !options.progress(static_cast<double>(done) / bands)) stopped = true;
      }
    }
#pragma omp critical(grelha_stats)
    stats.trace += trace, stats.rays += rays, stats.phases += space.phases();
  }
  return image;
}

}  // namespace grelha
