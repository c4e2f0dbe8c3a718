#pragma once
// Embree on the same scene and the same rays, where CMake found it.

#include <memory>
#include <string>
#include <vector>

#include "perf/workloads.hpp"

namespace grelha::perf {

/// How Embree is asked: rays one by one or `width` side by side, with its hint that they are
/// coherent or that they are not.
struct EmbreeMode {
  const char* name;
  int width;
  bool coherent;
};

inline constexpr double kPlaneReach = 100;

/// A scene built by Embree, quality MEDIUM. Spheres are sphere points, cones cone curves (which
/// have caps; Grelha's have none), planes squares of two triangles that end kPlaneReach widths of
/// the scene away from its middle: larger ones would be hit inexactly.
class EmbreeScene {
 public:
  virtual ~EmbreeScene() = default;
  /// Loads each ray, traces it, stores t and what Embree names the primitive by: closest hits, or
  /// with `any` whether there is one.
  virtual void trace(const RayBuffer& rays, bool any, const EmbreeMode& mode) = 0;
  /// The last trace's answers with Grelha's ids.
  virtual Answers answers() const = 0;
  /// Copies moved spheres and vertices of triangles, as many as before; of one object alone, unless
  /// it is kAll.
  virtual void move(const Scene& scene, std::size_t object) = 0;
  static constexpr std::size_t kAll = ~std::size_t{0};
  /// Makes what moved visible to rays.
  virtual void commit() = 0;
};

/// "Embree 3.13.5": the one that runs. Empty without Embree.
std::string embree_name();
/// Empty without Embree.
std::vector<EmbreeMode> embree_modes();
/// Null without Embree.
std::unique_ptr<EmbreeScene> make_embree_scene(const Scene& scene, bool robust);
/// How Embree builds a scene that moves: its quality LOW or MEDIUM, or REFIT.
enum class MovingScene { kLow, kMedium, kRefit };
/// Of the flag for robust scenes. Objects that have all triangles are geometries of their own. Null
/// without Embree.
std::unique_ptr<EmbreeScene> make_moving_embree_scene(const Scene& scene, MovingScene how);

}  // namespace grelha::perf
