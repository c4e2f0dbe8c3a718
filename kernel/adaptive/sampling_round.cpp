#include "kernel/adaptive/sampling_round.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace grelha {
namespace {

constexpr std::uint64_t kSamplesOfChunk = 4096;  ///< work handed to a thread at a time: at most
/// the threshold falls by this a round: two or three rounds double all samples
constexpr float kThresholdStep = .5f;
/// Of so many pixels one at least is wanted: to look at all of them costs as much as its samples.
constexpr std::size_t kPixelsAWanted = 32;
constexpr float kLeastThreshold = 1e-20f;  ///< below it no pixel is worth a ray
/// widest 95 % interval a pixel may have, in units of the error asked for, and the share of pixels
/// that may have wider ones all the same; see RefineOptions::error
constexpr double kWidestInterval = 8;
constexpr double kShareOfWider = .001;
constexpr double kLeastRatio = .1, kMostRatio = .6;  ///< of variances, a doubling
constexpr double kMemory = .5;  ///< share of what rounds before the last one said that counts

using Pixels = std::vector<std::uint32_t>;

template <class Test>
void want(Refinement& r, const Pixels& order, const Test& test) {
  r.wanted.clear();
  for (const std::uint32_t p : order)
    if (r.log[p] < kMostLog && test(p))
      r.wanted.push_back(p);
}

/// A wanted pixel: what it promises, and its place among the wanted.
struct Rank {
  float gain;
  std::uint32_t place;
};

/// The wanted pixels by falling gain.
std::vector<Rank> ranked(const Pixels& wanted, const PixelErrors& errors) {
  std::vector<Rank> ranks(wanted.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
    ranks[i] = {errors.gains_per_ray()[wanted[i]], static_cast<std::uint32_t>(i)};
  std::sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.place < b.place;
  });
  return ranks;
}

/// Keeps those of the ranks, in the order they had.
void keep(Pixels& wanted, std::vector<Rank>& ranks) {
  std::sort(
      ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) { return a.place < b.place; });
  for (std::size_t i = 0; i < ranks.size(); ++i)
    wanted[i] = wanted[ranks[i].place];
  wanted.resize(ranks.size());
}

/// Goes through the wanted pixels by falling gain while `take` says yes; the others are wanted no
/// more. Returns whether there were any.
template <class Take>
bool keep_best(Pixels& wanted, const PixelErrors& errors, const Take& take) {
  std::vector<Rank> ranks = ranked(wanted, errors);
  std::size_t kept = 0;
  while (kept < ranks.size() && take(wanted[ranks[kept].place]))
    ++kept;
  if (kept == ranks.size())
    return false;
  ranks.resize(kept);
  keep(wanted, ranks);
  return true;
}

/// Keeps no more of the round than the error takes.
void keep_for_error(Refinement& r,
                    const PixelErrors& errors,
                    const PixelErrors::Totals& totals,
                    double error) {
  const double excess = totals.sum * (1 - error * error / (totals.bound * totals.bound));
  const auto drop_of = [&](std::size_t p) { return errors.variance(p) * (1 - r.variance_ratio); };
  double all = 0;
  for (const std::uint32_t p : r.wanted)
    all += drop_of(p);
  if (all < excess)
    return;
  double drop = 0;
  keep_best(r.wanted, errors, [&](std::size_t p) {
    if (!(drop < excess))
      return false;
    drop += drop_of(p);
    return true;
  });
}

/// Keeps no more of the round than is to be sampled before the next audit.
void keep_for_audit(Refinement& r, const PixelErrors& errors, const Spent& spent, int first_log) {
  double left =
      kGrowthOfAudits * static_cast<double>(r.audited_at) - static_cast<double>(spent.samples);
  keep_best(r.wanted, errors, [&](std::uint32_t p) {
    const bool taken = left > 0;
    left -= next_count(r, p, first_log);
    return taken;
  });
}

