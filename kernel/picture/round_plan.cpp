// What the next round of a picture doubles: blocks that gain most, or that a check draws.
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "kernel/base/hash.hpp"
#include "kernel/picture/sampling_round.hpp"

namespace grelha {
namespace {

constexpr float kLeastGain = 1e-20f;  ///< below it no block is worth a ray
constexpr double kAim = .97;          ///< of the error asked for
/// Most samples of a round, times those that there are: then errors are estimated anew.
constexpr double kGrowth = 3;

using List = std::vector<std::uint32_t>;

/// log2 of the samples that a pixel may have.
int most_log(const RefineOptions& asked) {
  return asked.most > 0 ? std::bit_width(static_cast<std::uint32_t>(asked.most)) - 1 : kMostLog;
}

double new_samples(const Refinement& r, std::size_t block, int log) {
  return static_cast<double>((std::size_t{1} << log) * r.blocks().pixels(block));
}

/// One doubling of a block: its gain a ray, what it takes off the sum of variances, and the samples
/// it adds.
struct Step {
  float gain;
  std::uint32_t block;
  float drop;
  double samples;
};

/// The next doublings of all blocks by falling gain. `capped`: some may not be taken.
std::vector<Step> next_steps(const Refinement& r,
                             const BlockErrors& errors,
                             int most,
                             bool& capped) {
  const Blocks blocks = r.blocks();
  const float ratio = r.variance_ratio;
  std::vector<Step> steps;
  for (std::uint32_t b = 0; b < r.log.size(); ++b) {
    float gain = errors.gains_per_ray()[b];
    float drop = errors.variance(b) * (1 - ratio) * static_cast<float>(blocks.pixels(b));
    for (int k = 0; k < kMostDoublings && r.log[b] + k < kMostLog && gain > kLeastGain; ++k) {
      if (r.log[b] + k < most)
        steps.push_back({gain, b, drop, new_samples(r, b, r.log[b] + k)});
      else
        capped = true;
      gain *= ratio / 2;
      drop *= ratio;
    }
  }
  std::sort(steps.begin(), steps.end(), [](const Step& x, const Step& y) {
    return x.gain != y.gain ? x.gain > y.gain : x.block < y.block;
  });
  return steps;
}

/// What samples and seconds asked for still buy.
class Budget {
 public:
  Budget(const RefineOptions& asked, const Spent& spent, std::uint64_t rays) {
    if (asked.samples > 0)
      samples_ = static_cast<double>(asked.samples) - static_cast<double>(spent.samples);
    if (asked.seconds > 0)
      rays_ = (asked.seconds / spent.seconds - 1) * static_cast<double>(rays);
  }
  /// Buys samples of so many rays, or tells which limit they exceed.
  Limit take(double samples, double rays) {
    if (samples > samples_)
      return Limit::kSamples;
    if (rays > rays_)
      return Limit::kSeconds;
    samples_ -= samples;
    rays_ -= rays;
    return Limit::kNone;
  }

