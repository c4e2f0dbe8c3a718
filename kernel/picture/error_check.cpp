#include "kernel/picture/error_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>

#include <omp.h>

#include "kernel/shade/workspace.hpp"
#include "kernel/base/hash.hpp"

namespace grelha {
namespace {

/// Share of the pixels that a check samples again: so few that it costs no more than that, and
/// enough to notice one wrong pixel in a thousand of a picture of 192 x 192 (measured: with .01
/// runs stopped above the error asked for three times as often).
constexpr double kCheckedShare = .05;
constexpr double kMinChecked = 1024;  ///< but of small pictures
constexpr double kMaxChecked = 1. / 8;
/// Blocks that claim most are checked for themselves: few could hold most of an error.
constexpr std::size_t kWorstChecked = 16;
constexpr std::uint32_t kOtherSeed = 0x5BD1E995u;
constexpr std::size_t kPixelsOfTurn = 64;

/// A pixel that is sampled again.
struct CheckedPixel {
  std::uint32_t pixel, block;
  double stands_for;  ///< so many pixels
  std::int64_t sums[3] = {};
};

/// True if block a varies more than b; of equal ones, if it comes first.
bool varies_more(const BlockErrors& errors, std::uint32_t a, std::uint32_t b) {
  return errors.variance(a) != errors.variance(b) ? errors.variance(a) > errors.variance(b) : a < b;
}

/// Blocks by falling variance: the first kWorstChecked.
std::vector<std::uint32_t> worst_blocks(const BlockErrors& errors, std::size_t count) {
  std::vector<std::uint32_t> blocks(count);
  std::iota(blocks.begin(), blocks.end(), 0u);
  const std::size_t worst = std::min(kWorstChecked, count / 16);
  std::nth_element(blocks.begin(),
                   blocks.begin() + static_cast<std::ptrdiff_t>(worst),
                   blocks.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return varies_more(errors, a, b); });
  blocks.resize(worst);
  std::sort(blocks.begin(), blocks.end());
  return blocks;
}

/// Share of the pixels to check for an error asked for. If all m checked pixels are right, 3 / m of
/// all pixels may be off, each by no more than 1.
double share_for(double error, std::size_t pixels) {
  const double count = static_cast<double>(pixels);
  return std::min(std::max(kCheckedShare, std::min(kMaxChecked, kMinChecked / count)),
                  6 / (error * error * count));
}

/// One pixel of each of the blocks that claim the largest variance, then others by a hash, block by
/// block.
std::vector<CheckedPixel> checked_pixels(const Refinement& r,
                                         const BlockErrors& errors,
                                         std::uint32_t seed,
                                         double error) {
  const Blocks blocks = r.blocks();
  const std::vector<std::uint32_t> worst = worst_blocks(errors, blocks.count());
  const double share = share_for(error, r.box.size());
  const std::uint32_t draw = scattered_bits(seed + static_cast<std::uint32_t>(r.checks));
  std::vector<CheckedPixel> checked;
  std::size_t others = 0, of_worst = 0;
  for (std::uint32_t b = 0; b < blocks.count(); ++b) {
    const bool is_worst = std::binary_search(worst.begin(), worst.end(), b);
    const std::size_t in_block = blocks.pixels(b);
    const std::size_t drawn = scattered_bits(b ^ draw) % in_block;
    std::size_t k = 0;
    blocks.each_pixel(b, [&](std::size_t p) {
      const auto pixel = static_cast<std::uint32_t>(p);
      if (is_worst && k++ == drawn)
        checked.push_back({pixel, b, static_cast<double>(in_block)});
      else if (!is_worst && scattered_bits(pixel ^ draw) < share * 0x1p32)
        checked.push_back({pixel, b, 0});
    });
    if (is_worst)
      of_worst += in_block;
  }
  for (const CheckedPixel& a : checked)
    others += a.stands_for == 0;
  for (CheckedPixel& a : checked)
    if (a.stands_for == 0)
      a.stands_for = static_cast<double>(r.box.size() - of_worst) / static_cast<double>(others);
  return checked;
}

double shown(double x) {
  return std::clamp(x, 0., 1.);
}

/// Samples pixels once more.
class Checker {
 public:
  Checker(const World::Impl& world,
          const Setup& setup,
          const RenderOptions& options,
          const Refinement& r,
          RenderStats& stats)
      : world_(world), setup_(setup), options_(options), r_(r), stats_(stats), plan_(setup.plan) {
    plan_.seed = scattered_bits(plan_.seed ^ kOtherSeed);
  }

