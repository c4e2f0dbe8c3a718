#pragma once
// A second opinion on a refined picture: some pixels once more, with other samples. Estimates that
// decided where to stop cannot be wrong in the same way twice.

#include <cstddef>

#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "kernel/picture/block_errors.hpp"
#include "kernel/shade/setup.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {

/// Sums over checked pixels, which get as many samples again: half the squared difference of the
/// two estimates, whose mean is their squared error, and the variance claimed. Each stands for
/// several.
struct CheckedPixels {
  double squared = 0;     ///< sum of it
  double by_sample = 0;   ///< sum of it times the pixel's samples
  double claimed = 0;     ///< sum of variances
  double difference = 0;  ///< sum of squares of the differences of the two
  double fourth = 0;      ///< sum of squares of the first
  double count = 0;       ///< of pixels that they stand for

  void add(double half_square, double variance, double samples, double stands_for);

  /// True if the difference from the claim exceeds chance.
  bool exceeds_error() const;
  /// Factor of the variances over those that pixels show, if it was taken to be `so_far`: 1 at
  /// least, kMaxErrorRatio at most.
  double error_ratio(double so_far) const;
};

struct ErrorCheck {
  CheckedPixels agreeing, others;  ///< pixels of blocks whose samples agree, and of others

  double mean_square() const {
    return (agreeing.squared + others.squared) / (agreeing.count + others.count);
  }
  /// Not exceeded at 95 % confidence.
  double bound() const;
};

/// Samples some pixels of a picture once more, by another sequence: others each time. The same for
/// any number of threads. `stats` gets the rays, r.check_samples stays as it is.
ErrorCheck check_error(const World::Impl& world,
                       const Setup& setup,
                       const RenderOptions& options,
                       const BlockErrors& errors,
                       const Refinement& r,
                       RenderStats& stats);

}  // namespace grelha
