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

}  // namespace grelha
