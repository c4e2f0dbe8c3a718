#include "kernel/adaptive/audit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>

#include <omp.h>

#include "kernel/render/workspace.hpp"
#include "kernel/scene/hash.hpp"

namespace grelha {
namespace {

constexpr double kAuditedShare = .01;   ///< of pixels
constexpr double kFewestAudited = 256;  ///< but of small pictures
constexpr double kMostAudited = 1. / 16;
/// Those that claim most are audited for themselves: few could hold most of an error.
constexpr std::size_t kWorstAudited = 16;
constexpr std::uint32_t kOtherSeed = 0x5BD1E995u;
constexpr std::size_t kPixelsOfTurn = 64;

struct Sample {
  std::vector<std::uint32_t> pixels;
  std::size_t worst = 0;  ///< the first stand for themselves,
  double stands_for = 1;  ///< each of the others for so many
};

/// The pixels that claim the greatest variances, then others by a hash.
Sample audited_pixels(const Refinement& r, const PixelErrors& errors, std::uint32_t seed) {
  const std::size_t count = r.log.size();
  Sample sample;
  std::vector<std::uint32_t>& pixels = sample.pixels;
  pixels.resize(count);
  std::iota(pixels.begin(), pixels.end(), 0u);
  sample.worst = std::min(kWorstAudited, count / 16);
  const auto worst = pixels.begin() + static_cast<std::ptrdiff_t>(sample.worst);
  std::nth_element(pixels.begin(), worst, pixels.end(), [&](std::uint32_t a, std::uint32_t b) {
    return errors.variance(a) != errors.variance(b) ? errors.variance(a) > errors.variance(b)
                                                    : a < b;
  });
  std::sort(pixels.begin(), worst);
  const double share =
      std::max(kAuditedShare, std::min(kMostAudited, kFewestAudited / static_cast<double>(count)));
  const auto others = std::remove_if(worst, pixels.end(), [&](std::uint32_t p) {
    return !(scattered_bits(p ^ scattered_bits(seed)) < share * 0x1p32);
  });
  pixels.erase(others, pixels.end());
  std::sort(pixels.begin() + static_cast<std::ptrdiff_t>(sample.worst), pixels.end());
  if (pixels.size() > sample.worst)
    sample.stands_for = static_cast<double>(count - sample.worst) /
                        static_cast<double>(pixels.size() - sample.worst);
  return sample;
}

double shown(double x) {
  return std::clamp(x, 0., 1.);
}

/// Samples pixels once more.
class Auditor {
 public:
  Auditor(const World::Impl& world,
          const Setup& setup,
          const RenderOptions& options,
          const Refinement& r,
          int first_log,
          RenderStats& stats)
      : world_(world),
        setup_(setup),
        options_(options),
        r_(r),
        first_(1u << first_log),
        stats_(stats),
        plan_(setup.plan) {
    plan_.seed = scattered_bits(plan_.seed ^ kOtherSeed);
  }

  /// Brings what was sampled of pixels to as many samples as the picture has of them.
  void sample(const std::vector<std::uint32_t>& pixels, AuditSamples& samples) const {
    std::vector<AuditSamples::Pixel*> of;
    of.reserve(pixels.size());
    for (const std::uint32_t p : pixels)
      of.push_back(&samples.pixels[p]);
    const int threads = stats_.threads;
#pragma omp parallel num_threads(threads)
    {
      const TraceLoops* const loops = loops_of(setup_.variant, options_.precision);
      Workspace space(2 * kPixelsOfTurn * kParts, options_.depth, plan_, loops);
      TraceCounts trace;
      RayCounts rays;
#pragma omp for schedule(dynamic)
      for (std::size_t first = 0; first < pixels.size(); first += kPixelsOfTurn) {
        const std::size_t count = std::min(kPixelsOfTurn, pixels.size() - first);
        sample_turn({pixels.data() + first, count}, of.data() + first, space, trace, rays);
      }
#pragma omp critical(grelha_stats)
      {
        stats_.trace += trace;
        stats_.rays += rays;
      }
    }
  }

