#include "kernel/render.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include <omp.h>

#include "kernel/frame.hpp"
#include "kernel/variants.hpp"
#include "kernel/world.hpp"

namespace grelha {
namespace {

/// What one thread works in; allocated before the first ray, never grown.
class Workspace {
 public:
  Workspace(int width, int depth, const SamplePlan& plan)
      : batch_(std::make_unique<Batch>()),
        plan_(plan),
        take_(std::clamp(65536 / (depth * (plan.gloss_rays + 1)), 16, kBatch)),
        capacity_((plan.gloss_rays + 2) * (kBatch + take_ * depth) + kCacheLine),  // the line: see kBatchRow
        floats_(static_cast<std::size_t>(capacity_) * 9),
        words_(static_cast<std::size_t>(capacity_) * 4),
        sums_(static_cast<std::size_t>(width) * kBandRows * 3) {}

  BandWork work(const RenderOptions& options, int first_row, int width) {
    std::fill(sums_.begin(), sums_.end(), 0);
    float* f[9];
    for (std::size_t i = 0; i < 9; ++i) f[i] = floats_.data() + i * static_cast<std::size_t>(capacity_);
    std::uint32_t* w[4];
    for (std::size_t i = 0; i < 4; ++i) w[i] = words_.data() + i * static_cast<std::size_t>(capacity_);
    const RayStack stack{f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], w[0], w[1], w[2], w[3], 0, capacity_};
    const float most = std::min(1048576.f, kMostLight / static_cast<float>(plan_.samples));
    return {batch_.get(), stack, sums_.data(), options.depth, options.packet, take_, options.mailbox,
            static_cast<std::uint32_t>(first_row) * static_cast<std::uint32_t>(width), most, plan_};
  }
  const std::vector<std::int64_t>& sums() const { return sums_; }

 private:
  std::unique_ptr<Batch> batch_;
  SamplePlan plan_;
  int take_, capacity_;
  std::vector<float> floats_;
  std::vector<std::uint32_t> words_;
  std::vector<std::int64_t> sums_;
};

const Variant& choose(std::string_view name) {
  const Variant* const v = find_variant(name);
  if (!v) throw std::invalid_argument("this build has no instruction set \"" + std::string(name) + "\"");
  if (!v->runs_here()) throw std::invalid_argument("this processor has no " + std::string(name));
  return *v;
}

void check(const Camera& camera, const RenderOptions& o) {
  if (!camera_is_sound(camera)) throw std::invalid_argument("the camera cannot see: check eye, at, up, angle and size");
  if (o.depth < 1 || o.depth > kMostDepth) throw std::invalid_argument("depth must be from 1 to " + std::to_string(kMostDepth));
  if (o.packet != 0 && o.packet != 1 && o.packet != 16 && o.packet != 64)
    throw std::invalid_argument("a packet holds 1, 16 or 64 rays");
  const SampleOptions& s = o.sampling;
  if (s.samples < 1 || s.samples > kMostSamples) throw std::invalid_argument("samples must be from 1 to " + std::to_string(kMostSamples));
  if (s.light_rays < 1 || s.light_rays > 4096) throw std::invalid_argument("shadow rays to an area light must be from 1 to 4096");
  if (s.gloss_rays < 0 || s.gloss_rays > 256) throw std::invalid_argument("rays around the mirror direction must be from 0 to 256");
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
  p.kind = o.sampler == Sampler::kSobol ? SamplePlan::kSobol : o.sampler == Sampler::kJitter ? SamplePlan::kJitter : SamplePlan::kRandom;
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

void add(const TraceCounts& from, TraceCounts& to) {
  to.visits += from.visits;
  to.tests.sphere += from.tests.sphere, to.tests.triangle += from.tests.triangle;
  to.tests.cone += from.tests.cone, to.tests.plane += from.tests.plane;
  to.packets.formed += from.packets.formed, to.packets.fell_back += from.packets.fell_back;
  to.packets.lanes_issued += from.packets.lanes_issued, to.packets.lanes_busy += from.packets.lanes_busy;
}

void add(const RayCounts& from, RayCounts& to) {
  to.primary += from.primary, to.shadow += from.shadow, to.reflection += from.reflection, to.refraction += from.refraction;
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

Image render(const World& world, const Camera& camera, const RenderOptions& options, RenderStats& stats) {
  check(camera, options);
  const Variant& variant = choose(options.isa);
  const World::Impl& w = world.impl();
  const FrameView frame = make_frame(camera);
  const SamplePlan plan = plan_samples(options.sampling, camera, w.shading);
  Image image(camera.width, camera.height);
  const int bands = (camera.height + kBandRows - 1) / kBandRows;
  const int threads = std::min(options.threads > 0 ? options.threads : omp_get_num_procs(), std::max(bands, 1));
  // Allocated here, where running out of memory can still be told: an exception must not leave a parallel region.
  std::vector<std::unique_ptr<Workspace>> spaces;
  for (int i = 0; i < threads; ++i) spaces.push_back(std::make_unique<Workspace>(camera.width, options.depth, plan));
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
      variant.loops.render_band(w.view, w.shading, frame, y0, y1, space.work(options, y0, camera.width), trace, rays);
      finish_rows(space.sums(), plan.samples, image, y0, y1);
#pragma omp critical(grelha_progress)
      {
        ++done;
        if (options.progress && !stopped && !options.progress(static_cast<double>(done) / bands)) stopped = true;
      }
    }
#pragma omp critical(grelha_stats)
    add(trace, stats.trace), add(rays, stats.rays);
  }
  return image;
}

}  // namespace grelha
