#include "kernel/render.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <new>
#include <span>
#include <stdexcept>
#include <string>

#include <omp.h>

#include "kernel/frame.hpp"
#include "kernel/subdivision.hpp"
#include "kernel/variants.hpp"
#include "kernel/world.hpp"

namespace grelha {
namespace {

/// What one thread works in; allocated before the first ray, never grown.
class Workspace {
 public:
  Workspace(std::size_t sums, int depth, const SamplePlan& plan)
      : batch_(std::make_unique<Batch>()),
        plan_(plan),
        take_(std::clamp(65536 / (depth * (plan.gloss_rays + 1)), 16, kBatch)),
        capacity_((plan.gloss_rays + 2) * (kBatch + take_ * depth)),
        floats_(static_cast<std::size_t>(capacity_) * 9),
        words_(static_cast<std::size_t>(capacity_) * 4),
        sums_(3 * sums) {}

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

/// One thread's share of a list of points: as its own arrays, then as colours.
struct PointSpace {
  static constexpr int kMost = 2048;
  explicit PointSpace(int depth, const SamplePlan& plan) : space(kMost, depth, plan) {}
  Workspace space;
  float x[kMost], y[kMost];
  std::uint32_t hash[kMost];
  TraceCounts trace;
  RayCounts rays;
};

/// Sees points of a picture for subdivision, in parallel.
class PointTracer {
 public:
  PointTracer(const World::Impl& world, const Camera& camera, const RenderOptions& options, const SamplePlan& plan,
              const Variant& variant, int threads)
      : world_(world), frame_(make_frame(camera)), options_(options), plan_(plan), variant_(variant) {
    for (int i = 0; i < threads; ++i) spaces_.push_back(std::make_unique<PointSpace>(options.depth, plan));
  }

  bool operator()(std::span<const LatticePoint> points, Float3* colours, double from, double to) {
    const auto count = static_cast<std::int64_t>(points.size()), threads = static_cast<std::int64_t>(spaces_.size());
    // Whole packets, large enough to be worth taking, small enough that no thread waits long for the last.
    const std::int64_t chunk = std::clamp<std::int64_t>(count / (8 * threads) / 64 * 64, 64, PointSpace::kMost);
    const std::int64_t chunks = (count + chunk - 1) / chunk;
    std::atomic<bool> stopped = false;
    std::int64_t done = 0;
    const int team = static_cast<int>(std::min(threads, std::max<std::int64_t>(chunks, 1)));
#pragma omp parallel for schedule(dynamic) num_threads(team)
    for (std::int64_t c = 0; c < chunks; ++c) {
      if (stopped) continue;
      const std::int64_t first = c * chunk, last = std::min(first + chunk, count);
      see(*spaces_[static_cast<std::size_t>(omp_get_thread_num())], points.data() + first, static_cast<int>(last - first), colours + first);
#pragma omp critical(grelha_progress)
      {
        ++done;
        const double share = from + (to - from) * static_cast<double>(done) / static_cast<double>(chunks);
        if (options_.progress && !stopped && !options_.progress(share)) stopped = true;
      }
    }
    return !stopped;
  }

  void count(RenderStats& stats) const {
    for (const auto& s : spaces_) add(s->trace, stats.trace), add(s->rays, stats.rays);
  }

 private:
  void see(PointSpace& s, const LatticePoint* points, int count, Float3* colours) const {
    for (int i = 0; i < count; ++i) {  // exact: no coordinate is above 2^24
      s.x[i] = static_cast<float>(points[i].x) / kLatticeSteps, s.y[i] = static_cast<float>(points[i].y) / kLatticeSteps;
      s.hash[i] = lattice_hash(points[i]);
    }
    BandWork work = s.space.work(options_, 0, 0);
    work.pixels = s.hash;
    variant_.loops.render_points(world_.view, world_.shading, frame_, {s.x, s.y, s.hash, count}, work, s.trace, s.rays);
    const double share = 1 / (kLightUnit * plan_.samples);
    const std::int64_t* sum = s.space.sums().data();
    for (int i = 0; i < count; ++i, sum += 3)
      colours[i] = {static_cast<float>(static_cast<double>(sum[0]) * share), static_cast<float>(static_cast<double>(sum[1]) * share),
                    static_cast<float>(static_cast<double>(sum[2]) * share)};
  }

  const World::Impl& world_;
  const FrameView frame_;
  const RenderOptions& options_;
  const SamplePlan& plan_;
  const Variant& variant_;
  std::vector<std::unique_ptr<PointSpace>> spaces_;
};

Image render_subdivided(const World::Impl& world, const Camera& camera, const RenderOptions& options, const Variant& variant,
                        RenderStats& stats) {
  SampleOptions sampling = options.sampling;
  const bool to_sample = camera.aperture > 0 || world.shading.area || world.shading.gloss;
  if (!to_sample) sampling.samples = 1;  // rays through one point would all see the same
  const SamplePlan plan = plan_samples(sampling, camera, world.shading);
  stats = {};
  stats.threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  stats.isa = variant.name.data();
  PointTracer tracer(world, camera, options, plan, variant, stats.threads);
  Image image = subdivide(camera.width, camera.height, options.subdivision, std::ref(tracer));
  tracer.count(stats);
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

Image render(const World& world, const Camera& camera, const RenderOptions& options, RenderStats& stats) {
  check(camera, options);
  const Variant& variant = choose(options.isa);
  const World::Impl& w = world.impl();
  if (options.subdivision.on) return render_subdivided(w, camera, options, variant, stats);
  const FrameView frame = make_frame(camera);
  const SamplePlan plan = plan_samples(options.sampling, camera, w.shading);
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
