#include "kernel/picture/sampling_round.hpp"

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

/// Pixels that tell the error to a few per cent, and pixels that are checked of any picture.
constexpr double kMinChecked = 2048, kFewChecked = 64;
/// Most that a check samples again: an eighth of a small picture, a thirtieth of a large one.
constexpr double kMostShare = 1. / 8, kMostOfLarge = 1. / 32;
/// Blocks that claim most are checked for themselves: few could hold most of an error.
constexpr std::size_t kWorstChecked = 16;
constexpr std::uint32_t kOtherSeed = 0x5BD1E995u;
constexpr std::size_t kPixelsOfTurn = 64;

/// A pixel that is sampled again.
struct CheckedPixel {
  std::uint32_t pixel, block;
  double weight;  ///< so many pixels
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

double pixels_of(const Refinement& r) {
  return static_cast<double>(r.sums.size() / 3);
}

/// Share of the pixels to check. If all m checked pixels are right, 3 / m of all pixels may be off,
/// each by no more than 1: with m = 6 / E^2 that is half of E^2. Where the error lies far below E,
/// fewer tell as much.
double share_for(double error, double claimed, double pixels) {
  const double claim = std::min(1., claimed / error);
  const double enough = std::max(std::min(6 / (error * error), kMostOfLarge * pixels), kMinChecked);
  return std::min(kMostShare, std::max(enough * claim * claim, kFewChecked) / pixels);
}

/// One pixel of each of the blocks that claim the largest variance, then others by a hash, block by
/// block.
std::vector<CheckedPixel> checked_pixels(const Refinement& r,
                                         const BlockErrors& errors,
                                         std::uint32_t seed,
                                         double share) {
  const Blocks blocks = r.blocks();
  const std::vector<std::uint32_t> worst = worst_blocks(errors, blocks.count());
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
    others += a.weight == 0;
  for (CheckedPixel& a : checked)
    if (a.weight == 0)
      a.weight = (pixels_of(r) - static_cast<double>(of_worst)) / static_cast<double>(others);
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

CheckSums check_error(const World::Impl& world,
                      const Setup& setup,
                      const RenderOptions& options,
                      const BlockErrors& errors,
                      const Refinement& r,
                      RenderStats& stats) {
  const double share = share_for(options.refine.error, errors.totals().rmse, pixels_of(r));
  std::vector<CheckedPixel> pixels = checked_pixels(r, errors, setup.plan.seed, share);
  const Checker checker(world, setup, options, r, stats);
  checker.sample(pixels);
  CheckSums sums;
  for (const CheckedPixel& a : pixels) {
    const double y = a.weight * checker.half_square(a);
    if (errors.agrees(a.block)) {
      const double ny = sample_count(r, a.block) * y;
      sums.ny += ny;
      sums.nyny += ny * ny;
      sums.count += a.weight;
      continue;
    }
    const double x = a.weight * static_cast<double>(errors.claim(a.block));
    sums.y += y;
    sums.x += x;
    sums.yy += y * y;
    sums.xy += x * y;
    sums.xx += x * x;
  }
  return sums;
}

}  // namespace grelha
