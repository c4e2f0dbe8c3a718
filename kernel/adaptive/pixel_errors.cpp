#include "kernel/adaptive/pixel_errors.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernel/scene/pages.hpp"
#include "kernel/scene/pixel_box.hpp"

namespace grelha {

PixelErrors::PixelErrors(const Refinement& r, bool effects, int first_log, int threads)
    : r_(r), effects_(effects), first_log_(first_log), threads_(threads) {
  const std::size_t pixels = r.log.size(), lent = lent_at(-1, r.height + 1);
  resize_to_fill(seen_, pixels);
  for (std::vector<float>& level : levels_)
    resize_to_fill(level, pixels);
  resize_to_fill(white_, pixels);
  resize_to_fill(shown_, 3 * pixels);
  resize_to_fill(contrast_, pixels, kUnknown);
  for (std::vector<float>* const of : {&own_, &variance_, &widest_, &gain_})
    resize_to_fill(*of, pixels);
  resize_to_fill(lent_, lent);
  resize_to_fill(lends_, lent);
}

bool PixelErrors::is_young(std::size_t p) const {
  return r_.log[p] == first_log_;
}

/// Variance by squared differences of halves, quarters and eighths, of which there are 1, 2 and 4,
/// but no eighths of the young.
float PixelErrors::variance_by(float halves, float quarters, float eighths, float freedom) const {
  const float ratio = r_.variance_ratio;
  return (halves + ratio * (quarters + ratio * eighths)) * (of_all_ / freedom);
}

/// The same of channel i % 3 of pixel i / 3.
float PixelErrors::channel_variance(std::size_t i, float freedom) const {
  return variance_by(r_.squares[0][i], r_.squares[1][i], r_.squares[2][i], freedom);
}

/// Variance of a pixel, mean of its channels, from its own differences; of one with white channels.
float PixelErrors::own_variance(std::size_t p) const {
  float sum = 0;
  for (std::size_t i = p * 3; i < p * 3 + 3; ++i) {
    const float v = channel_variance(i, freedom(p));
    const bool white = shown_[i] == 1 && mean_so_far(r_, i) - 3 * std::sqrt(v) > 1;
    if (!white)  // on any screen
      sum += v;
  }
  return sum / 3;
}

float PixelErrors::contrast(int x, int y) const {
  const float* const own = &shown_[at(x, y) * 3];
  const int left = std::max(x - 1, 0);
  const int count = std::min(x + 1, r_.width - 1) - left + 1;
  float most = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, r_.height - 1); ++j) {
    const float* other = &shown_[at(left, j) * 3];
    for (int i = 0; i < count; ++i, other += 3)
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(other[c] - own[c]));
  }
  return most;
}

float PixelErrors::contrast_so_far(int x, int y) {
  float& known = contrast_[at(x, y)];
  if (known == kUnknown)
    known = contrast(x, y);
  return known;
}

/// What pixels around lend, of one sample, and how many do.
struct PixelErrors::Around {
  float sum;
  int count;
};

float PixelErrors::with_neighbours(std::size_t p,
                                   const Around& around,
                                   const RatioPowers& powers) const {
  if (around.count == 0)
    return own_[p];
  const float mine = is_young(p) ? kYoung : kOld;
  // of eight neighbours each an eighth as much
  const float theirs = mine / 8;
  const float shared = theirs * around.sum * powers[r_.log[p]];
  return (own_[p] * mine + shared) / (mine + theirs * static_cast<float>(around.count));
}

/// Something was found in a box of the pixel. As long as no sample was sent there it counts as
/// missed, all of it: a disc in that box. Of m samples in the box it then counts what none of them
/// met.
PixelErrors::Hidden PixelErrors::in_box(std::size_t p) const {
  const float most = unpacked(r_.box[p]).area() * r_.boxed[p];
  const float sent = samples(p) - static_cast<float>(1u << first_log_);
  if (!(sent > 0)) {
    const float missed = kDiscInBox * most;
    return {missed * missed, 2 * most};
  }
  const float share = most / (.5f * sent);
  return {kHiddenVariance * share * share, kHiddenWidth * share};
}

