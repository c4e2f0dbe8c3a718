#pragma once
// A scene with the acceleration structures to trace rays through it.

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "grelha/stats.hpp"

namespace grelha {

/// Least diagonal of the box around a scene, unless it is 0: cells of less have no float for their
/// inverse.
inline constexpr float kLeastScene = 1e-33f;

/// How a World is built. These options change speed and memory, never a picture.
struct BuildOptions {
  bool grid = true;  ///< false: every ray is tested against every primitive
  /// M of the grid's resolution M cbrt(count / volume) per unit length; 0: the kernel chooses
  float density = 0;
  int threads = 0;  ///< 0: one per processor. The number changes no bit of the grid.
  /// Limit of the memory for building, without the scene's own arrays, in bytes; 0: no limit. If
  /// the estimate exceeds it, the constructor throws TooLarge before it builds anything.
  std::uint64_t most_bytes = 0;
  /// Called repeatedly, by one thread at a time, with the fraction done, which grows from 0 to 1.
  /// If it returns false, the constructor throws Stopped.
  std::function<bool(double)> progress{};
};

/// Memory in bytes, without the scene's own arrays.
struct BuildMemory {
  std::uint64_t peak = 0;  ///< while a World is built
  std::uint64_t kept = 0;  ///< during its lifetime
};

/// Thrown by a function after its progress callback returned false.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "stopped"; }  ///< no more than that
};

/// Thrown if a World would take more memory than BuildOptions::most_bytes.
struct TooLarge : std::runtime_error {
  /// The error of a build that needs `n`.
  explicit TooLarge(BuildMemory n)
      : std::runtime_error("the scene needs more memory than it may have"), need(n) {}
  BuildMemory need;  ///< memory that the build would take, by World::estimate()
};

/// A scene and its grids, ready for ray queries. It refers to the arrays of the geometry that it
/// was built from, which must stay unchanged for its lifetime. Materials and lights are copied. A
/// World is immutable, so threads may share it. A program may have any number of Worlds.
class World {
 public:
  /// Builds the grids. Throws std::invalid_argument if arrays that belong together differ in
  /// length, an index is out of range, or the scene is smaller than kLeastScene. Throws TooLarge
  /// and Stopped as BuildOptions describe.
  World(const SceneSpans& scene, const BuildOptions& options);
  /// The same where the triangles of some objects moved since `before`, new ones stand behind the
  /// others, or some were hidden or shown, and nothing else changed: `moved` names the ranges of
  /// those that moved or are new. Grids over other objects are shared with `before`, not built, if
  /// they would have the same cells: mostly while the size of the scene stays about the same. Only
  /// the indices of what moved are checked. Objects that moved get grids of their own before others
  /// do. Each of the two may outlive the other.
  World(const SceneSpans& scene,
        const BuildOptions& options,
        const World& before,
        std::span<const Object> moved);
  ~World();
  /// Estimates the memory that building takes, within a fifth (docs/performance.md), in about a
  /// tenth of the building time.
  static BuildMemory estimate(const SceneSpans& scene, const BuildOptions& options);
  World(World&&) noexcept;             ///< the source can only be destroyed or assigned to
  World& operator=(World&&) noexcept;  ///< the same

  /// Replaces the scene, for example after its vertices moved: the same as building a new World,
  /// bit for bit. No query may run at the same time. Throws what the constructor throws, and then
  /// leaves the World as it was.
  void update(const SceneSpans& scene, const BuildOptions& options);

  /// The same where the triangles of some objects moved, and nothing else changed: it keeps the
  /// grids that the constructor would share.
  void update(const SceneSpans& scene, const BuildOptions& options, std::span<const Object> moved);

  /// Returns the size of each grid: one for the loose primitives and one for each larger object.
  std::vector<GridStats> grids() const;
  std::size_t geometry_bytes() const;  ///< the scene's own arrays
  std::size_t grid_bytes() const;      ///< everything built in addition

  struct Impl;  ///< internal to the kernel
  /// For internal use by the kernel.
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace grelha
