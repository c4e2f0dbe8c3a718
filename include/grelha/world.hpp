#pragma once
// Scenes made ready for rays.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "grelha/stats.hpp"

namespace grelha {

/// How a World is built. None of it changes a picture.
struct BuildOptions {
  bool grid = true;  ///< false: every ray meets every primitive
  /// M of the grid's resolution M cbrt(count / volume) per unit length; 0: the kernel chooses
  float density = 0;
  int threads = 0;  ///< 0: one per processor. The number changes no bit of the grid.
  /// Most bytes beside the scene's own arrays; 0: any. A build that will probably take more throws
  /// TooLarge before it begins.
  std::uint64_t most_bytes = 0;
  /// Called now and then from one thread at a time with the share done, which grows from 0 to 1.
  /// Returns false to have the constructor throw Stopped.
  std::function<bool(double)> progress{};
};

/// Bytes, beside the scene's own arrays.
struct BuildMemory {
  std::uint64_t peak = 0;  ///< while a World is built
  std::uint64_t kept = 0;  ///< as long as it lives
};

/// Thrown by a function whose progress said to stop.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }  ///< no more than that
};

/// A World would take more memory than BuildOptions allow.
struct TooLarge : std::runtime_error {
  /// The error of a build that needs `n`.
  explicit TooLarge(BuildMemory n)
      : std::runtime_error("the scene needs more memory than it may have"), need(n) {}
  BuildMemory need;  ///< what the build would take, by World::estimate()
};

/// A scene made ready for rays. It refers to the arrays of the geometry it was built from, which
/// must outlive it unchanged; materials and lights are copied. A built World never changes, so
/// threads may share it. There may be many Worlds.
class World {
 public:
  /// Builds the grids. Throws std::invalid_argument for arrays of unequal lengths and for indices
  /// beyond their arrays, TooLarge and Stopped as the options say.
  World(const SceneSpans& scene, const BuildOptions& options);
  ~World();
  /// Predicts what building will take, within a fifth (docs/performance.md), in about a tenth of
  /// the time.
  static BuildMemory estimate(const SceneSpans& scene, const BuildOptions& options);
  World(World&&) noexcept;             ///< the source can only be destroyed or assigned to
  World& operator=(World&&) noexcept;  ///< the same

  /// One grid for the loose primitives and one for each larger object.
  std::vector<GridStats> grids() const;
  std::size_t geometry_bytes() const;  ///< the scene's own arrays
  std::size_t grid_bytes() const;      ///< everything built beside them

  struct Impl;  ///< the kernel's own
  /// For the kernel alone.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace grelha
