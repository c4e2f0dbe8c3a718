#pragma once

#include <algorithm>

#include "kernel/adaptive/refinement.hpp"
#include "kernel/adaptive/tolerances.hpp"

namespace grelha {

/// What the samples of a refined picture say of its error, block by block. Nothing of it is kept:
/// it follows from the picture.
class BlockErrors {
 public:
  BlockErrors(const Refinement& r, int threads);

  /// Variance of every block, from the differences its pixels hold. Where few of them differ,
  /// blocks around that may show the same surface tell how often samples hit.
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

 private:
  /// Sums over the pixels of a block.
  struct Sums {
    float levels[3] = {};  ///< of squared differences over degrees of freedom, mean of the channels
    float hits = 0, squares = 0;  ///< of variances of pixels' samples; of their squares
    float drop = 0, level = 0;    ///< V(n) / V(n/2) of those is drop / level
    float colour[3] = {};         ///< of what a screen shows
    float pixels = 0, samples = 0;

    void operator+=(const Sums& o);
    /// As many pixels of equal differences would tell as much.
    float certainty() const { return squares > 0 ? hits * hits / squares : 0; }
    bool has_few_hits() const { return certainty() <= std::max(kFewHits, kRareHits * samples); }
    float by_sample() const { return pixels > 0 ? hits / pixels : 0; }
    float ratio() const;
  };
  /// Sums of blocks of rare hits, in cells of kCell x kCell cells of the level before.
  struct Level {
    int columns, rows;
    std::vector<Sums> cells;
  };
  static constexpr int kLevels = 3, kCell = 4;

  void measure(std::size_t b);
  void measure_pixel(std::size_t p, int log, Sums& sums) const;
  void fill_level(int l);
  float freedom(int log) const { return log == kFirstLog ? kYoung : kOld; }
  float own_variance(const float (&levels)[3]) const;
  void pool_around(const Level& level, int x, int y, const Sums& mine, Sums& pool) const;
  float rare_variance(std::size_t b, float& certainty) const;
  void judge(std::size_t b);

  const Refinement& r_;
  const Blocks blocks_;
  const int threads_;
  std::vector<std::uint8_t> seen_;  ///< [blocks] Refinement::log when `sums_` was set
  std::vector<Sums> sums_;          ///< [blocks]
  Level levels_[kLevels];
  std::vector<float> variance_, certainty_, gain_;  ///< [blocks] certainty_: of how many hits
};

}  // namespace grelha