/// The weight of what none of a pixel's samples met. What is brighter than white shows by itself
/// when one did, whatever else makes them differ.
float PixelErrors::doubt_of(int x, int y) {
  const std::size_t p = at(x, y);
  // An edge that comes in from a neighbour leaves no room among n samples of a net for more than
  // about 1 / n.
  if (agrees(p))
    return r_.around[p] > 0 ? std::max(r_.inside[p], r_.around[p] * contrast_so_far(x, y) / 3)
                            : r_.inside[p];
  return r_.inside[p] > 1 && !met_lamp(p) ? r_.inside[p] : 0;
}

/// Whether what differs among a pixel's samples is as much as one of them that met a lamp of weight
/// w makes of it, in the channel where it is brightest: w / 2 at least, see Glows.
bool PixelErrors::met_lamp(std::size_t p) const {
  const float of_one = .5f * r_.inside[p] / samples(p);
  const float square = kSlightlyLess * of_one * of_one;  // in means of all, twice of halves, ...
  const float least = variance_by(4 * square, 16 * square, 64 * square, kOld);
  const float most = std::max({channel_variance(p * 3, freedom(p)),
                               channel_variance(p * 3 + 1, freedom(p)),
                               channel_variance(p * 3 + 2, freedom(p))});
  return most >= least;
}

void PixelErrors::judge_pixel(int x, int y, const Around& around, const RatioPowers& powers) {
  const std::size_t p = at(x, y);
  float v = static_cast<float>(r_.worse) *
            (lends_[lent_at(x, y)] ? with_neighbours(p, around, powers) : own_[p]);
  if (r_.least_by_sample > 0 && agrees(p))
    v = std::max(v, static_cast<float>(r_.least_by_sample) / samples(p));
  float wide = 2 * kNormal * std::sqrt(v);
  if (r_.box[p] != 0) {
    const Hidden found = in_box(p);
    v += found.variance;
    wide = std::max(wide, found.width);
  }
  // What none of n samples met covers at most 3 / n of the pixel, at 95 % confidence (the rule of
  // three), on either side: that is how wide the interval must be. Its share has Beta(1, n + 1),
  // whose second moment is 2 / n^2; it differs from what they met by the doubt at most, by about a
  // quarter of it in the mean.
  if (const float doubt = doubt_of(x, y); doubt > 0) {
    const float miss = std::min(doubt / samples(p), 1.f);  // of what a screen shows
    v = std::max(v, kHiddenVariance * miss * miss);
    wide = std::max(wide, kHiddenWidth * miss);
  }
  variance_[p] = v;
  widest_[p] = wide;
  gain_[p] = r_.log[p] < kMostLog ? v * (1 - r_.variance_ratio) / (samples(p) * r_.cost[p]) : 0;
}

/// Takes from the picture what is told by pixel p.
void PixelErrors::show(std::size_t p) {
  bool white = false;
  for (std::size_t i = p * 3; i < p * 3 + 3; ++i) {
    shown_[i] = std::clamp(mean_so_far(r_, i), 0.f, 1.f);
    white |= shown_[i] == 1;
  }
  white_[p] = white;
  const float share = 1 / (3 * freedom(p));
  for (int l = 0; l < 3; ++l) {
    const float* const squares = &r_.squares[l][p * 3];
    levels_[l][p] = ((squares[0] + squares[1]) + squares[2]) * share;
  }
}

/// Pixel p is another: so are contrasts of those around it.
void PixelErrors::forget_contrasts(std::size_t p) {
  const int x = static_cast<int>(p % static_cast<std::size_t>(r_.width));
  const int y = static_cast<int>(p / static_cast<std::size_t>(r_.width));
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, r_.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, r_.width - 1); ++i)
      contrast_[at(i, j)] = kUnknown;
}

void PixelErrors::show_new() {
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t p = 0; p < seen_.size(); ++p)
    if (seen_[p] != r_.log[p])
      show(p);
  for (std::size_t p = 0; p < seen_.size(); ++p)
    if (seen_[p] != r_.log[p]) {
      forget_contrasts(p);
      seen_[p] = r_.log[p];
    }
}

void PixelErrors::measure() {
  show_new();
  // the ratio of variances is another after each round, for all
  const float ratio = r_.variance_ratio;
  of_all_ = ratio / (1 - ratio) / 4;
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (int y = 0; y < r_.height; ++y) {
    for (std::size_t p = at(0, y); p < at(0, y + 1); ++p)
      own_[p] = of_all_ * (levels_[0][p] + ratio * (levels_[1][p] + ratio * levels_[2][p]));
    for (std::size_t p = at(0, y); p < at(0, y + 1); ++p)
      if (white_[p] && own_[p] > 0)
        own_[p] = own_variance(p);
  }
}