/// Keeps what the seconds or samples asked for still buy: a round that does not fit is the last.
void keep_for_budget(Refinement& r,
                     const PixelErrors& errors,
                     const RefineOptions& asked,
                     const Spent& spent,
                     int first_log) {
  const bool timed = asked.seconds > 0;
  const double seconds_a_ray = spent.seconds / static_cast<double>(r.rays);
  double left = timed ? asked.seconds - spent.seconds
                      : static_cast<double>(asked.samples) - static_cast<double>(spent.samples);
  r.last = keep_best(r.wanted, errors, [&](std::uint32_t p) {
    left -= next_count(r, p, first_log) * (timed ? r.cost[p] * seconds_a_ray : 1);
    return left >= 0;
  });
}

/// Says how far the picture is.
void tell_share(Refinement& r,
                const PixelErrors::Totals& totals,
                const RefineOptions& asked,
                const Spent& spent) {
  const bool met = totals.bound <= asked.error;
  // the bound may rise at first
  if (asked.error > 0)
    r.share = met ? 1 : std::max(r.share, asked.error / totals.bound);
  if (asked.samples > 0)
    r.share =
        std::min(1.0, static_cast<double>(spent.samples) / static_cast<double>(asked.samples));
}

/// Wants the pixels that gain more than the threshold, which falls until there are some.
void want_gaining(Refinement& r, const PixelErrors& errors, const Pixels& order) {
  const std::vector<float>& gains = errors.gains_per_ray();
  const auto least = static_cast<std::ptrdiff_t>(order.size() / kPixelsAWanted);
  const auto gaining = [&](float gain) { return gain > r.gain_threshold; };
  do
    r.gain_threshold *= kThresholdStep;
  while (std::count_if(gains.begin(), gains.end(), gaining) <= least &&
         r.gain_threshold >= kLeastThreshold);
  want(r, order, [&](std::size_t p) { return gaining(gains[p]); });
}

/// Wants the pixels whose intervals are too wide, but for the widest of them that may be so.
void want_wide(Refinement& r, const PixelErrors& errors, const Pixels& order, double error) {
  const std::vector<float>& widths = errors.widths();
  const auto too_wide = [&](float width) { return width > kWidestInterval * error; };
  std::vector<float> wide;
  std::copy_if(widths.begin(), widths.end(), std::back_inserter(wide), too_wide);
  const auto spared = static_cast<std::size_t>(kShareOfWider * static_cast<double>(widths.size()));
  if (wide.size() <= spared) {
    r.wanted.clear();
    return;
  }
  const auto last = wide.begin() + static_cast<std::ptrdiff_t>(spared);
  std::nth_element(wide.begin(), last, wide.end(), std::greater<>());
  const float most = *last;
  want(r, order, [&](std::size_t p) { return too_wide(widths[p]) && widths[p] <= most; });
}

}  // namespace

bool choose_round(Refinement& r,
                  const PixelErrors& errors,
                  const RefineOptions& asked,
                  const Pixels& order,
                  const Spent& spent,
                  int first_log) {
  if (r.last)
    return false;
  const PixelErrors::Totals totals = errors.totals();
  const bool met = asked.error > 0 && (r.met || totals.bound <= asked.error);
  tell_share(r, totals, asked, spent);
  r.met_at = !met ? 0 : r.met_at == 0 ? spent.samples : r.met_at;
  if (met)
    want_wide(r, errors, order, asked.error);
  else
    want_gaining(r, errors, order);
  if (asked.error > 0 && !met)
    keep_for_error(r, errors, totals, asked.error);
  else if (asked.seconds > 0 || asked.samples > 0)
    keep_for_budget(r, errors, asked, spent, first_log);
  if (!met && r.audits > 0 && r.audits < kMostAudits)
    keep_for_audit(r, errors, spent, first_log);
  return !r.wanted.empty();
}

std::uint32_t next_count(const Refinement& r, std::uint32_t pixel, int first_log) {
  return 1u << (r.log[pixel] == 0 ? first_log : r.log[pixel]);
}

