#pragma once
// A second opinion on a refined picture: some pixels once more, with other samples. Estimates that
// decided where to stop cannot be wrong in the same way twice.

#include <cstddef>

#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "kernel/adaptive/block_errors.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Sums over audited pixels, which get as many samples again: half the squared difference of the
/// two estimates, whose mean is their squared error, and the variance claimed. Each stands for
/// several.
struct AuditedPixels {
  double squared = 0;     ///< sum of it
  double by_sample = 0;   ///< sum of it times the pixel's samples
  double claimed = 0;     ///< sum of variances
  double difference = 0;  ///< sum of squares of the differences of the two
  double fourth = 0;      ///< sum of squares of the first
  double count = 0;       ///< of pixels that they stand for

  void add(double half_square, double variance, double samples, double stands_for);

  /// True if the difference from the claim exceeds chance.
  bool is_worse() const;
  /// Factor of the variances over those that pixels show, if it was taken to be `so_far`: 1 at
  /// least, kMostWorse at most.
  double how_much_worse(double so_far) const;
};

struct Audit {
  AuditedPixels agreeing, others;  ///< pixels of blocks whose samples agree, and of others

  double mean_square() const {
    return (agreeing.squared + others.squared) / (agreeing.count + others.count);
  }
  /// Not exceeded at 95 % confidence.
  double bound() const;
};

/// Samples some pixels of a picture once more, by another sequence: others each time. The same for
/// any number of threads. `stats` gets the rays, r.audit_samples stays as it is.
Audit audit(const World::Impl& world,
            const Setup& setup,
            const RenderOptions& options,
            const BlockErrors& errors,
            const Refinement& r,
            RenderStats& stats);

}  // namespace grelha