 private:
  double samples_ = std::numeric_limits<double>::infinity();
  double rays_ = std::numeric_limits<double>::infinity();
};

/// The steps that a round takes: the first so many, and the limit that ends them.
struct Cut {
  std::size_t steps = 0;
  Limit limit = Limit::kNone;
  double rays_to_error = 0;  ///< of the steps that the error asked for takes
};

/// `excess`: of the sum of variances over what the error asked for allows; `round`: most samples.
Cut cut_steps(const Refinement& r,
              const std::vector<Step>& steps,
              double excess,
              Budget budget,
              double round) {
  Cut cut;
  bool is_cut = false;
  for (const Step& s : steps) {
    if (!(excess > 0)) {
      cut.limit = is_cut ? cut.limit : Limit::kError;
      break;
    }
    const double rays = s.samples * static_cast<double>(r.cost[s.block]);
    is_cut = is_cut || s.samples > round;
    if (!is_cut) {
      cut.limit = budget.take(s.samples, rays);
      is_cut = cut.limit != Limit::kNone;
    }
    cut.steps += !is_cut;
    round -= s.samples;
    excess -= static_cast<double>(s.drop);
    cut.rays_to_error += rays;
  }
  return cut;
}

/// Forecasts the rays of the whole picture.
double forecast_rays(const Refinement& r, double more, const RefineOptions& asked, Spent spent) {
  const auto rays = static_cast<double>(r.rays);
  double all = asked.error > 0 ? (rays + more) * (1 + kMostChecked)
                               : std::numeric_limits<double>::infinity();
  if (asked.seconds > 0)
    all = std::min(all, rays * asked.seconds / spent.seconds);
  if (asked.samples > 0)
    all = std::min(all,
                   rays / static_cast<double>(spent.samples) * static_cast<double>(asked.samples));
  return all;
}

/// From now on the picture depends on what was asked for.
void set_limited(Refinement& r, const RefineOptions& asked) {
  if (r.limited)
    return;
  if (asked.refinable)
    r.before = {r};
  r.limited = true;
}

}  // namespace

bool plan_round(Refinement& r,
                const BlockErrors& errors,
                const RefineOptions& asked,
                const List& order,
                const Spent& spent) {
  const BlockErrors::Totals totals = errors.totals();
  const double error = totals.judged(r.checks > 0);
  r.repeats = 0;
  if (asked.error > 0 && error <= asked.error)
    r.limit = Limit::kError;
  if (r.limit != Limit::kNone)
    return false;
  const double aim = kAim * asked.error / error;
  const double excess =
      asked.error > 0 ? totals.sum * (1 - aim * aim) : std::numeric_limits<double>::infinity();
  bool capped = false;
  const std::vector<Step> steps = next_steps(r, errors, most_log(asked), capped);
  const Cut cut = cut_steps(
      r, steps, excess, Budget(asked, spent, r.rays), kGrowth * static_cast<double>(spent.samples));
  r.forecast = forecast_rays(r, cut.rays_to_error, asked, spent);
  if (cut.limit != Limit::kError)
    r.limit = cut.limit;
  if (cut.steps == 0) {
    if (r.limit == Limit::kNone && (capped || asked.error > 0))
      r.limit = Limit::kSamples;  // no pixel may have more
    return false;
  }
  if (capped || cut.limit != Limit::kNone)
    set_limited(r, asked);
  r.goal = r.log;
  for (std::size_t i = 0; i < cut.steps; ++i)
    ++r.goal[steps[i].block];
  std::copy_if(order.begin(), order.end(), std::back_inserter(r.wanted), [&](std::uint32_t b) {
    return r.goal[b] > r.log[b];
  });
  return true;
}

namespace {

/// Pixels that tell the error to a few per cent, and pixels that are checked of any picture.
constexpr double kMinChecked = 2048, kFewChecked = 256;
/// Share of a large picture that a check takes at least where blocks claim as much as is asked for.
constexpr double kLeastChecked = 1. / 32;
/// Blocks that claim most are checked for themselves: few could hold most of an error.
constexpr std::size_t kWorstChecked = 16;

/// Share of the pixels to check. If all m checked pixels are right, 3 / m of all pixels may be off,
/// each by no more than 1: with m = 6 / E^2 that is half of E^2. Where the error lies far below E,
/// fewer tell as much.
double share_for(double error, double claimed, double pixels) {
  const double claim = std::min(1., claimed / error);
  const double enough =
      std::max(std::min(6 / (error * error), kLeastChecked * pixels), kMinChecked);
  return std::min(kMostChecked, std::max(enough * claim * claim, kFewChecked) / pixels);
}

/// [blocks] Which vary most; of equal ones, the first.
std::vector<bool> worst_blocks(const BlockErrors& errors, const List& order) {
  const std::size_t worst = std::clamp<std::size_t>(order.size() / 16, 1, kWorstChecked);
  List blocks = order;
  std::nth_element(blocks.begin(),
                   blocks.begin() + static_cast<std::ptrdiff_t>(worst - 1),
                   blocks.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return errors.variance(a) != errors.variance(b)
                                ? errors.variance(a) > errors.variance(b)
                                : a < b;
                   });
  std::vector<bool> is_worst(order.size());
  for (std::size_t i = 0; i < worst; ++i)
    is_worst[blocks[i]] = true;
  return is_worst;
}

/// The worst blocks, and others by a hash, each with what it claims.
std::vector<CheckedBlock> drawn_blocks(const Refinement& r,
                                       const BlockErrors& errors,
                                       const List& order,
                                       int most,
                                       double share,
                                       std::uint32_t seed) {
  const std::vector<bool> is_worst = worst_blocks(errors, order);
  const std::uint32_t key = scattered_bits(seed + static_cast<std::uint32_t>(r.checks));
  std::vector<CheckedBlock> drawn;
  std::size_t others = 0, all = 0;
  for (const std::uint32_t b : order) {
    all += !is_worst[b];
    if (r.log[b] >= most || !(is_worst[b] || scattered_bits(b ^ key) < share * 0x1p32))
      continue;
    others += !is_worst[b];
    drawn.push_back({b, errors.agrees(b) ? 0 : errors.claim(b), is_worst[b] ? 1.f : 0.f});
  }
  for (CheckedBlock& d : drawn)
    if (d.stands_for == 0)
      d.stands_for = static_cast<float>(static_cast<double>(all) / static_cast<double>(others));
  return drawn;
}

/// Squared differences of a block's halves as displayed, mean of channels, summed over pixels.
double half_squares(const Refinement& r, std::uint32_t block) {
  double sum = 0;
  r.blocks().each_pixel(block, [&](std::size_t p) {
    for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
      const float mean = mean_so_far(r, i, sample_count(r, block));
      const float half = .5f * std::sqrt(r.squares[0][i]);
      const float d = std::clamp(mean + half, 0.f, 1.f) - std::clamp(mean - half, 0.f, 1.f);
      sum += static_cast<double>(d * d) / 3;
    }
  });
  return sum;
}

