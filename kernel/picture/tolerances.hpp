#pragma once
// Assumptions of `--error` about samples; docs/sampling.md has the derivations and the
// measurements, docs/numerics.md names the test that pins each.

namespace grelha {

/// Squared differences a pixel holds: after its first round 1 of halves and 2 of quarters, later 4
/// of eighths as well. Chi squared has as many degrees of freedom.
inline constexpr float kYoung = 3;
inline constexpr float kOld = 7;

/// V(n) / V(n/2) by which differences of pixels are weighed against each other, whatever the
/// picture's own: so a block tells the same whenever it is asked.
inline constexpr float kTypicalRatio = .4f;

/// V(n) / V(n/2) is no less and no more, whatever few differences say: from smooth light in nets to
/// a little above independent samples.
inline constexpr float kLeastRatio = .1f, kMostRatio = .6f;

/// Differing pixels a block must hold for its estimate to stand alone. An edge crosses four or so;
/// where fewer differ, rare hits may be what makes them, and blocks around tell as well.
inline constexpr float kMinHits = 3;
/// Blocks on each side that tell how often samples hit, and where these hold fewer hits than tell a
/// variance to a quarter.
inline constexpr int kNear = 1, kFar = 4;
inline constexpr float kEnoughHits = 16;
/// Share of samples that hit, up to which hits are rare.
inline constexpr float kRareHits = .01f;
/// Blocks lie on one surface as far as samples tell where their means differ by no more standard
/// errors than this: chance parts one pair in 370.
inline constexpr float kAlike = 3;

/// Standard errors between an estimate and its bound at 95 %: 1.645 of normal ones, but of few
/// checked pixels the tails are longer (measured: docs/error-suite.csv).
inline constexpr double kBoundSpread = 2.3;

/// Share of its box that a disc covers, pi / 4.
inline constexpr float kDiscInBox = .7853982f;

/// Times 1 / n^2: variance below which n samples agree. One sample that differs by .1 gives .0049 /
/// n^2 if variances fall by .4 per doubling.
inline constexpr float kAgreement = .005f;

/// Blocks claim more than is true by this factor of the RMSE in the median (measured): the first
/// check comes when they claim so much.
inline constexpr double kOverclaimed = 1.15;
/// Times the samples at an error check: most samples without another one (a choice).
inline constexpr double kCheckGrowth = 1.25;
/// A bound that ended a run happens to be low: up to this factor above it, the error asked for is
/// stated instead (a choice; 19 of 20 bounds hold: docs/error-suite.csv).
inline constexpr double kBoundedLow = 1.15;
/// Least and largest factor of variances over those claimed that checks may find: few pixels tell
/// (a choice).
inline constexpr double kLeastErrorRatio = .7, kMaxErrorRatio = 16;
/// Most error checks of a picture.
inline constexpr int kMaxChecks = 16;
/// A check that finds so many times the error asked for is repeated, up to so many in all.
inline constexpr double kSurprise = 1.5;
inline constexpr int kMostRepeats = 3;
/// Most of a picture that a check samples again.
inline constexpr double kMostChecked = 1. / 16;

/// Most that is told of a picture in work: a forecast may be too low.
inline constexpr double kMostForecast = .99;

}  // namespace grelha
