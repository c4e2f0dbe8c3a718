#include "kernel/shade/strips.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <memory>
#include <omp.h>
#include <stdexcept>
#include <string>
#include <utility>

#include "grelha/render.hpp"
#include "kernel/base/hash.hpp"
#include "kernel/shade/workspace.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {
namespace {

/// A random order of four things.
struct OrderOfFour {
  std::uint32_t place[4] = {0, 1, 2, 3};

  explicit OrderOfFour(std::uint32_t hash) {
    for (std::uint32_t i = 3; i > 0; --i) {
      std::swap(place[i], place[(hash & 0xFFFFu) * (i + 1) >> 16]);
      hash = scattered_bits(hash);
    }
  }
};

class PixelCurve {
 public:
  PixelCurve(int width, int height, std::uint32_t seed)
      : width_(width), height_(height), seed_(scattered_bits(seed)) {
    positions_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }

  /// The square of 2^level pixels a side whose upper left one is (x, y), and whose first position
  /// is `first`.
  void order_square(int x, int y, int level, std::uint32_t first) {
    if (x >= width_ || y >= height_)
      return;
    if (level == 0) {
      positions_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)] = first;
      return;
    }
    const std::uint32_t key = first + static_cast<std::uint32_t>(level);
    const OrderOfFour order(scattered_bits(seed_ ^ scattered_bits(key)));
    const int half = 1 << (level - 1);
    for (int i = 0; i < 4; ++i)
      order_square(x + i % 2 * half,
                   y + i / 2 * half,
                   level - 1,
                   first + (order.place[i] << 2 * (level - 1)));
  }

  std::vector<std::uint32_t> take() { return std::move(positions_); }

 private:
  int width_, height_;
  std::uint32_t seed_;
  std::vector<std::uint32_t> positions_;
};

}  // namespace

std::vector<std::uint32_t> drawing_places(int width, int height, std::uint32_t seed) {
  PixelCurve curve(width, height, seed);
  curve.order_square(0, 0, std::bit_width(static_cast<unsigned>(std::max(width, height)) - 1), 0);
  return curve.take();
}

namespace {

constexpr int kMostLightRays = 4096;
constexpr int kMaxGlossyRays = 256;

/// Near-square strata for `count` samples, never fewer.
Strata strata_for(int count) {
  std::uint32_t columns = 1;
  const auto n = static_cast<std::uint32_t>(count);
  while ((columns + 1) * (columns + 1) <= n)
    ++columns;
  return {columns, (n + columns - 1) / columns, n};
}

SamplePlan::Kind kind_of(Sampler sampler) {
  switch (sampler) {
    case Sampler::kJitter:
      return SamplePlan::kJitter;
    case Sampler::kRandom:
      return SamplePlan::kRandom;
    case Sampler::kBlue:
      return SamplePlan::kBlue;
    case Sampler::kSobol:
      break;
  }
  return SamplePlan::kSobol;
}

/// Strata for the numbers of rays that a plan has.
void set_strata(SamplePlan& p) {
  p.pixel_strata = strata_for(p.samples);
  p.light_strata = strata_for(p.samples * p.light_rays);
  p.glossy_strata = strata_for(p.samples * std::max(p.glossy_rays, 1));
}

/// Dimensions for the effects that are there, and no others.
SamplePlan plan_samples(const SampleOptions& o, const Camera& camera, const ShadingView& shading) {
  SamplePlan p;
  p.samples = o.samples;
  p.seed = o.seed;
  p.light_rays = o.light_rays;
  p.glossy_rays = shading.glossy ? o.glossy_rays : 0;
  p.kind = kind_of(o.sampler);
  int next = 2;
  const auto pair = [&next](bool present) { return present ? (next += 2) - 2 : -1; };
  p.lens = pair(camera.aperture > 0);
  p.light = pair(shading.area);
  p.glossy = pair(shading.glossy);
  p.on = o.samples > 1 || next > 2;
  set_strata(p);
  return p;
}

void require(bool holds, const char* complaint) {
  if (!holds)
    throw std::invalid_argument(complaint);
}

/// Requires 1 to `most` of something.
void require_up_to(int most, int found, const std::string& what) {
  if (found < 1 || found > most)
    throw std::invalid_argument(what + " must be from 1 to " + std::to_string(most));
}

void check_rays(const RenderOptions& o) {
  require_up_to(kMostDepth, o.depth, "depth");
  require(o.min_weight >= 0 && o.min_weight <= 1, "the least weight of a path must be from 0 to 1");
  require(o.packet == 1 || o.packet == 16 || o.packet == 64 || o.packet == 256,
          "a packet holds 1, 16, 64 or 256 rays");
}

void check_samples(const SampleOptions& s) {
  require_up_to(kMostSamples, s.samples, "samples");
  require_up_to(kMostLightRays, s.light_rays, "shadow rays to an area light");
  require(s.glossy_rays >= 0 && s.glossy_rays <= kMaxGlossyRays,
          "rays around the mirror direction must be from 0 to 256");
}

void check_sampler(const RenderOptions& o) {
  require(o.sampling.sampler != Sampler::kBlue || !o.subdivision.on,
          "samples of blue belong to pixels, not to points that divide them");
}

void check_refinement(const RenderOptions& o) {
  const RefineOptions& r = o.refine;
  require(r.error >= 0 && r.seconds >= 0, "an error and a time must not be negative");
  if (!r.on())
    return;
  require(r.most == 0 || (r.most >= kLeastMost && r.most <= kMostSamples),
          "the most samples of a pixel must be from 8 to 65536");
  require(!is_counted_first(o.sampling.sampler),
          "jittered samples and those of blue must be counted before they are taken: to meet an "
          "error, use sobol or random");
  require(o.sampling.light_rays <= 1, "to meet an error every sample sends one ray to a light");
  require(!o.subdivision.on, "samples are spent by error or by subdivision, not by both");
}

/// The samples asked for; a single one where rays through one point would all see the same.
SampleOptions needed_samples(const ShadingView& shading,
                             const Camera& camera,
                             const RenderOptions& options) {
  SampleOptions sampling = options.sampling;
  const bool to_sample = camera.aperture > 0 || shading.area || shading.glossy;
  if (options.subdivision.on && !to_sample)
    sampling.samples = 1;
  return sampling;
}

}  // namespace

