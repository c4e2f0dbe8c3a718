#include "kernel/picture/sampling_round.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {
namespace {

constexpr std::uint64_t kSamplesOfChunk = 8192;  ///< most work handed to a thread at a time
constexpr double kMemory = .5;                   ///< weight of the rounds before the last one

}  // namespace

int doublings(const Refinement& r, std::size_t block) {
  return r.log[block] == 0 ? r.goal[block] - kFirstLog + 1 : r.goal[block] - r.log[block];
}

std::uint32_t new_count(const Refinement& r, std::size_t block) {
  return (1u << r.goal[block]) - sample_count(r, block);
}

std::vector<Chunk> cut_round(const Refinement& r) {
  std::vector<Chunk> chunks;
  std::uint64_t in_chunk = 0;
  int runs = 0;
  for (std::size_t i = 0; i < r.wanted.size(); ++i) {
    const std::uint32_t b = r.wanted[i];
    const std::uint32_t n = new_count(r, b) * kBlockPixels;
    const int more = doublings(r, b);
    if (chunks.empty() || runs + more > kBlocksOfChunk || in_chunk + n > kSamplesOfChunk) {
      chunks.push_back({i, i});
      in_chunk = 0;
      runs = 0;
    }
    ++chunks.back().end;
    runs += more;
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

void close_round(Refinement& r) {
  r.variance_drop = kMemory * r.variance_drop + r.round_drop;
  r.variance_level = kMemory * r.variance_level + r.round_level;
  r.round_drop = 0;
  r.round_level = 0;
  if (r.variance_level > 0)
    r.variance_ratio =
        std::clamp(static_cast<float>(r.variance_drop / r.variance_level), kLeastRatio, kMostRatio);
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
  return true;
}

}  // namespace grelha