void add_check(const Refinement& r, CheckSums& sums) {
  for (const CheckedBlock& c : r.checking) {
    const bool agreed = c.claim == 0;
    // of the variance that new samples take off, to all of it
    const double all = 1 / (1 - (agreed ? .5 : static_cast<double>(r.variance_ratio)));
    const auto stands_for = static_cast<double>(c.stands_for);
    const double y = stands_for * all * half_squares(r, c.block) / 4;
    const double pixels = stands_for * static_cast<double>(r.blocks().pixels(c.block));
    if (agreed) {
      const double ny = y * sample_count(r, c.block) / 2;  // of the samples before
      sums.ny += ny;
      sums.nyny += ny * ny;
      sums.count += pixels;
      continue;
    }
    const double x = static_cast<double>(c.claim) * pixels;
    sums.y += y;
    sums.x += x;
    sums.yy += y * y;
    sums.xy += x * y;
    sums.xx += x * x;
  }
}

}  // namespace

bool is_check_due(const Refinement& r,
                  const BlockErrors& errors,
                  const RefineOptions& asked,
                  std::uint64_t samples) {
  if (!(asked.error > 0) || r.checks >= kMaxChecks || r.limit != Limit::kNone)
    return false;
  const double error = errors.totals().judged(r.checks > 0);
  if (r.repeats > 0)
    return r.repeats < kMostRepeats && error > kSurprise * asked.error;
  const bool recent = r.checks > 0 && static_cast<double>(samples) <
                                          kCheckGrowth * static_cast<double>(r.checked_at);
  return !recent && error <= asked.error;
}

bool plan_check(Refinement& r,
                const BlockErrors& errors,
                const RefineOptions& asked,
                const List& order,
                const Spent& spent,
                std::uint32_t seed) {
  const double share =
      share_for(asked.error, errors.totals().rmse, static_cast<double>(r.box.size()));
  std::vector<CheckedBlock> drawn = drawn_blocks(r, errors, order, most_log(asked), share, seed);
  double samples = 0, rays = 0;
  for (const CheckedBlock& c : drawn) {
    const double more = new_samples(r, c.block, r.log[c.block]);
    samples += more;
    rays += more * static_cast<double>(r.cost[c.block]);
  }
  r.limit = Budget(asked, spent, r.rays).take(samples, rays);
  if (drawn.empty() || r.limit != Limit::kNone)
    return false;
  set_limited(r, asked);
  r.goal = r.log;
  for (const CheckedBlock& c : drawn) {
    ++r.goal[c.block];
    r.wanted.push_back(c.block);
  }
  r.checking = std::move(drawn);
  r.check_samples += static_cast<std::uint64_t>(samples);
  return true;
}

void close_check(Refinement& r, std::uint64_t samples) {
  // what a check finds where nothing seemed wrong may rest on a hit or two
  r.checked.weigh(r.repeats == 0 ? .5 : 1);
  add_check(r, r.checked);
  r.checking.clear();
  r.checked_at = samples;
  ++r.checks;
  ++r.repeats;
}

}  // namespace grelha
