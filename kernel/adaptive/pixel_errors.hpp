#pragma once

#include <array>

#include "kernel/adaptive/refinement.hpp"
#include "kernel/adaptive/tolerances.hpp"

namespace grelha {

/// What the samples of a refined picture say of its error, pixel by pixel. Nothing of it is kept:
/// it follows from the picture.
class PixelErrors {
  /// variance_ratio^i
  using RatioPowers = std::array<float, kMostLog + 1>;

 public:
  /// `effects`: there is more to sample than the pixel. `first_log`: of the samples that a pixel
  /// begins with.
  PixelErrors(const Refinement& r, bool effects, int first_log, int threads);

  /// Takes from the picture what the rest is told by. Part of judge().
  void measure();

  /// Variance and interval of every pixel. Few differences tell little: pixels that may hold more
  /// than one surface, or an effect, borrow from their neighbours of the same kind, so that chance
  /// stops no pixel and drives none on.
  void judge();

  /// Weight of light in which what hides does not matter, for an error asked for.
  float forgiven(double error) const;
  /// Differences to pixels around that show no edge that matters, for an error asked for, or 0.
  static float faint(double error);
  /// The same from which on beams tell sooner than samples what hides at the edge.
  static float dear(double error);

  struct Totals {
    double sum, bound;    ///< of the variances; of the RMSE
    double rmse, widest;  ///< as ErrorStats has them
  };
  Totals totals() const;

  /// mean over channels, with what neighbours say of it
  float variance(std::size_t p) const { return variance_[p]; }
  const std::vector<float>& widths() const { return widest_; }  ///< [pixels] of the 95 % interval

  /// Variance that a ray takes away, were the pixel's samples doubled.
  float gain_per_ray(std::size_t p) const {
    if (r_.log[p] >= kMostLog)
      return 0;
    return variance_[p] * (1 - r_.variance_ratio) / (samples(p) * r_.cost[p]);
  }

  /// Whether no sample of a pixel differed.
  bool agrees(std::size_t p) const { return own_[p] <= kAgreement / (samples(p) * samples(p)); }
  /// The greatest difference a channel of a pixel shows to one around it, on a screen.
  float contrast(int x, int y) const;

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(r_.width) +
           static_cast<std::size_t>(x);
  }
  float samples(std::size_t p) const { return static_cast<float>(1u << r_.log[p]); }
  bool watched(std::size_t p) const { return effects_ || r_.inside[p] > 0 || r_.around[p] > 0; }
  float differences(std::size_t p) const;
  float variance_by(float halves, float quarters, float eighths, float count) const;
  float channel_variance(std::size_t i) const;
  float own_variance(std::size_t p) const;
  /// What hides from a pixel's samples adds to its variance, and how wide its interval must be.
  struct Hidden {
    float variance, width;
  };
  Hidden in_box(std::size_t p) const;
  float doubt_of(int x, int y) const;
  bool met_lamp(std::size_t p) const;
  float with_neighbours(int x, int y, const RatioPowers& powers) const;
  void judge_pixel(int x, int y, const RatioPowers& powers);

  const Refinement& r_;
  const bool effects_;
  const int first_log_, threads_;
  std::vector<float> shown_;                    ///< [pixels][3] what a screen shows
  std::vector<float> own_, variance_, widest_;  ///< [pixels] own_: from a pixel's own differences
  std::vector<float> of_one_;  ///< [pixels] own_ as it would be of one sample; 0: not watched
  std::vector<std::uint8_t> watched_;  ///< [pixels]
};

}  // namespace grelha
