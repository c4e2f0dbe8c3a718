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

  /// [pixels] Variance that a ray takes away, were the pixel's samples doubled.
  const std::vector<float>& gains_per_ray() const { return gain_; }

  /// Whether no sample of a pixel differed.
  bool agrees(std::size_t p) const { return own_[p] <= kAgreement / (samples(p) * samples(p)); }
  /// The greatest difference a channel of a pixel shows to one around it, on a screen.
  float contrast(int x, int y) const;

 private:
  static constexpr float kUnknown = -1;
  struct Around;

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(r_.width) +
           static_cast<std::size_t>(x);
  }
  /// The same in arrays that have a pixel more on each side.
  std::size_t lent_at(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(r_.width + 2) +
           static_cast<std::size_t>(x + 1);
  }
  float samples(std::size_t p) const { return static_cast<float>(1u << r_.log[p]); }
  bool watched(std::size_t p) const { return effects_ || r_.inside[p] > 0 || r_.around[p] > 0; }
  bool is_young(std::size_t p) const;
  float freedom(std::size_t p) const { return is_young(p) ? kYoung : kOld; }
  float variance_by(float halves, float quarters, float eighths, float freedom) const;
  float channel_variance(std::size_t i, float freedom) const;
  float own_variance(std::size_t p) const;
  /// What hides from a pixel's samples adds to its variance, and how wide its interval must be.
  struct Hidden {
    float variance, width;
  };
  Hidden in_box(std::size_t p) const;
  float doubt_of(int x, int y);
  bool met_lamp(std::size_t p) const;
  float contrast_so_far(int x, int y);
  float with_neighbours(std::size_t p, const Around& around, const RatioPowers& powers) const;
  void show(std::size_t p);
  void forget_contrasts(std::size_t p);
  void show_new();
  void lend_row(int y, const RatioPowers& powers);
  void judge_plain_row(int y);
  void judge_pixel(int x, int y, const Around& around, const RatioPowers& powers);
  void judge_row(int y, const RatioPowers& powers);

  const Refinement& r_;
  const bool effects_;
  const int first_log_, threads_;
  float of_all_ = 0;  ///< times squared differences over degrees of freedom: a variance
  std::vector<std::uint8_t> seen_;  ///< [pixels] Refinement::log when `shown_` was set
  /// [pixels] Squared differences of each level over degrees of freedom, mean of the channels
  std::vector<float> levels_[3];
  std::vector<std::uint8_t> white_;             ///< [pixels] whether a channel is shown as white
  std::vector<float> shown_;                    ///< [pixels][3] what a screen shows
  std::vector<float> contrast_;                 ///< [pixels] as far as it was asked for
  std::vector<float> own_, variance_, widest_;  ///< [pixels] own_: from a pixel's own differences
  std::vector<float> gain_;                     ///< [pixels]
  /// own_ as it would be of one sample, of those that lend it, see lent_at(); 0 for others
  std::vector<float> lent_;
  std::vector<std::uint8_t> lends_;
};

}  // namespace grelha