void check_options(const Camera& camera, const RenderOptions& options) {
  require(camera_is_valid(camera), "the camera cannot see: check eye, at, up, angle and size");
  check_rays(options);
  check_samples(options.sampling);
  check_sampler(options);
  check_refinement(options);
  require(options.threads >= 0, "threads must not be negative");
}

Setup set_up(const World& world, const Camera& camera, const RenderOptions& options) {
  check_options(camera, options);
  const World::Impl& w = world.impl();
  Setup setup{.variant = choose_variant(options.isa),
              .frame = make_frame(camera),
              .plan = {},
              .shading = w.shading,
              .places = {},
              .lights = {}};
  if (options.misses)
    setup.lights.emplace(std::vector<Light>{}, Float3{1, 1, 1});
  else if (options.lighting)
    setup.lights.emplace(options.lighting->lights, options.lighting->background);
  if (setup.lights)
    setup.lights->show(w.materials, setup.shading);
  if (options.misses)
    setup.shading.emits = setup.shading.reflects = false;
  const SampleOptions sampling = needed_samples(setup.shading, camera, options);
  setup.plan = plan_samples(sampling, camera, setup.shading);
  if (setup.plan.on && setup.plan.kind == SamplePlan::kBlue) {
    setup.places = drawing_places(camera.width, camera.height, sampling.seed);
    setup.plan.places = setup.places.data();
  }
  return setup;
}

int thread_count(const RenderOptions& options, std::size_t pieces) {
  const std::size_t wanted =
      static_cast<std::size_t>(options.threads > 0 ? options.threads : omp_get_num_procs());
  return static_cast<int>(std::clamp<std::size_t>(pieces, 1, wanted));
}

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

std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options) {
  const auto strips = static_cast<std::size_t>((camera.height + kStripRows - 1) / kStripRows);
  const std::size_t sums = static_cast<std::size_t>(camera.width) * kStripRows;
  const auto threads = static_cast<std::uint64_t>(thread_count(options, strips));
  return threads * Workspace::bytes(sums, options.depth, options.sampling.glossy_rays);
}

}  // namespace grelha