std::vector<Chunk> cut_round(const Refinement& r, int first_log) {
  std::vector<Chunk> chunks;
  std::uint64_t in_chunk = 0;
  for (std::size_t i = 0; i < r.wanted.size(); ++i) {
    const std::uint32_t n = next_count(r, r.wanted[i], first_log);
    if (chunks.empty() || chunks.back().end - chunks.back().begin == kRunsOfChunk ||
        in_chunk + n > kSamplesOfChunk) {
      chunks.push_back({i, i});
      in_chunk = 0;
    }
    ++chunks.back().end;
    in_chunk += n;
  }
  return chunks;
}

namespace {

float squared(double x) {
  return static_cast<float>(x * x);
}

/// One channel of a pixel's new samples.
struct NewSamples {
  double mean;
  float halves, quarters;  ///< squared differences of their parts
};

/// By sums of kParts parts, three numbers apart; `part`: what turns them into means.
NewSamples compare_parts(const std::int64_t* sums, double part) {
  double m[kParts];
  for (std::size_t k = 0; k < kParts; ++k)
    m[k] = static_cast<double>(sums[k * 3]) * part;
  const double a = .5 * (m[0] + m[1]);
  const double b = .5 * (m[2] + m[3]);
  return {
      .5 * (a + b),
      squared(a - b),
      squared(m[0] - m[1]) + squared(m[2] - m[3]),
  };
}

/// Begins the differences of channel i % 3 of pixel i / 3.
void begin_differences(Refinement& r, std::size_t i, const NewSamples& s, Chunk& chunk) {
  r.squares[0][i] = s.halves;
  r.squares[1][i] = s.quarters;
  chunk.variance_drop += s.halves;
  chunk.variance_level += .5 * static_cast<double>(s.quarters);
}

/// Goes on with them: the new samples, as many as there were, are the second half. `mean`: of the
/// first.
void add_differences(Refinement& r, std::size_t i, double mean, const NewSamples& s, Chunk& chunk) {
  r.squares[2][i] = r.squares[1][i] + s.quarters;
  r.squares[1][i] = r.squares[0][i] + s.halves;
  r.squares[0][i] = squared(mean - s.mean);
  chunk.variance_drop += static_cast<double>(r.squares[0][i]);
  chunk.variance_level += static_cast<double>(s.halves);
}

}  // namespace

void add_run(
    Refinement& r, const PixelRun& run, const std::int64_t* sums, int first_log, Chunk& chunk) {
  const bool first = run.first == 0;
  const double unit = kLightUnit * run.count;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = std::size_t{run.pixel} * 3 + c;
    const NewSamples s = compare_parts(sums + c, kParts / unit);
    if (first)
      begin_differences(r, i, s, chunk);
    else
      add_differences(r, i, static_cast<double>(r.sums[i]) / unit, s, chunk);
    for (std::size_t k = 0; k < kParts; ++k)
      r.sums[i] += sums[k * 3 + c];
  }
  std::uint8_t& log = r.log[run.pixel];
  log = static_cast<std::uint8_t>(first ? first_log : log + 1);
}

namespace {

/// Takes what the round measured of the variances into what earlier ones did.
void close_round(Refinement& r) {
  r.variance_drop = kMemory * r.variance_drop + r.round_drop;
  r.variance_level = kMemory * r.variance_level + r.round_level;
  r.round_drop = 0;
  r.round_level = 0;
  if (r.variance_level > 0)
    r.variance_ratio =
        static_cast<float>(std::clamp(r.variance_drop / r.variance_level, kLeastRatio, kMostRatio));
}

}  // namespace

bool end_round(Refinement& r, const std::vector<Chunk>& chunks, std::size_t done) {
  for (std::size_t c = 0; c < done; ++c) {
    r.round_drop += chunks[c].variance_drop;
    r.round_level += chunks[c].variance_level;
  }
  if (done < chunks.size()) {
    r.wanted.erase(r.wanted.begin(),
                   r.wanted.begin() + static_cast<std::ptrdiff_t>(chunks[done].begin));
    return false;
  }
  r.wanted.clear();
  close_round(r);
  return true;
}

}  // namespace grelha
