#include "perf/judge/hard_rays.hpp"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "tests/support/scenes.hpp"

namespace grelha::perf {
namespace {

using test::at;
using test::minus;
using test::Random;

/// Triangles a second time, their corners in another order.
Scene with_copies(Scene s) {
  Triangles& t = s.geometry.triangles;
  for (std::size_t i = 0, n = t.a.size(); i < n; ++i) {
    t.a.push_back(t.b[i]);
    t.b.push_back(t.c[i]);
    t.c.push_back(t.a[i]);
    t.material.push_back(0);
  }
  return s;
}

Scene slivers(int n) {
  Random random(5);
  Scene s = test::empty_scene();
  for (int i = 0; i < n; ++i) {
    const Float3 a = random.point(1);
    const Float3 b = random.point(1);
    test::add_triangle(s, a, b, at(at(a, random.unit(), minus(b, a)), 1e-6, random.direction()));
  }
  return s;
}

}  // namespace

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
    all.push_back({"ball twice", with_copies(test::ball_mesh(12, 8))});
    all.push_back({"lattice", test::lattice_patch(12)});
    all.push_back({"slivers", slivers(300)});
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