void PixelErrors::lend_row(int y, const RatioPowers& powers) {
  for (int x = 0; x < r_.width; ++x) {
    const std::size_t p = at(x, y);
    const bool lends = watched(p);
    lends_[lent_at(x, y)] = lends;
    lent_[lent_at(x, y)] = lends ? own_[p] / powers[r_.log[p]] : 0;
  }
}

/// Judges a row as though nothing told of its pixels but their samples. So it is of most, and many
/// are taken at once.
void PixelErrors::judge_plain_row(int y) {
  const std::uint8_t* const log = r_.log.data();
  const float* const own = own_.data();
  const float* const cost = r_.cost.data();
  float* const variance = variance_.data();
  float* const widest = widest_.data();
  float* const gain = gain_.data();
  const float worse = static_cast<float>(r_.worse), falls = 1 - r_.variance_ratio;
  const float least = static_cast<float>(r_.least_by_sample);
  for (std::size_t p = at(0, y); p < at(0, y + 1); ++p) {
    const float by_sample = std::bit_cast<float>((127u - log[p]) << 23);  // 1 / samples
    const bool agree = own[p] <= kAgreement * by_sample * by_sample;
    const float v = std::max(worse * own[p], agree ? least * by_sample : 0.f);
    variance[p] = v;
    widest[p] = 2 * kNormal * std::sqrt(v);
    gain[p] = log[p] < kMostLog ? v * falls * by_sample / cost[p] : 0;
  }
}

void PixelErrors::judge_row(int y, const RatioPowers& powers) {
  judge_plain_row(y);
  const auto stride = static_cast<std::ptrdiff_t>(lent_at(0, 1) - lent_at(0, 0));
  const auto around = [&](const auto* of) {
    const auto* const above = of - stride;
    const auto* const below = of + stride;
    return above[-1] + above[0] + above[1] + of[-1] + of[1] + below[-1] + below[0] + below[1];
  };
  for (int x = 0; x < r_.width; ++x) {
    const std::size_t at_x = lent_at(x, y);
    if (!lends_[at_x] && r_.box[at(x, y)] == 0)
      continue;
    judge_pixel(x, y, {around(&lent_[at_x]), around(&lends_[at_x])}, powers);
  }
}

void PixelErrors::judge() {
  measure();
  RatioPowers powers;
  powers[0] = 1;
  for (std::size_t i = 0; i < kMostLog; ++i)
    powers[i + 1] = powers[i] * r_.variance_ratio;
#pragma omp parallel num_threads(threads_)
  {
#pragma omp for schedule(static)
    for (int y = 0; y < r_.height; ++y)
      lend_row(y, powers);
#pragma omp for schedule(static)
    for (int y = 0; y < r_.height; ++y)
      judge_row(y, powers);
  }
}

float PixelErrors::forgiven(double error) const {
  const double of_one = std::sqrt(double{kHiddenVariance}) / (1 << first_log_);
  return static_cast<float>(kForgiven * error / of_one);
}

float PixelErrors::faint(double error) {
  return error > 0 ? kFaintInErrors * static_cast<float>(error) : kFaint;
}

float PixelErrors::dear(double error) {
  return error > 0 ? kDearInErrors * static_cast<float>(error) : kFaint;
}

PixelErrors::Totals PixelErrors::totals() const {
  double sum = 0;
  double spread = 0;
  double widest = 0;
  for (std::size_t p = 0; p < variance_.size(); ++p) {
    const double v = static_cast<double>(variance_[p]);
    sum += v;
    spread += v * v;
    widest = std::max(widest, static_cast<double>(widest_[p]));
  }
  const double n = static_cast<double>(variance_.size());
  // A pixel's estimate has the spread of chi squared: variance 2 v^2 over the degrees of freedom.
  const double of_sum = std::sqrt(spread * 2 / kOld);
  const double bound = kVarianceInflation * (sum + kNormalOneSided * of_sum);
  return {sum, std::sqrt(bound / n), std::sqrt(sum / n), widest};
}

}  // namespace grelha
