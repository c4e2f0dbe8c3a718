#pragma once

#include <algorithm>

#include "kernel/picture/refinement.hpp"
#include "kernel/picture/tolerances.hpp"

namespace grelha {

/// Error estimates from the samples of a refined picture, block by block. They are not saved: they
/// follow from the picture.
class BlockErrors {
 public:
  BlockErrors(const Refinement& r, int threads);

  /// Computes the variance of every block from the differences its pixels hold. If few pixels
  /// differ, surrounding blocks that may show the same surface tell how often samples hit.
  void estimate();

  struct Totals {
    double sum, bound;  ///< sum of the variances of all pixels; bound of the RMSE at 95 %
                        ///< confidence
    double rmse;
    /// The figure compared with the error asked for. Until a check, blocks are taken to claim too
    /// much.
    double judged(bool checked) const { return checked ? bound : rmse / kOverclaimed; }
  };
  Totals totals() const;

  /// Variance of a pixel of the block, mean over channels, by its own samples.
  float claim(std::size_t b) const { return claim_[b]; }
  /// The same as checks of the picture correct it.
  float variance(std::size_t b) const { return variance_[b]; }
  /// [blocks] Variance that each ray removes if the block's samples are doubled.
  const std::vector<float>& gains_per_ray() const { return gain_; }
  /// True if no sample of the block's pixels differed.
  bool agrees(std::size_t b) const;

 private:
  /// Sums over the pixels of a block.
  struct Sums {
    float levels[3] = {};  ///< of squared differences over degrees of freedom, mean of the channels
    float hits = 0, squares = 0;  ///< of variances of pixels' samples; of their squares
    float drop = 0, level = 0;    ///< V(n) / V(n/2) is drop / level
    float colour[3] = {};         ///< displayed values
    float pixels = 0, samples = 0;
    bool has_box = false;  ///< few pixels hold its errors, and checks seldom see them

    void operator+=(const Sums& o);
    /// Number of pixels with equal differences that would be as certain.
    float certainty() const { return squares > 0 ? hits * hits / squares : 0; }
    bool has_few_hits() const { return certainty() <= std::max(kMinHits, kRareHits * samples); }
    float by_sample() const { return pixels > 0 ? hits / pixels : 0; }
    float ratio() const;
  };
  void measure(std::size_t b);
  void measure_pixel(std::size_t p, int log, Sums& sums) const;
  float freedom(int log) const { return log == kFirstLog ? kYoung : kOld; }
  float own_variance(const float (&levels)[3]) const;
  Sums pool_within(int reach, std::size_t b) const;
  float rare_variance(std::size_t b, float& certainty) const;
  float gain_of(std::size_t b, float variance) const;
  void estimate_block(std::size_t b);
  double check_spread(double claimed, double agreeing) const;

  const Refinement& r_;
  const Blocks blocks_;
  const int threads_;
  std::vector<std::uint8_t> version_;           ///< [blocks] Refinement::log when `sums_` was set
  std::vector<Sums> sums_;                      ///< [blocks]
  std::vector<float> claim_, variance_, gain_;  ///< [blocks]
  std::vector<float> certainty_;                ///< [blocks] of how many hits
};

}  // namespace grelha
