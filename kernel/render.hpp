#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "kernel/camera.hpp"
#include "kernel/geometry.hpp"
#include "kernel/image.hpp"
#include "kernel/scene_spans.hpp"
#include "kernel/stats.hpp"
#include "kernel/subdivision.hpp"

namespace grelha {

/// How a World is built. None of it changes a picture.
struct BuildOptions {
  bool grid = true;  ///< false: every ray meets every primitive
  /// M of the grid's resolution M cbrt(count / volume) per unit length; 0: the kernel chooses
  float density = 0;
  int threads = 0;  ///< 0: one per processor; the grid is the same, bit for bit, for every number
  /// a build that will probably take more, beside the scene's own arrays, throws TooLarge before it
  /// begins; 0: any
  std::uint64_t most_bytes = 0;
  /// Called now and then from one thread at a time with the share done, 0 to 1, never less than
  /// before and 1 in the end; returns false to have the constructor throw Stopped.
  std::function<bool(double)> progress{};
};

/// Bytes, beside the scene's own arrays.
struct BuildMemory {
  std::uint64_t peak = 0;  ///< while a World is built
  std::uint64_t kept = 0;  ///< as long as it lives
};

/// What a function throws whose progress said to stop.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }  ///< no more than that
};

/// A World would take more memory than BuildOptions allow.
struct TooLarge : std::runtime_error {
  /// Of what it would take.
  explicit TooLarge(BuildMemory n)
      : std::runtime_error("the scene needs more memory than it may have"), need(n) {}
  BuildMemory need;  ///< by World::estimate()
};

/// A scene made ready for rays. It refers to the arrays of the geometry it was built from, which
/// must outlive it unchanged; materials and lights are copied. Nothing of it changes once it is
/// built, so threads may share it, and there may be many.
class World {
 public:
  /// Throws std::invalid_argument for arrays of unequal lengths and for indices of what is not
  /// there; TooLarge and Stopped as the options say.
  World(const SceneSpans& scene, const BuildOptions& options);
  ~World();
  /// What building will take, within a fifth (docs/performance.md), for about a tenth of the time
  /// that it takes.
  static BuildMemory estimate(const SceneSpans& scene, const BuildOptions& options);
  World(World&&) noexcept;             ///< what was moved from can only go or be assigned to
  World& operator=(World&&) noexcept;  ///< the same

  /// one for the loose primitives and one for each larger object
  std::vector<GridStats> grids() const;
  std::size_t geometry_bytes() const;  ///< the scene's own arrays
  std::size_t grid_bytes() const;      ///< everything built beside them

  struct Impl;  ///< the kernel's own
  /// For the kernel alone.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// One compiled copy of the kernel's hot loops.
struct Isa {
  std::string_view name;  ///< "scalar", "sse2", "avx2", "avx512"
  bool compiled, runs_here;
};
/// All copies this version knows, scalar first.
std::vector<Isa> isas();

inline constexpr int kMostDepth = 4096, kMostSamples = 65536;

/// How the samples of a picture are spread.
enum class Sampler {
  kSobol,   ///< one Owen-scrambled Sobol sequence over the dimensions in use
  kJitter,  ///< a jittered grid for each pair of dimensions, those after the pixel's shuffled
  // jittered grids in one order: biased where two pairs matter together, to see what shuffling is
  // for
  kUnshuffled,
  kRandom,  ///< independent
};

/// Whether samples lie in a grid, whose cells must be counted before the first is taken.
constexpr bool is_jittered(Sampler s) { return s == Sampler::kJitter || s == Sampler::kUnshuffled; }

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

/// Samples spent where they help most, instead of SampleOptions::samples a pixel. Wants the sampler
/// kSobol or kRandom.
struct RefineOptions {
  /// > 0: until the RMSE is at most this at 95 % confidence and no pixel's 95 % interval is wider
  /// than 8 times this; display units, 0 to 1
  double error = 0;
  /// > 0: until these are spent, which depends on the machine; ErrorStats::samples says what to ask
  /// for to repeat it
  double seconds = 0;
  /// > 0: so many in the whole picture, and at least the first few of every pixel
  std::uint64_t samples = 0;
  /// Whether any of them is asked for.
  bool on() const { return error > 0 || seconds > 0 || samples > 0; }
};

/// By pixel, row 0 on top.
struct SampleMaps {
  std::vector<std::uint32_t> samples;  ///< [height * width] spent
  /// [height * width] estimated standard error, root mean square of the channels
  std::vector<float> error;
  /// [height * width] of the 95 % interval, what may hide from the samples counted in
  std::vector<float> width;
};

/// Of the tests of rays and primitives.
enum class Precision { kSingle, kDouble };

/// How a picture is rendered.
struct RenderOptions {
  int threads = 0;  ///< 0: one per processor
  /// longest path, at most kMostDepth, the eye ray counted as 1; at its end the background is seen
  int depth = 5;
  /// Paths end whose weight, times the brightest light they can meet, is less: 0 to 1, 0 keeps all.
  /// Of the default no channel moves by more than 1/1024 at depth 5 (docs/sampling.md).
  double min_weight = 1. / 16384;
  /// most rays that march together: 1, 16, 64 or 256; see march_from()
  int packet = 256;
  bool mailbox = true;  ///< skip primitives a ray or packet has already met in another cell
  std::string_view isa = "best";
  /// of the tests of rays and primitives; what is seen there is shaded in single
  Precision precision = Precision::kSingle;
  SampleOptions sampling;
  RefineOptions refine;
  bool phases = false;           ///< measure where the time goes
  Observer* observer = nullptr;  ///< told of the phases by every thread, instead of measuring them
  /// on: pixels are averages of points of a lattice, `samples` rays through each; one with no
  /// effect to sample
  Subdivision subdivision;
  /// Called now and then from one thread at a time with the share done, 0 to 1; returns false to
  /// stop: threads that end what they have in work may call it once more. What it throws stops as
  /// well, and is thrown by whoever renders.
  std::function<bool(double)> progress;
};

/// At most what all threads of a render work in: a band of rows each, and the rays that wait. More
/// for a wider picture or deeper paths.
std::uint64_t thread_bytes(const Camera& camera, const RenderOptions& options);

/// Renders. The picture is the same, bit for bit, for every value of threads, packet, mailbox, isa,
/// density and grid. Throws std::invalid_argument for an instruction set that is unknown or does
/// not run here, or a bad camera or option. When `progress` stops it, what has no sample yet is
/// black. `maps` is filled when samples are spent by error.
Image render(const World& world,
             const Camera& camera,
             const RenderOptions& options,
             RenderStats& stats,
             SampleMaps* maps = nullptr);

}  // namespace grelha
