#pragma once
// How a picture is rendered.

#include <cstdint>
#include <functional>
#include <string_view>

#include "grelha/phase.hpp"
#include "grelha/subdivision.hpp"

namespace grelha {

inline constexpr int kMostDepth = 4096, kMostSamples = 65536;

/// How the samples of a picture are spread.
enum class Sampler {
  kSobol,   ///< one Owen-scrambled Sobol sequence over the dimensions in use
  kJitter,  ///< a jittered grid for each pair of dimensions, those after the pixel's shuffled
  // jittered grids in one order: biased where two pairs matter together, to see what shuffling is
  // for
  kUnshuffled,
  kRandom,  ///< independent
  // one such sequence over the whole picture, of which pixels that are neighbours draw runs that
  // follow each other: the same error, spread as blue noise
  kBlue
};

/// True where samples lie in a grid.
constexpr bool is_jittered(Sampler s) {
  return s == Sampler::kJitter || s == Sampler::kUnshuffled;
}
/// True where the samples of a pixel must be counted before the first is taken.
constexpr bool is_counted_first(Sampler s) {
  return is_jittered(s) || s == Sampler::kBlue;
}

/// Where the samples of a picture lie: pure functions of (seed, pixel, sample, dimension).
struct SampleOptions {
  int samples = 1;  ///< rays through each pixel; 1 with no effect to sample: through its centre
  Sampler sampler = Sampler::kSobol;
  std::uint32_t seed = 0;
  int light_rays = 1;  ///< shadow rays from each point towards each area light
  /// on rough mirrors: so many rays around the mirror direction and that direction; 0: one in its
  /// place
  int gloss_rays = 0;
};

/// Samples spent where they help most, instead of SampleOptions::samples a pixel. The sampler must
/// be kSobol or kRandom.
struct RefineOptions {
  /// > 0: until the RMSE is at most this at 95 % confidence. Of 99.9 % of the pixels 95 % intervals
  /// are no wider than 8 times this. Display units, 0 to 1
  double error = 0;
  /// > 0: until these are spent, which depends on the machine; ErrorStats::samples says what to ask
  /// for to repeat it
  double seconds = 0;
  /// > 0: so many in the whole picture, and at least the first few of every pixel
  std::uint64_t samples = 0;
  /// True where any of them is asked for.
  bool on() const { return error > 0 || seconds > 0 || samples > 0; }
};

/// How a picture is rendered.
struct RenderOptions {
  int threads = 0;  ///< 0: one per processor
  /// longest path, at most kMostDepth, the eye ray counted as 1; at its end the background is seen
  int depth = 5;
  /// Ends paths whose weight, times the brightest light they can meet, is less; 0 to 1, 0: none.
  /// The default moves no channel by more than 1/1024 at depth 5 (docs/sampling.md).
  double min_weight = 1. / 16384;
  /// most rays that march together: 1, 16, 64 or 256; see traverse_together()
  int packet = 256;
  bool mailbox = true;  ///< skip primitives a ray or packet has already met in another cell
  std::string_view isa = "best";
  SampleOptions sampling;
  RefineOptions refine;
  bool phases = false;           ///< measure where the time goes
  Observer* observer = nullptr;  ///< told of the phases by every thread, instead of measuring them
  /// on: pixels are averages of points of a lattice, `samples` rays through each; one with no
  /// effect to sample
  Subdivision subdivision;
  /// Called now and then from one thread at a time with the share done, 0 to 1. Returns false to
  /// stop; threads that finish what they have in work may call it once more. What it throws stops
  /// the render as well, which throws it on.
  std::function<bool(double)> progress;
};

}  // namespace grelha
