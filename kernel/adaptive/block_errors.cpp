#include "kernel/adaptive/block_errors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grelha {

/// Blocks judged together: variance and means of one sample, of all pixels.
struct BlockErrors::Pool {
  float by_sample = 0;          ///< sum over blocks of the variance of one sample
  float hits = 0, squares = 0;  ///< see Sums, as though each pixel had one sample
  float blocks = 1;
  const Sums* sums = nullptr;  ///< of the first
  float falls = 1;             ///< variance of the mean of a pixel of the first over that of a sample

  /// As many pixels of equal differences would tell as much.
  float certainty() const { return squares > 0 ? hits * hits / squares : 0; }
  void operator+=(const Pool& o) {
    by_sample += o.by_sample;
    hits += o.hits;
    squares += o.squares;
    blocks += o.blocks;
  }
};

BlockErrors::BlockErrors(const Refinement& r, int threads)
    : r_(r), blocks_(r.blocks()), threads_(threads) {
  const std::size_t count = blocks_.count();
  resize_to_fill(seen_, count);
  resize_to_fill(sums_, count);
  resize_to_fill(missed_, count);
  resize_to_fill(missed_at_, count);
  for (std::vector<float>* const of : {&variance_, &certainty_, &gain_})
    resize_to_fill(*of, count);
}

void BlockErrors::set_missed(std::vector<float> missed) {
  missed_ = std::move(missed);
  missed_at_ = r_.log;
}

/// Adds pixel p, of 2^log samples.
void BlockErrors::measure_pixel(std::size_t p, int log, Sums& sums) const {
  const float free = freedom(log);
  float levels[3] = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = 3 * p + c;
    const float mean = mean_so_far(r_, i, 1u << log);
    const float l[3] = {r_.squares[0][i], r_.squares[1][i], r_.squares[2][i]};
    sums.colour[c] += std::clamp(mean, 0.f, 1.f);
    if (mean > 1) {  // what is surely white is so on any screen
      constexpr float kOfAll = kTypicalRatio / (1 - kTypicalRatio) / 4;
      const float v = kOfAll * (l[0] + kTypicalRatio * (l[1] + kTypicalRatio * l[2])) / free;
      if (mean - 3 * std::sqrt(v) > 1)
        continue;
    }
    for (int k = 0; k < 3; ++k)
      levels[k] += l[k] / (3 * free);
  }
  const float hit = levels[0] + kTypicalRatio * (levels[1] + kTypicalRatio * levels[2]);
  for (int k = 0; k < 3; ++k)
    sums.levels[k] += levels[k];
  sums.hits += hit;
  sums.squares += hit * hit;
  ++sums.pixels;
}

void BlockErrors::measure(std::size_t b) {
  Sums sums;
  blocks_.each_pixel(b, [&](std::size_t p) { measure_pixel(p, r_.log[b], sums); });
  float one_sample = 1;  // hits of a pixel that had one sample
  for (int k = 0; k < r_.log[b]; ++k)
    one_sample /= kTypicalRatio;
  sums.hits *= one_sample;
  sums.squares *= one_sample * one_sample;
  sums_[b] = sums;
  seen_[b] = r_.log[b];
  if (missed_at_[b] != r_.log[b])
    missed_[b] = 0;
}

void BlockErrors::measure() {
  powers_[0] = 1;
  for (std::size_t i = 0; i < kMostLog; ++i)
    powers_[i + 1] = powers_[i] * r_.variance_ratio;
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t b = 0; b < blocks_.count(); ++b)
    if (seen_[b] != r_.log[b])
      measure(b);
}

/// Variance by sums of squared differences over degrees of freedom.
float BlockErrors::own_variance(const float (&levels)[3]) const {
  const float ratio = r_.variance_ratio;
  return ratio / (1 - ratio) / 4 * (levels[0] + ratio * (levels[1] + ratio * levels[2]));
}

bool BlockErrors::agrees(std::size_t b) const {
  const auto n = static_cast<float>(sample_count(r_, b));
  return own_variance(sums_[b].levels) <= kAgreement / (n * n);
}

