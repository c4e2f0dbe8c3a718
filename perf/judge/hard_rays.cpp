#include "perf/judge/hard_rays.hpp"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "tests/support/hard_meshes.hpp"

namespace grelha::perf {
using test::at;
using test::minus;
using test::Random;

std::vector<Mesh> hard_meshes(const JudgeOptions& options) {
  std::vector<Mesh> all;
  std::vector<std::string> files = options.scenes;
  if (files.empty())
    for (const char* name : {"bunny", "armadillo", "horse"})
      files.push_back(std::string(GRELHA_SHARED_SCENES "/ply/") + name + ".ply");
  for (const std::string& file : files)
    if (std::filesystem::exists(file) || !options.scenes.empty())
      all.push_back({std::filesystem::path(file).stem(), mesh_named(file), true});
    else
      std::printf("# skipped: there is no %s\n", file.c_str());
  if (options.scenes.empty()) {
    all.push_back({"ball", test::ball_mesh(24, 12, .1)});
    all.push_back({"ball twice", test::with_copies(test::ball_mesh(12, 8))});
    all.push_back({"lattice", test::lattice_patch(12)});
    all.push_back({"slivers", test::slivers(5, 300)});
  }
  return all;
}

Ray ray_of(const MovedMesh& m, int kind, double away, Random& random) {
  const Triangles& t = m.scene.geometry.triangles;
  const std::uint32_t k = random.below(static_cast<std::uint32_t>(t.a.size()));
  const Float3 a = test::vertex(m.scene, t.a[k]);
  const Float3 b = test::vertex(m.scene, t.b[k]);
  const Float3 c = test::vertex(m.scene, t.c[k]);
  const Float3 on_edge = at(a, random.unit(), minus(b, a));
  const Float3 inside = at(on_edge, .5 * random.unit(), minus(c, on_edge));
  const Float3 org = at(m.middle, away * m.diagonal, random.direction());
  switch (kind) {
    case 0:
      return {org, minus(a, org)};
    case 1:
      return {org, minus(on_edge, org)};
    case 2:
      return {at(a, -away * random.unit(), minus(b, a)), minus(b, a)};
    case 3:
      return {at(a, -away, minus(inside, a)), minus(inside, a)};
    default:
      return {org, minus(inside, org)};
  }
}

}  // namespace grelha::perf
