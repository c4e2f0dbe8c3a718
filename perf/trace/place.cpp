#include "perf/trace/place.hpp"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "frontend/input/read_scene.hpp"

namespace grelha::perf {
namespace {

/// The row's file where it is there, else what its generator makes.
SceneFile scene_of(const Row& row, const Options& options) {
  std::string path = row.file;
  if (!path.empty() && !std::filesystem::exists(path))
    path = options.scenes + "/" + row.file;
  if (!row.file.empty() && std::filesystem::exists(path))
    return read_scene(path, [](const std::string&) {});
  if (row.generator.empty())
    throw std::invalid_argument("no scene " + row.name);
  if (!row.file.empty())
    std::printf("%s: %s is not there; %s %d in its place\n",
                row.name.c_str(),
                row.file.c_str(),
                row.generator.c_str(),
                row.size);
  return make_scene(row.generator, row.size);
}

}  // namespace

Place::Place(std::string n, SceneFile f, int size)
    : name(std::move(n)),
      file(std::move(f)),
      world(file.scene, {}),
      maker(file, world, size),
      robust(make_embree_scene(file.scene, true)),
      fast(make_embree_scene(file.scene, false)) {}

Place& place(const Row& row, const Options& options) {
  static std::unique_ptr<Place> last;
  if (last && last->name == row.name)
    return *last;
  last.reset();
  last = std::make_unique<Place>(row.name, scene_of(row, options), options.size);
  return *last;
}

}  // namespace grelha::perf