BlockErrors::Pool BlockErrors::own(std::size_t b) const {
  const Sums& sums = sums_[b];
  const float falls = powers_[r_.log[b]];
  return {.by_sample = own_variance(sums.levels) / (sums.pixels * falls),
          .hits = sums.hits,
          .squares = sums.squares,
          .sums = &sums,
          .falls = falls};
}

/// Whether two blocks may show one surface: their means differ no more than samples do.
bool BlockErrors::alike(const Pool& a, const Pool& b) const {
  float difference = 0;
  for (int c = 0; c < 3; ++c) {
    const float d = a.sums->colour[c] / a.sums->pixels - b.sums->colour[c] / b.sums->pixels;
    difference += d * d;
  }
  const float by_sample = std::max(a.by_sample, b.by_sample);
  return difference <= 3 * kAlike * kAlike * by_sample *
                           (a.falls / a.sums->pixels + b.falls / b.sums->pixels);
}

BlockErrors::Pool BlockErrors::pooled(std::size_t b) const {
  const Pool mine = own(b);
  if (mine.certainty() >= kEnoughHits)
    return mine;
  Pool pool = mine;
  const auto columns = static_cast<std::size_t>(blocks_.columns);
  const int bx = static_cast<int>(b % columns), by = static_cast<int>(b / columns);
  for (int y = std::max(by - 1, 0); y <= std::min(by + 1, blocks_.rows - 1); ++y)
    for (int x = std::max(bx - 1, 0); x <= std::min(bx + 1, blocks_.columns - 1); ++x) {
      const std::size_t o = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
      if (o == b)
        continue;
      if (const Pool other = own(o); alike(mine, other))
        pool += other;
    }
  return pool;
}

void BlockErrors::judge(std::size_t b) {
  const Pool pool = pooled(b);
  const float certainty = pool.certainty();
  const auto samples = static_cast<float>(sample_count(r_, b));
  float v = 0;
  // k hits in N samples have chances of Beta(k + 1, N - k + 1), whose mean is that of one hit more
  if (certainty > 0)
    v = static_cast<float>(r_.worse) * (1 + 1 / certainty) * pool.by_sample / pool.blocks *
        powers_[r_.log[b]];
  if (agrees(b))
    v = std::max(v, static_cast<float>(r_.least_by_sample) / samples);
  v = std::min(v + missed_[b], 1.f);  // of what a screen shows
  variance_[b] = v;
  certainty_[b] = certainty;
  gain_[b] = r_.log[b] < kMostLog ? v * (1 - r_.variance_ratio) / (samples * r_.cost[b]) : 0;
}

void BlockErrors::judge() {
  measure();
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t b = 0; b < blocks_.count(); ++b)
    judge(b);
}

std::vector<float> BlockErrors::widths() const {
  std::vector<float> widths;
  resize_to_fill(widths, r_.box.size());
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t b = 0; b < blocks_.count(); ++b)
    blocks_.each_pixel(b, [&](std::size_t p) {
      Sums sums;
      measure_pixel(p, r_.log[b], sums);
      // few differences tell little: half of it is what the block says
      const float mine = static_cast<float>(r_.worse) * own_variance(sums.levels);
      widths[p] = 2 * kNormal * std::sqrt(.5f * (mine + variance_[b]));
    });
  return widths;
}

BlockErrors::Totals BlockErrors::totals() const {
  double sum = 0;
  double spread = 0;
  for (std::size_t b = 0; b < variance_.size(); ++b) {
    const double v = static_cast<double>(variance_[b]) * static_cast<double>(sums_[b].pixels);
    sum += v;
    spread += v * v / std::max(1., static_cast<double>(certainty_[b]));
  }
  const double n = static_cast<double>(r_.box.size());
  const double bound = kVarianceInflation * (sum + kNormalOneSided * std::sqrt(spread));
  return {sum, std::sqrt(bound / n), std::sqrt(sum / n)};
}

}  // namespace grelha
