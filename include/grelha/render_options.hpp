#pragma once
// Options of a render.

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/phase.hpp"
#include "grelha/subdivision.hpp"

namespace grelha {

inline constexpr int kMostDepth = 4096, kMostSamples = 65536;

/// Sample generators.
enum class Sampler {
  kSobol,   ///< one Owen-scrambled Sobol sequence over the dimensions in use
  kJitter,  ///< a jittered grid for each pair of dimensions, shuffled after the first pair
  kRandom,  ///< independent random numbers
  // one Owen-scrambled Sobol sequence for the whole picture; neighbouring pixels draw consecutive
  // runs of it: the same error as kSobol, distributed as blue noise
  kBlue
};

/// Returns true for the samplers that need the number of samples per pixel in advance.
constexpr bool is_counted_first(Sampler s) {
  return s == Sampler::kJitter || s == Sampler::kBlue;
}

/// Number and distribution of samples. Every sample is a pure function of (seed, pixel, sample,
/// dimension).
struct SampleOptions {
  int samples = 1;  ///< rays per pixel; 1 without effects to sample: through its centre
  Sampler sampler = Sampler::kSobol;
  std::uint32_t seed = 0;
  int light_rays = 1;  ///< shadow rays from each hit point to each area light.
  /// on rough mirrors: number of rays around the mirror direction, besides the one in that
  /// direction; 0: a single ray around it
  int glossy_rays = 0;
};

/// Least value of RefineOptions::most: every pixel begins with as many samples.
inline constexpr int kLeastMost = 8;

/// Adaptive sampling: samples go to the pixels where they reduce the error most, instead of
/// SampleOptions::samples to each, until the first of the limits is reached. The sampler must be
/// kSobol or kRandom.
struct RefineOptions {
  /// > 0: samples until the RMSE is at most this, at 95 % confidence. Display units, 0 to 1
  double error = 0;
  /// > 0: samples for this many seconds. The result depends on the machine; to repeat it set
  /// `samples` to ErrorStats::samples of the run
  double seconds = 0;
  /// > 0: number of samples of the whole picture; every pixel gets at least the first few
  std::uint64_t samples = 0;
  /// > 0: at most this many samples of a pixel, from kLeastMost on, beside one of the limits above.
  /// Samples are doubled, so the largest power of two counts
  int most = 0;
  /// keep in the Picture what a finer error, or another limit, goes on from: see
  /// Picture::lift_limits(). Twice the memory
  bool refinable = false;
  /// Returns true if any of the first three limits is set.
  bool on() const { return error > 0 || seconds > 0 || samples > 0; }
};

/// Lights, and the radiance of rays that hit nothing.
struct Lighting {
  std::vector<Light> lights;
  Float3 background;
};

/// All options of a render.
struct RenderOptions {
  int threads = 0;  ///< 0: one per processor
  /// maximum path length, counted in rays, at most kMostDepth; the camera ray counts as 1. A longer
  /// path gets the background
  int depth = 5;
  /// Paths end when their weight, times the brightest light they can meet, falls below this; 0 to
  /// 1, 0: no path ends early. The default moves no channel by more than 1/1024 at depth 5
  /// (docs/sampling.md).
  double min_weight = 1. / 16384;
  /// largest packet of rays traced together: 1, 16, 64 or 256
  int packet = 256;
  bool mailbox = true;  ///< do not test a primitive again that was tested in another cell
  std::string_view isa = "best";
  SampleOptions sampling;
  RefineOptions refine;
  /// in place of the scene's, for pictures of one World in several lights; absent: the scene's
  std::optional<Lighting> lighting;
  /// the picture is 1 where the camera's rays hit nothing and 0 where they hit, by the same samples
  /// as its light; of a subdivided picture or one by error, by samples of its own
  bool misses = false;
  bool phases = false;           ///< measure the time spent in each phase
  Observer* observer = nullptr;  ///< called at each change of phase, instead of measuring.
  /// on: pixels are averages of lattice points, with `samples` rays through each point; one ray
  /// without effects to sample
  Subdivision subdivision;
  /// Called repeatedly, by one thread at a time, with the fraction done, 0 to 1. Return false to
  /// stop; it may be called again by threads that finish their current work. An exception that it
  /// throws stops the render, which rethrows it.
  std::function<bool(double)> progress;
};

}  // namespace grelha
