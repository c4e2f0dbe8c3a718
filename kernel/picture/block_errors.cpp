#include "kernel/picture/block_errors.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {

void BlockErrors::Sums::operator+=(const Sums& o) {
  hits += o.hits;
  squares += o.squares;
  drop += o.drop;
  level += o.level;
  pixels += o.pixels;
  samples += o.samples;
  for (int c = 0; c < 3; ++c)
    colour[c] += o.colour[c];
}

/// V(n) / V(n/2) of a pool: 1/2, as though a few hits had said so, unless its own say other.
float BlockErrors::Sums::ratio() const {
  if (!(hits > 0 && level > 0))
    return .5f;
  const float few = kMinHits / certainty() * level;
  return std::clamp((drop + .5f * few) / (level + few), kLeastRatio, kMostRatio);
}

BlockErrors::BlockErrors(const Refinement& r, int threads)
    : r_(r), blocks_(r.blocks()), threads_(threads) {
  const std::size_t count = blocks_.count();
  resize_to_fill(version_, count);
  resize_to_fill(sums_, count);
  for (std::vector<float>* const of : {&claim_, &variance_, &certainty_, &gain_})
    resize_to_fill(*of, count);
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
    if (mean > 1) {  // a surely white pixel is white on any screen
      constexpr float kOfAll = kTypicalRatio / (1 - kTypicalRatio) / 4;
      const float v = kOfAll * (l[0] + kTypicalRatio * (l[1] + kTypicalRatio * l[2])) / free;
      if (mean - 3 * std::sqrt(v) > 1)
        continue;
    }
    for (int k = 0; k < 3; ++k)
      levels[k] += l[k] / (3 * free);
  }
  // of independent samples, which rare hits are: times n, as though the pixel had one
  const float n = static_cast<float>(1u << log);
  const float hit = .25f * n * (levels[0] + .5f * (levels[1] + .5f * levels[2]));
  for (int k = 0; k < 3; ++k)
    sums.levels[k] += levels[k];
  sums.hits += hit;
  sums.squares += hit * hit;
  const bool old = log > kFirstLog;
  sums.drop += n * (levels[0] + (old ? levels[1] : 0));
  sums.level += .5f * n * (levels[1] + levels[2]);
  ++sums.pixels;
  sums.samples += n;
}

void BlockErrors::measure(std::size_t b) {
  Sums sums;
  blocks_.each_pixel(b, [&](std::size_t p) {
    measure_pixel(p, r_.log[b], sums);
    sums.has_box = sums.has_box || r_.box[p] != 0;
  });
  sums_[b] = sums;
  version_[b] = r_.log[b];
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

/// Sums of a block with few hits and of the blocks around it that have few and may show the same
/// surface: means differ by no more than chance explains if samples hit as often as in the block
/// with most hits.
BlockErrors::Sums BlockErrors::pool_within(int reach, std::size_t b) const {
  const Sums& mine = sums_[b];
  const auto columns = static_cast<std::size_t>(blocks_.columns);
  const int x = static_cast<int>(b % columns), y = static_cast<int>(b / columns);
  const auto each = [&](const auto& visit) {
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, blocks_.rows - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, blocks_.columns - 1); ++i) {
        const Sums& s = sums_[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)];
        if (s.has_few_hits())
          visit(s);
      }
  };
  float by_sample = 0;
  each([&](const Sums& s) { by_sample = std::max(by_sample, s.by_sample()); });
  Sums pool{};
  each([&](const Sums& s) {
    float difference = 0;
    for (int c = 0; c < 3; ++c) {
      const float d = mine.colour[c] / mine.pixels - s.colour[c] / s.pixels;
      difference += d * d;
    }
    if (difference <= 3 * kAlike * kAlike * by_sample * (1 / mine.samples + 1 / s.samples))
      pool += s;
  });
  return by_sample > 0 ? pool : mine;
}

/// Variance of a block with few hits.
float BlockErrors::rare_variance(std::size_t b, float& certainty) const {
  const Sums& mine = sums_[b];
  Sums pool = pool_within(kNear, b);
  if (pool.certainty() < kEnoughHits)
    pool = pool_within(kFar, b);
  certainty = pool.certainty();
  if (pool.pixels == mine.pixels)
    return own_variance(mine.levels) / mine.pixels;
  // were it 1/2, as `hits` takes it, and by the ratio that it is
  const float ratio = pool.ratio();
  return ratio / (1 - ratio) * pool.by_sample() * mine.pixels / mine.samples;
}

/// By how much a ray more lowers the variance; 0 if the block takes no more.
float BlockErrors::gain_of(std::size_t b, float variance) const {
  const auto samples = static_cast<float>(sample_count(r_, b));
  return r_.log[b] < kMostLog ? variance * (1 - r_.variance_ratio) / (samples * r_.cost[b]) : 0;
}

void BlockErrors::estimate_block(std::size_t b) {
  const Sums& mine = sums_[b];
  const auto samples = static_cast<float>(sample_count(r_, b));
  float certainty = mine.certainty();
  float v =
      mine.has_few_hits() ? rare_variance(b, certainty) : own_variance(mine.levels) / mine.pixels;
  // k hits in N samples have chances of Beta(k + 1, N - k + 1), whose mean is that of one hit more
  if (certainty > 0)
    v *= 1 + 1 / certainty;
  claim_[b] = v;
  const double ratio = r_.checked.ratio();
  v *= static_cast<float>(mine.has_box ? std::max(1., ratio) : ratio);
  if (agrees(b))
    v = std::max(v, static_cast<float>(r_.checked.by_sample()) / samples);
  v = std::min(v + r_.missed[b], 1.f);  // of displayed values, 0 to 1
  variance_[b] = v;
  certainty_[b] = certainty;
  gain_[b] = gain_of(b, v);
}

void BlockErrors::estimate() {
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t b = 0; b < blocks_.count(); ++b)
    if (version_[b] != r_.log[b])
      measure(b);
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t b = 0; b < blocks_.count(); ++b)
    estimate_block(b);
}

BlockErrors::Totals BlockErrors::totals() const {
  double sum = 0, spread = 0, claimed = 0, agreeing = 0, n = 0;
  for (std::size_t b = 0; b < variance_.size(); ++b) {
    const auto pixels = static_cast<double>(sums_[b].pixels);
    const double v = static_cast<double>(variance_[b]) * pixels;
    n += pixels;
    sum += v;
    spread += v * v / std::max(1., static_cast<double>(certainty_[b]));
    if (agrees(b))
      agreeing += pixels / sample_count(r_, b);
    else
      claimed += static_cast<double>(claim_[b]) * pixels;
  }
  if (r_.checks > 0)
    spread = std::max(spread, check_spread(claimed, agreeing));
  const double bound = sum + kBoundSpread * std::sqrt(spread);
  return {sum, std::sqrt(bound / n), std::sqrt(sum / n)};
}

/// Variance of the corrected sum of the blocks' claims: that of a ratio estimator (Cochran
/// 1977, 6.4), and that of the mean where samples agree.
double BlockErrors::check_spread(double claimed, double agreeing) const {
  const CheckSums& c = r_.checked;
  const double ratio = c.ratio();
  const double off = std::max(0., c.yy + ratio * (ratio * c.xx - 2 * c.xy));
  const double of_others = c.x > 0 ? off * claimed / c.x * claimed / c.x : 0;
  const double of_agreeing = c.count > 0 ? c.nyny * agreeing / c.count * agreeing / c.count : 0;
  return of_others + of_agreeing;
}

}  // namespace grelha
