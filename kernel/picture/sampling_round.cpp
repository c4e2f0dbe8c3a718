#include "kernel/picture/sampling_round.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace grelha {
namespace {

constexpr std::uint64_t kSamplesOfChunk = 8192;  ///< most work handed to a thread at a time
/// the threshold falls by this factor in a round: two or three rounds double all samples
constexpr float kThresholdStep = .5f;
/// At least one of so many blocks is wanted: estimating all blocks costs a twentieth of its samples
/// (measured).
constexpr std::size_t kBlocksAWanted = 32;
constexpr float kLeastThreshold = 1e-20f;  ///< below it no block is worth a ray
constexpr double kMemory = .5;             ///< weight of the rounds before the last one

using List = std::vector<std::uint32_t>;

double new_samples(const Refinement& r, std::size_t block) {
  return static_cast<double>(next_count(r, block)) * static_cast<double>(r.blocks().pixels(block));
}

/// A wanted block: what it promises, and its index among the wanted.
struct Rank {
  float gain;
  std::uint32_t place;
};

/// The wanted blocks by falling gain.
std::vector<Rank> ranked(const List& wanted, const BlockErrors& errors) {
  std::vector<Rank> ranks(wanted.size());
  for (std::size_t i = 0; i < ranks.size(); ++i)
    ranks[i] = {errors.gains_per_ray()[wanted[i]], static_cast<std::uint32_t>(i)};
  std::sort(ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.place < b.place;
  });
  return ranks;
}

/// Keeps those of the ranks, in the order they had.
void keep(List& wanted, std::vector<Rank>& ranks) {
  std::sort(
      ranks.begin(), ranks.end(), [](const Rank& a, const Rank& b) { return a.place < b.place; });
  for (std::size_t i = 0; i < ranks.size(); ++i)
    wanted[i] = wanted[ranks[i].place];
  wanted.resize(ranks.size());
}

/// Goes through the wanted blocks by falling gain while `take` says yes; the others are wanted no
/// more. Returns whether there were any.
template <class Take>
bool select_best(List& wanted, const BlockErrors& errors, const Take& take) {
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

/// Selects no more of the round than takes `excess` off the sum of variances.
void select_for_error(Refinement& r, const BlockErrors& errors, double excess) {
  const Blocks blocks = r.blocks();
  const auto drop_of = [&](std::size_t b) {
    return static_cast<double>(errors.variance(b) * (1 - r.variance_ratio)) *
           static_cast<double>(blocks.pixels(b));
  };
  double all = 0;
  for (const std::uint32_t b : r.wanted)
    all += drop_of(b);
  if (all < excess)
    return;
  double drop = 0;
  select_best(r.wanted, errors, [&](std::size_t b) {
    if (!(drop < excess))
      return false;
    drop += drop_of(b);
    return true;
  });
}

/// Selects what the seconds or samples asked for still buy: a round that does not fit is the last.
void select_for_budget(Refinement& r,
                       const BlockErrors& errors,
                       const RefineOptions& asked,
                       const Spent& spent) {
  const bool timed = asked.seconds > 0;
  const double seconds_a_ray = spent.seconds / static_cast<double>(r.rays);
  double left = timed ? asked.seconds - spent.seconds
                      : static_cast<double>(asked.samples) - static_cast<double>(spent.samples);
  r.last = select_best(r.wanted, errors, [&](std::uint32_t b) {
    left -= new_samples(r, b) * (timed ? static_cast<double>(r.cost[b]) * seconds_a_ray : 1);
    return left >= 0;
  });
}

/// Says how far the picture is.
void report_share(Refinement& r, double error, const RefineOptions& asked, const Spent& spent) {
  // the error may rise at first
  if (asked.error > 0)
    r.share = error <= asked.error ? 1 : std::max(r.share, asked.error / error);
  if (asked.samples > 0)
    r.share =
        std::min(1.0, static_cast<double>(spent.samples) / static_cast<double>(asked.samples));
}

/// Wants the blocks that gain more than the threshold, which falls until there are some.
void request_by_gain(Refinement& r, const BlockErrors& errors, const List& order) {
  const std::vector<float>& gains = errors.gains_per_ray();
  const auto least = static_cast<std::ptrdiff_t>(order.size() / kBlocksAWanted);
  const auto gaining = [&](float gain) { return gain > r.gain_threshold; };
  do
    r.gain_threshold *= kThresholdStep;
  while (std::count_if(gains.begin(), gains.end(), gaining) <= least &&
         r.gain_threshold >= kLeastThreshold);
  r.wanted.clear();
  std::copy_if(order.begin(), order.end(), std::back_inserter(r.wanted), [&](std::uint32_t b) {
    return r.log[b] < kMostLog && gaining(gains[b]);
  });
}

}  // namespace

bool choose_round(Refinement& r,
                  const BlockErrors& errors,
                  const RefineOptions& asked,
                  const List& order,
                  const Spent& spent) {
  if (r.last)
    return false;
  const BlockErrors::Totals totals = errors.totals();
  const double error = totals.judged(r.checks > 0);
  report_share(r, error, asked, spent);
  if (error <= asked.error)
    return false;
  request_by_gain(r, errors, order);
  if (asked.error > 0)
    select_for_error(r, errors, totals.sum * (1 - asked.error * asked.error / (error * error)));
  else
    select_for_budget(r, errors, asked, spent);
  return !r.wanted.empty();
}

std::uint32_t next_count(const Refinement& r, std::size_t block) {
  return 1u << (r.log[block] == 0 ? kFirstLog : r.log[block]);
}

std::vector<Chunk> cut_round(const Refinement& r) {
  std::vector<Chunk> chunks;
  std::uint64_t in_chunk = 0;
  for (std::size_t i = 0; i < r.wanted.size(); ++i) {
    const std::uint32_t n = next_count(r, r.wanted[i]) * kBlockPixels;
    if (chunks.empty() || chunks.back().end - chunks.back().begin == kBlocksOfChunk ||
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

void add_run(Refinement& r, const PixelRun& run, const std::int64_t* sums, Chunk& chunk) {
  const double unit = kLightUnit * run.count;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = std::size_t{run.pixel} * 3 + c;
    const NewSamples s = compare_parts(sums + c, kParts / unit);
    if (run.first == 0)
      begin_differences(r, i, s, chunk);
    else
      add_differences(r, i, static_cast<double>(r.sums[i]) / unit, s, chunk);
    for (std::size_t k = 0; k < kParts; ++k)
      r.sums[i] += sums[k * 3 + c];
  }
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
        std::clamp(static_cast<float>(r.variance_drop / r.variance_level), kLeastRatio, kMostRatio);
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
