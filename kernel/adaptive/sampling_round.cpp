#include "kernel/adaptive/sampling_round.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {
namespace {

constexpr std::uint64_t kSamplesOfChunk = 4096;  ///< work handed to a thread at a time: at most
/// the threshold falls by this a round: two or three rounds double all samples
constexpr float kThresholdStep = .5f;
constexpr float kLeastThreshold = 1e-20f;  ///< below it no pixel is worth a ray
/// widest 95 % interval a pixel may have, in units of the error asked for; see RefineOptions::error
constexpr double kWidestInterval = 8;
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

/// Goes through the wanted pixels by falling gain while `take` says yes; the others are wanted no
/// more. Returns whether there were any.
template <class Take>
bool keep_best(Pixels& wanted, const PixelErrors& errors, const Take& take) {
  struct Rank {
    float gain;
    std::uint32_t place;
  };
  std::vector<Rank> ranks(wanted.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
    ranks[i] = {errors.gain_per_ray(wanted[i]), static_cast<std::uint32_t>(i)};
  std::sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.place < b.place;
  });
  std::size_t kept = 0;
  while (kept < ranks.size() && take(wanted[ranks[kept].place]))
    ++kept;
  if (kept == ranks.size())
    return false;
  ranks.resize(kept);
  std::sort(
      ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) { return a.place < b.place; });
  for (std::size_t i = 0; i < kept; ++i)
    wanted[i] = wanted[ranks[i].place];
  wanted.resize(kept);
  return true;
}

/// Keeps no more of the round than the error takes.
void keep_for_error(Refinement& r,
                    const PixelErrors& errors,
                    const PixelErrors::Totals& totals,
                    double error) {
  const double excess = totals.sum * (1 - error * error / (totals.bound * totals.bound));
  double drop = 0;
  keep_best(r.wanted, errors, [&](std::size_t p) {
    if (!(drop < excess))
      return false;
    drop += errors.variance(p) * (1 - r.variance_ratio);
    return true;
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
  const bool met = asked.error > 0 && totals.bound <= asked.error;
  // the bound may rise at first
  if (asked.error > 0)
    r.share = met ? 1 : std::max(r.share, asked.error / totals.bound);
  if (asked.samples > 0)
    r.share =
        std::min(1.0, static_cast<double>(spent.samples) / static_cast<double>(asked.samples));
  if (met) {
    want(r, order, [&](std::size_t p) {
      return errors.widths()[p] > kWidestInterval * asked.error;
    });
  } else {
    do {
      r.gain_threshold *= kThresholdStep;
      want(r, order, [&](std::size_t p) { return errors.gain_per_ray(p) > r.gain_threshold; });
    } while (r.wanted.empty() && r.gain_threshold >= kLeastThreshold);
  }
  if (asked.error > 0 && !met)
    keep_for_error(r, errors, totals, asked.error);
  else if (asked.seconds > 0 || asked.samples > 0)
    keep_for_budget(r, errors, asked, spent, first_log);
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

void add_run(
    Refinement& r, const PixelRun& run, const std::int64_t* sums, int first_log, Chunk& chunk) {
  const std::size_t p = run.pixel;
  const bool first = run.first == 0;
  const double part = kParts / (kLightUnit * run.count);
  const auto squared = [](double x) { return static_cast<float>(x * x); };
  for (std::size_t c = 0; c < 3; ++c) {
    double m[kParts];
    std::int64_t all = 0;
    for (std::size_t k = 0; k < kParts; ++k) {
      m[k] = static_cast<double>(sums[k * 3 + c]) * part;
      all += sums[k * 3 + c];
    }
    const double a = .5 * (m[0] + m[1]), b = .5 * (m[2] + m[3]);
    const float halves = squared(a - b), quarters = squared(m[0] - m[1]) + squared(m[2] - m[3]);
    const std::size_t i = p * 3 + c;
    if (first) {
      r.squares[0][i] = halves;
      r.squares[1][i] = quarters;
      chunk.variance_drop += halves;
      chunk.variance_level += .5 * static_cast<double>(quarters);
    } else {
      r.squares[2][i] = r.squares[1][i] + quarters;
      r.squares[1][i] = r.squares[0][i] + halves;
      r.squares[0][i] =
          squared(static_cast<double>(r.sums[i]) / (kLightUnit * run.count) - .5 * (a + b));
      chunk.variance_drop += static_cast<double>(r.squares[0][i]);
      chunk.variance_level += static_cast<double>(halves);
    }
    r.sums[i] += all;
  }
  r.log[p] = static_cast<std::uint8_t>(first ? first_log : r.log[p] + 1);
}

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
  r.variance_drop = kMemory * r.variance_drop + r.round_drop;
  r.variance_level = kMemory * r.variance_level + r.round_level;
  r.round_drop = 0;
  r.round_level = 0;
  if (r.variance_level > 0)
    r.variance_ratio =
        static_cast<float>(std::clamp(r.variance_drop / r.variance_level, kLeastRatio, kMostRatio));
  return true;
}

}  // namespace grelha
