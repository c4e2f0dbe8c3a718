#pragma once
// Embree's builds of a scene, where CMake found it.

#include <memory>

#include "grelha/render.hpp"

namespace grelha::perf {

enum class Quality { kLow, kMedium };

struct Built {
  double seconds;
  double bytes;  ///< that the scene keeps, its arrays among it
};

/// A scene's arrays, made once, and a device; each build is of a new scene over them. Planes are
/// left out.
class EmbreeBuilds {
 public:
  virtual ~EmbreeBuilds() = default;
  virtual Built build(Quality quality) = 0;
};

/// Null without Embree.
std::unique_ptr<EmbreeBuilds> make_embree_builds(const Scene& scene, int threads);
bool has_embree();

}  // namespace grelha::perf
