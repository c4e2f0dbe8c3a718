#pragma once
// One scene, as Grelha and Embree hold it.

#include <memory>
#include <string>

#include "grelha/render.hpp"
#include "perf/embree.hpp"
#include "perf/ray_sets.hpp"
#include "perf/trace/options.hpp"

namespace grelha::perf {

struct Place {
  std::string name;
  SceneFile file;
  World world;
  RayMaker maker;
  std::unique_ptr<EmbreeScene> robust, fast;
  Place(std::string n, SceneFile f, int size);
};

/// The row's scene. Scenes are large: only the last one asked for is kept.
Place& place(const Row& row, const Options& options);

}  // namespace grelha::perf
