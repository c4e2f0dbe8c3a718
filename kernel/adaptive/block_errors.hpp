#pragma once

#include <array>

#include "kernel/adaptive/refinement.hpp"
#include "kernel/adaptive/tolerances.hpp"

namespace grelha {

/// What the samples of a refined picture say of its error, block by block. Nothing of it is kept:
/// it follows from the picture.
class BlockErrors {
 public:
  BlockErrors(const Refinement& r, int threads);

  /// Variance of every block, from the differences its pixels hold. Where few of them differ, those
  /// of the blocks around that may show the same surface count as well.
  void judge();

  struct Totals {
    double sum, bound;  ///< of the variances of all pixels; of the RMSE, at 95 % confidence
    double rmse;
  };
  Totals totals() const;

  /// of a pixel of the block, mean over channels
  float variance(std::size_t b) const { return variance_[b]; }
  /// [blocks] Variance that a ray takes away, were the block's samples doubled.
  const std::vector<float>& gains_per_ray() const { return gain_; }
  /// Whether no sample of the block's pixels differed.
  bool agrees(std::size_t b) const;
  /// [pixels] Widths of 95 % intervals.
  std::vector<float> widths() const;

  /// What things found in a block add to its variance, as long as no sample was sent to them: see
  /// AimedRays. Gone once the block has more samples.
  void set_missed(std::vector<float> missed);

 private:
  /// variance_ratio^i
  using RatioPowers = std::array<float, kMostLog + 1>;
  /// Sums over the pixels of a block.
  struct Sums {
    float levels[3] = {};  ///< of squared differences over degrees of freedom, mean of the channels
    float hits = 0, squares = 0;  ///< of what a pixel's sample differs by, squared; of its squares
    float colour[3] = {};         ///< of what a screen shows
    float pixels = 0;
  };
  struct Pool;

  void measure();
  void measure(std::size_t b);
  void measure_pixel(std::size_t p, int log, Sums& sums) const;
  float freedom(int log) const { return log == kFirstLog ? kYoung : kOld; }
  float own_variance(const float (&levels)[3]) const;
  bool alike(const Pool& a, const Pool& b) const;
  Pool own(std::size_t b) const;
  Pool pooled(std::size_t b) const;
  void judge(std::size_t b);

  const Refinement& r_;
  const Blocks blocks_;
  const int threads_;
  RatioPowers powers_{};
  std::vector<std::uint8_t> seen_;  ///< [blocks] Refinement::log when `sums_` was set
  std::vector<Sums> sums_;          ///< [blocks]
  std::vector<float> missed_;       ///< [blocks]
  std::vector<std::uint8_t> missed_at_;  ///< [blocks] Refinement::log of `missed_`
  std::vector<float> variance_, certainty_, gain_;  ///< [blocks] certainty_: of how many hits
};

}  // namespace grelha
