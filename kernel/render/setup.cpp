#include "kernel/render/setup.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <omp.h>

#include "kernel/render/workspace.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

/// Near-square strata for `count` samples, never fewer.
Strata strata_for(int count) {
  std::uint32_t columns = 1;
  const auto n = static_cast<std::uint32_t>(count);
  while ((columns + 1) * (columns + 1) <= n)
    ++columns;
  return {columns, (n + columns - 1) / columns};
}

/// Dimensions for the effects that are there, and no others.
SamplePlan plan_samples(const SampleOptions& o, const Camera& camera, const ShadingView& shading) {
  SamplePlan p;
  p.samples = o.samples;
  p.seed = o.seed;
  p.light_rays = o.light_rays;
  p.gloss_rays = shading.gloss ? o.gloss_rays : 0;
  switch (o.sampler) {
    case Sampler::kSobol:
      p.kind = SamplePlan::kSobol;
      break;
    case Sampler::kJitter:
      p.kind = SamplePlan::kJitter;
      break;
    case Sampler::kUnshuffled:
      p.kind = SamplePlan::kUnshuffled;
      break;
    case Sampler::kRandom:
      p.kind = SamplePlan::kRandom;
      break;
  }
  int next = 2;
  const auto pair = [&next](bool present) { return present ? (next += 2) - 2 : -1; };
  p.lens = pair(camera.aperture > 0);
  p.light = pair(shading.area);
  p.gloss = pair(shading.gloss);
  p.on = o.samples > 1 || next > 2;
  p.pixel_strata = strata_for(o.samples);
  p.light_strata = strata_for(o.samples * o.light_rays);
  p.gloss_strata = strata_for(o.samples * std::max(p.gloss_rays, 1));
  return p;
}

}  // namespace

void check_options(const Camera& camera, const RenderOptions& o) {
  if (!camera_is_sound(camera))
    throw std::invalid_argument("the camera cannot see: check eye, at, up, angle and size");
  if (o.depth < 1 || o.depth > kMostDepth)
    throw std::invalid_argument("depth must be from 1 to " + std::to_string(kMostDepth));
  if (!(o.min_weight >= 0 && o.min_weight <= 1))
    throw std::invalid_argument("the least weight of a path must be from 0 to 1");
  if (o.packet != 1 && o.packet != 16 && o.packet != 64 && o.packet != 256)
    throw std::invalid_argument("a packet holds 1, 16, 64 or 256 rays");
  const SampleOptions& s = o.sampling;
  if (s.samples < 1 || s.samples > kMostSamples)
    throw std::invalid_argument("samples must be from 1 to " + std::to_string(kMostSamples));
  if (s.light_rays < 1 || s.light_rays > 4096)
    throw std::invalid_argument("shadow rays to an area light must be from 1 to 4096");
  if (s.gloss_rays < 0 || s.gloss_rays > 256)
    throw std::invalid_argument("rays around the mirror direction must be from 0 to 256");
  const RefineOptions& r = o.refine;
  if (!(r.error >= 0) || !(r.seconds >= 0))
    throw std::invalid_argument("an error and a time must not be negative");
  if (r.on() && is_jittered(s.sampler))
    throw std::invalid_argument(
        "jittered samples must be counted before they are taken: to meet an error, use sobol or "
        "random");
  if (r.on() && s.light_rays > 1)
    throw std::invalid_argument("to meet an error every sample sends one ray to a light");
  if (r.on() && o.subdivision.on)
    throw std::invalid_argument("samples are spent by error or by subdivision, not by both");
  if (o.threads < 0)
    throw std::invalid_argument("threads must not be negative");
}

Setup set_up(const World& world, const Camera& camera, const RenderOptions& options) {
  check_options(camera, options);
  const World::Impl& w = world.impl();
  SampleOptions sampling = options.sampling;
  const bool to_sample = camera.aperture > 0 || w.shading.area || w.shading.gloss;
  // rays through one point would all see the same
  if (options.subdivision.on && !to_sample)
    sampling.samples = 1;
  return {
      choose_variant(options.isa), make_frame(camera), plan_samples(sampling, camera, w.shading)};
}

int thread_count(const RenderOptions& options, std::size_t pieces) {
  const std::size_t wanted =
      static_cast<std::size_t>(options.threads > 0 ? options.threads : omp_get_num_procs());
  return static_cast<int>(std::clamp<std::size_t>(pieces, 1, wanted));
}

}  // namespace grelha
