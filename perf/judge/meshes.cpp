#include "perf/judge/judge.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <utility>

#include "perf/workloads.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::perf {
namespace {

/// Each directed edge has as many triangles as the opposite one, by the places of its ends.
bool is_closed(const Triangles& t) {
  using Place = std::array<float, 3>;
  std::map<Place, int> ids;
  const auto id = [&](std::uint32_t v) {
    return ids.try_emplace({t.x[v], t.y[v], t.z[v]}, static_cast<int>(ids.size())).first->second;
  };
  std::map<std::pair<int, int>, int> sum;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const int v[3] = {id(t.a[i]), id(t.b[i]), id(t.c[i])};
    for (int k = 0; k < 3; ++k) {
      const int from = v[k], to = v[(k + 1) % 3];
      sum[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(sum.begin(), sum.end(), [](const auto& s) { return s.second == 0; });
}

std::vector<std::string> scans() {
  std::vector<std::string> names;
  for (const auto* name : {"T",
                           "armadillo",
                           "bunny10k",
                           "cube",
                           "dragon",
                           "horse",
                           "icosahedron",
                           "lucy",
                           "screwdriver",
                           "shark",
                           "suzanne",
                           "turbineblade"}) {
    const std::string path = std::string(GRELHA_SHARED_SCENES "/ply/") + name + ".ply";
    if (std::filesystem::exists(path))
      names.push_back(path);
  }
  return names;
}

/// A mesh alone: the triangles of a file or of `GENERATOR SIZE`.
Scene mesh_named(const std::string& name) {
  Scene s = scene_named(name).scene;
  s.geometry.spheres = {};
  s.geometry.cones = {};
  s.geometry.planes = {};
  for (auto* normals :
       {&s.geometry.triangles.nx, &s.geometry.triangles.ny, &s.geometry.triangles.nz})
    normals->clear();
  return s;
}

}  // namespace

std::vector<std::pair<std::string, Scene>> closed_meshes(const JudgeOptions& options) {
  std::vector<std::pair<std::string, Scene>> closed;
  for (const std::string& path : options.scenes.empty() ? scans() : options.scenes) {
    Scene mesh = mesh_named(path);
    const std::string name = std::filesystem::path(path).stem();
    if (is_closed(mesh.geometry.triangles))
      closed.emplace_back(name, std::move(mesh));
    else
      std::printf("# %s is not closed\n", name.c_str());
  }
  if (options.scenes.empty()) {
    closed.emplace_back("ball", test::ball_mesh(96, 48, .1));
    closed.emplace_back("torus", test::torus_mesh(96, 48, .4));
  }
  return closed;
}

}  // namespace grelha::perf
