#pragma once
// What `--error` takes for granted of a pixel's samples; docs/sampling.md tells
// what was measured, docs/numerics.md names the test that pins each.

namespace grelha {

/// Squared differences a pixel holds: after its first round 1 of halves and 2 of quarters, later 4
/// of eighths as well. Chi squared has as many degrees of freedom.
inline constexpr float kYoung = 3;
inline constexpr float kOld = 7;

/// One rate for the whole picture, and pixels that stop when their differences are small, leave
/// estimates up to 15 % too low (measured); the bound allows for 12 %, its spread for the rest.
inline constexpr double kVarianceInflation = 1.12 * 1.12;
/// Bounds that a run stopped by are lower than the truth in one of seven, by up to this in two of
/// three of those (measured: docs/error-suite.csv).
inline constexpr double kStoppedLow = 1.15;
/// 97.5 % point of the normal: with what neighbours tell, Student's t is no wider.
inline constexpr float kNormal = 1.96f;
/// 95 % point, of one side.
inline constexpr double kNormalOneSided = 1.645;

/// What none of n samples met covers a share of the pixel that has Beta(1, n +
/// 1), whose second moment is 2 / n^2; it differs from what they met by the
/// doubt at most, in the square by .075 of it in the mean (by about a quarter).
inline constexpr float kHiddenVariance = .15f;
/// Times doubt / n: width of the 95 % interval of what none of n samples met, 3
/// / n on either side (the rule of three).
inline constexpr float kHiddenWidth = 6;

/// Times what differs where one sample met a lamp: what rounding leaves of it.
inline constexpr float kSlightlyLess = .99f;

/// Share of its box that a disc covers, pi / 4.
inline constexpr float kDiscInBox = .7853982f;

/// Times 1 / n^2, for n samples: what variance they agree to. One that differs by .1 shows as .0049
/// of it where variances fall by .4 a doubling.
inline constexpr float kAgreement = .005f;

/// Times the samples of an audit: as many are taken before the next one, no more (a choice). Where
/// an audit found more than pixels claim, what they claim from then on is rough.
inline constexpr double kGrowthOfAudits = 1.5;
/// How much worse than claimed audits find a picture at most: few pixels tell (a choice).
inline constexpr double kMostWorse = 16;
/// Audits of a picture.
inline constexpr int kMostAudits = 16;

/// Times the error asked for: what a lamp out of focus adds to its pixels that counts (a choice).
inline constexpr double kFaintGlow = .5;
/// What hides in light of weight w leaves a standard error of sqrt(kHiddenVariance) w / n among the
/// n samples that a pixel begins with: of so much of the error asked for, light is not followed (a
/// choice: were it in every pixel, the whole would be off by a twentieth).
inline constexpr double kForgiven = 1. / 3;
/// Pixels that look like those around them, within this, hide no edge that matters: with n = 4
/// samples it leaves a standard error of sqrt(kHiddenVariance) / (3 n) of it, a quarter of the
/// error asked for. Where none is asked for: four steps of 8 bits (a choice).
inline constexpr float kFaintInErrors = 8;
inline constexpr float kFaint = 1.f / 64;
/// Edges up to here are left to samples: 16 make the interval of what hides there narrow enough,
/// and a beam costs 20 to 60 (measured).
inline constexpr float kDearInErrors = 64;

}  // namespace grelha
