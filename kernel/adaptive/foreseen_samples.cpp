#include "kernel/adaptive/foreseen_samples.hpp"

#include <array>
#include <bit>

namespace grelha {
namespace {

constexpr std::size_t kExponents = 256;

/// Pixels by the exponent of what they gain a ray: their variances, and their samples.
struct ByGain {
  std::array<double, kExponents> variance{}, samples{};

  ByGain(const Refinement& r, const PixelErrors& errors) {
    const std::vector<float>& gains = errors.gains_per_ray();
    for (std::size_t p = 0; p < gains.size(); ++p) {
      const std::size_t e = std::bit_cast<std::uint32_t>(gains[p]) >> 23 & 0xFF;
      variance[e] += static_cast<double>(errors.variance(p));
      samples[e] += sample_count(r, p);
    }
  }
};

/// What becomes of a pixel that is doubled until it gains less than a threshold.
struct Doubled {
  double variance = 1, samples = 1;  ///< times
};

/// [powers of two that it gains above the threshold]
std::array<Doubled, kExponents> doubled(double ratio) {
  std::array<Doubled, kExponents> all;
  Doubled so_far;
  double gain = 1;
  for (Doubled& one : all) {
    for (; gain >= 1; gain *= ratio / 2)
      so_far = {so_far.variance * ratio, so_far.samples * 2};
    one = so_far;
    gain *= 2;
  }
  return all;
}

}  // namespace

double foreseen_samples(const Refinement& r, const PixelErrors& errors, double error) {
  const ByGain pixels(r, errors);
  const auto by_powers = doubled(r.variance_ratio);
  const PixelErrors::Totals totals = errors.totals();
  const double wanted = totals.sum * error * error / (totals.bound * totals.bound);
  std::size_t highest = kExponents - 1;
  while (highest > 0 && pixels.samples[highest] == 0)
    --highest;
  double more = 0;
  double variance = totals.sum;
  for (std::size_t threshold = highest; variance > wanted && threshold > 0; --threshold) {
    variance = totals.sum;
    more = 0;
    for (std::size_t e = threshold; e <= highest; ++e) {
      const Doubled by = by_powers[e - threshold];
      variance -= (1 - by.variance) * pixels.variance[e];
      more += (by.samples - 1) * pixels.samples[e];
    }
  }
  return more;
}

}  // namespace grelha