  /// Gives each pixel as many new samples as it has in the picture.
  void sample(std::vector<CheckedPixel>& pixels) const {
    const int threads = stats_.threads;
#pragma omp parallel num_threads(threads)
    {
      Workspace space(2 * kPixelsOfTurn * kParts, options_.depth, plan_);
      TraceCounts trace;
      RayCounts rays;
#pragma omp for schedule(dynamic)
      for (std::size_t first = 0; first < pixels.size(); first += kPixelsOfTurn) {
        const std::size_t count = std::min(kPixelsOfTurn, pixels.size() - first);
        sample_turn({pixels.data() + first, count}, space, trace, rays);
      }
#pragma omp critical(grelha_stats)
      {
        stats_.trace += trace;
        stats_.rays += rays;
      }
    }
  }

  /// Half the squared difference, mean of a pixel's channels.
  double half_square(const CheckedPixel& of) const {
    const std::uint32_t samples = sample_count(r_, of.block);
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double again = static_cast<double>(of.sums[c]) / (kLightUnit * samples);
      const double d =
          shown(static_cast<double>(mean_so_far(r_, std::size_t{of.pixel} * 3 + c, samples))) -
          shown(again);
      squares += d * d;
    }
    return squares / 6;
  }

 private:
  void sample_turn(std::span<CheckedPixel> pixels,
                   Workspace& space,
                   TraceCounts& trace,
                   RayCounts& rays) const {
    constexpr std::uint32_t kFirst = 1u << kFirstLog;
    PixelRun runs[2 * kPixelsOfTurn];
    CheckedPixel* owner[2 * kPixelsOfTurn];
    int count = 0;
    for (CheckedPixel& a : pixels) {
      // the first samples go to all of a pixel, the others in part to its box
      std::uint32_t begin = 0;
      for (const std::uint32_t end : {kFirst, sample_count(r_, a.block)}) {
        if (begin >= end)
          continue;
        const auto sum = static_cast<std::ptrdiff_t>(count) * kParts;
        std::fill_n(space.pixels().begin() + sum, kParts, a.pixel);
        std::fill_n(space.boxes().begin() + sum, kParts, begin > 0 ? r_.box[a.pixel] : 0);
        owner[count] = &a;
        runs[count++] = {a.pixel, begin, end - begin};
        begin = end;
      }
    }
    const StripWork work = space.work(options_, 0, true, true);
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
  RenderStats& stats_;
  SamplePlan plan_;
};

}  // namespace

bool CheckedPixels::exceeds_error() const {
  return squared - claimed > std::sqrt(difference);
}

double CheckedPixels::error_ratio(double so_far) const {
  if (!(count > 0) || !(claimed > 0))
    return so_far;
  return std::clamp(so_far * squared / claimed, 1., kMaxErrorRatio);
}

void CheckedPixels::add(double half_square, double variance, double samples, double stands_for) {
  const double excess = stands_for * (half_square - variance);
  squared += stands_for * half_square;
  by_sample += stands_for * half_square * samples;
  claimed += stands_for * variance;
  difference += excess * excess;
  fourth += stands_for * half_square * (stands_for * half_square);
  count += stands_for;
}

double ErrorCheck::bound() const {
  const double spread = std::sqrt(agreeing.fourth + others.fourth);
  return mean_square() + kNormalOneSided * spread / (agreeing.count + others.count);
}

ErrorCheck check_error(const World::Impl& world,
                       const Setup& setup,
                       const RenderOptions& options,
                       const BlockErrors& errors,
                       const Refinement& r,
                       RenderStats& stats) {
  std::vector<CheckedPixel> pixels =
      checked_pixels(r, errors, setup.plan.seed, options.refine.error);
  const Checker checker(world, setup, options, r, stats);
  checker.sample(pixels);
  ErrorCheck sum;
  for (const CheckedPixel& a : pixels) {
    CheckedPixels& of = errors.agrees(a.block) ? sum.agreeing : sum.others;
    of.add(checker.half_square(a),
           static_cast<double>(errors.variance(a.block)),
           sample_count(r, a.block),
           a.stands_for);
  }
  return sum;
}

}  // namespace grelha