  /// Half the squared difference, mean of a pixel's channels.
  double half_square(std::uint32_t p, const AuditSamples::Pixel& sampled) const {
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double again = static_cast<double>(sampled.sums[c]) / (kLightUnit * sampled.count);
      const double d =
          shown(static_cast<double>(mean_so_far(r_, std::size_t{p} * 3 + c))) - shown(again);
      squares += d * d;
    }
    return squares / 6;
  }

 private:
  void sample_turn(std::span<const std::uint32_t> pixels,
                   AuditSamples::Pixel* const* of,
                   Workspace& space,
                   TraceCounts& trace,
                   RayCounts& rays) const {
    PixelRun runs[2 * kPixelsOfTurn];
    AuditSamples::Pixel* owner[2 * kPixelsOfTurn];
    int count = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      // the first samples go to all of a pixel, the others in part to its box
      for (const std::uint32_t end : {first_, sample_count(r_, pixels[i])}) {
        const std::uint32_t begin = of[i]->count;
        if (begin >= end)
          continue;
        const auto sum = static_cast<std::ptrdiff_t>(count) * kParts;
        std::fill_n(space.pixels().begin() + sum, kParts, pixels[i]);
        std::fill_n(space.boxes().begin() + sum, kParts, begin > 0 ? r_.box[pixels[i]] : 0);
        owner[count] = of[i];
        runs[count++] = {pixels[i], begin, end - begin};
        of[i]->count = end;
      }
    }
    const BandWork work = space.work(options_, 0, true);
    setup_.variant.loops.render_runs(
        world_.view, setup_.shading, setup_.frame, runs, count, work, trace, rays);
    for (int i = 0; i < count * kParts * 3; ++i)
      owner[i / (kParts * 3)]->sums[i % 3] += space.sums()[static_cast<std::size_t>(i)];
    space.done(options_);
  }

  const World::Impl& world_;
  const Setup& setup_;
  const RenderOptions& options_;
  const Refinement& r_;
  const std::uint32_t first_;
  RenderStats& stats_;
  SamplePlan plan_;
};

}  // namespace

bool AuditedPixels::is_worse() const {
  return squared - claimed > std::sqrt(difference);
}

double AuditedPixels::how_much_worse(double so_far) const {
  if (!(count > 0) || !(claimed > 0))
    return so_far;
  return std::clamp(so_far * squared / claimed, 1., kMostWorse);
}

void AuditedPixels::add(double half_square, double variance, double samples, double stands_for) {
  const double off = stands_for * (half_square - variance);
  squared += stands_for * half_square;
  by_sample += stands_for * half_square * samples;
  claimed += stands_for * variance;
  difference += off * off;
  fourth += stands_for * half_square * (stands_for * half_square);
  count += stands_for;
}

double Audit::bound() const {
  const double spread = std::sqrt(agreeing.fourth + others.fourth);
  return mean_square() + kNormalOneSided * spread / (agreeing.count + others.count);
}

Audit audit(const World::Impl& world,
            const Setup& setup,
            const RenderOptions& options,
            const PixelErrors& errors,
            const Refinement& r,
            int first_log,
            AuditSamples& samples,
            RenderStats& stats) {
  const Sample sample = audited_pixels(r, errors, setup.plan.seed);
  const Auditor auditor(world, setup, options, r, first_log, stats);
  auditor.sample(sample.pixels, samples);
  Audit sum;
  for (std::size_t i = 0; i < sample.pixels.size(); ++i) {
    const std::uint32_t p = sample.pixels[i];
    AuditedPixels& of = errors.agrees(p) ? sum.agreeing : sum.others;
    of.add(auditor.half_square(p, samples.pixels.at(p)),
           static_cast<double>(errors.variance(p)),
           sample_count(r, p),
           i < sample.worst ? 1 : sample.stands_for);
  }
  return sum;
}

}  // namespace grelha
