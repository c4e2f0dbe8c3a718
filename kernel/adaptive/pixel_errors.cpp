#include "kernel/adaptive/pixel_errors.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/scene/pixel_box.hpp"

namespace grelha {

PixelErrors::PixelErrors(const Refinement& r, bool effects, int first_log, int threads)
    : r_(r),
      effects_(effects),
      first_log_(first_log),
      threads_(threads),
      shown_(3 * r.log.size()),
      own_(r.log.size()),
      variance_(r.log.size()),
      widest_(r.log.size()),
      of_one_(r.log.size()),
      watched_(r.log.size()) {}

float PixelErrors::differences(std::size_t p) const {
  return r_.log[p] == first_log_ ? kYoung : kOld;
}

/// Variance by squared differences of halves, quarters and eighths, so many in all.
float PixelErrors::variance_by(float halves, float quarters, float eighths, float count) const {
  const float ratio = r_.variance_ratio;
  const float drop = (halves + ratio * (quarters + ratio * eighths)) / (4 * count);
  return drop * ratio / (1 - ratio);
}

/// The same of channel i % 3 of pixel i / 3: of the three levels there are 1, 2 and 4.
float PixelErrors::channel_variance(std::size_t i) const {
  return variance_by(r_.squares[0][i], r_.squares[1][i], r_.squares[2][i], differences(i / 3));
}

/// Variance of a pixel, mean of its channels, from its own differences.
float PixelErrors::own_variance(std::size_t p) const {
  float sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t i = p * 3 + c;
    const float v = channel_variance(i);
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
    const float* const row = &shown_[at(left, j) * 3];
    for (int i = 0; i < count * 3; ++i)
      most = std::max(most, std::abs(row[i] - own[i % 3]));
  }
  return most;
}

float PixelErrors::with_neighbours(int x, int y, const RatioPowers& powers) const {
  const std::size_t p = at(x, y);
  float sum = 0;
  int count = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, r_.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, r_.width - 1); ++i) {
      const std::size_t q = at(i, j);
      sum += q == p ? 0 : of_one_[q];
      count += q == p ? 0 : watched_[q];
    }
  if (count == 0)
    return own_[p];
  const float mine = differences(p);
  // of eight neighbours each an eighth as much
  const float theirs = mine / 8;
  const float shared = theirs * sum * powers[r_.log[p]];
  return (own_[p] * mine + shared) / (mine + theirs * static_cast<float>(count));
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
float PixelErrors::doubt_of(int x, int y) const {
  const std::size_t p = at(x, y);
  // An edge that comes in from a neighbour leaves no room among n samples of a net for more than
  // about 1 / n.
  if (agrees(p))
    return r_.around[p] > 0 ? std::max(r_.inside[p], r_.around[p] * contrast(x, y) / 3)
                            : r_.inside[p];
  return r_.inside[p] > 1 && !met_lamp(p) ? r_.inside[p] : 0;
}

/// Whether what differs among a pixel's samples is as much as one of them that met a lamp of weight
/// w makes of it, in the channel where it is brightest: w / 2 at least, see Glows.
bool PixelErrors::met_lamp(std::size_t p) const {
  const float of_one = .5f * r_.inside[p] / samples(p);
  const float square = kSlightlyLess * of_one * of_one;  // in means of all, twice of halves, ...
  const float least = variance_by(4 * square, 16 * square, 64 * square, kOld);
  return std::max(
             {channel_variance(p * 3), channel_variance(p * 3 + 1), channel_variance(p * 3 + 2)}) >=
         least;
}

void PixelErrors::judge_pixel(int x, int y, const RatioPowers& powers) {
  const std::size_t p = at(x, y);
  float v = static_cast<float>(r_.worse) * (watched_[p] ? with_neighbours(x, y, powers) : own_[p]);
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
}

void PixelErrors::measure() {
#pragma omp parallel for num_threads(threads_) schedule(static)
  for (std::size_t p = 0; p < own_.size(); ++p) {
    for (std::size_t i = p * 3; i < p * 3 + 3; ++i)
      shown_[i] = std::clamp(mean_so_far(r_, i), 0.f, 1.f);
    own_[p] = own_variance(p);
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
    for (std::size_t p = 0; p < own_.size(); ++p) {
      watched_[p] = watched(p);
      of_one_[p] = watched_[p] ? own_[p] / powers[r_.log[p]] : 0;
    }
#pragma omp for schedule(static)
    for (int y = 0; y < r_.height; ++y)
      for (int x = 0; x < r_.width; ++x)
        judge_pixel(x, y, powers);
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
