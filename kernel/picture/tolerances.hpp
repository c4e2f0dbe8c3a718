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
/// Hits that blocks around are asked for until there are so many: they tell a variance to a
/// quarter.
inline constexpr float kEnoughHits = 16;
/// Share of samples that hit, up to which hits are rare.
inline constexpr float kRareHits = .01f;
/// Blocks lie on one surface as far as samples tell where their means differ by no more standard
/// errors than this: chance parts one pair in 370.
inline constexpr float kAlike = 3;

/// Blocks stop when their estimates happen to be low: the sum of all is by a tenth (measured).
inline constexpr double kStoppedLow = 1.1;
/// A bound that stopped a run is lower than the truth in one of eight cases, and by up to this
/// factor in two of three such cases (measured: docs/error-suite.csv).
inline constexpr double kBoundedLow = 1.15;
/// 97.5 % point of the normal.
inline constexpr float kNormal = 1.96f;
/// 95 % point, of one side.
inline constexpr double kNormalOneSided = 1.645;

/// Share of its box that a disc covers, pi / 4.
inline constexpr float kDiscInBox = .7853982f;

/// Times 1 / n^2: variance below which n samples agree. One sample that differs by .1 gives .0049 /
/// n^2 if variances fall by .4 per doubling.
inline constexpr float kAgreement = .005f;

/// Times the samples at an error check: most samples at the next one (a choice). After a check
/// found a larger error than blocks claim, their claims are rough.
inline constexpr double kCheckGrowth = 1.5;
/// Largest factor by which checks find a picture worse than claimed: few pixels tell (a choice).
inline constexpr double kMaxErrorRatio = 16;
/// Most error checks of a picture.
inline constexpr int kMaxChecks = 16;

}  // namespace grelha
