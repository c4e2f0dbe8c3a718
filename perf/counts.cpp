// Counts the boxes and triangles that single rays test, and compares them with those of a BVH
// (counts/bvh8.hpp). Counts have no timing noise.
//
// counts [--size N] [--most RATIO] [--scene NAME]...
//
// A scene is a file or `GENERATOR SIZE`; only its triangles are used. For Grelha the program counts
// rows: up to eight boxes or triangles against one ray. For the BVH it counts nodes and leaves.
// With --most the program fails if the ratio of Grelha's count to the BVH's is above RATIO.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "grelha/query.hpp"
#include "perf/counts/bvh8.hpp"
#include "perf/ray_sets.hpp"
#include "perf/workloads.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

struct Options {
  int size = 256;
  double most = 0;  ///< 0: none is set
  std::vector<std::string> scenes;
};

/// The triangles of a scene alone.
SceneFile triangles_of(const std::string& name) {
  SceneFile file = scene_named(name);
  file.scene.geometry.spheres = {};
  file.scene.geometry.cones = {};
  file.scene.geometry.planes = {};
  return file;
}

struct Ours {
  double visits, boxes, triangles, hits;
};

Ours count_ours(const World& world, const RayBuffer& rays, bool any) {
  TraceCounts counts;
  Answers answers;
  answers.resize(rays.size(), any);
  if (any)
    occluded(world, rays.view(), answers.blocked.data(), {.packet = 1}, &counts);
  else
    closest(world, rays.view(), {answers.t.data(), answers.id.data()}, {.packet = 1}, &counts);
  std::uint64_t hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits += answers.met(i);
  const auto each = [&](std::uint64_t n) {
    return static_cast<double>(n) / static_cast<double>(rays.size());
  };
  return {
      each(counts.visits),
      each(counts.rows.boxes),
      each(counts.rows.primitives),
      each(hits),
  };
}

/// Rays that may hit something in the one and nothing in the other.
constexpr double kDisagree = .005;

/// A row of the table. False: ours is more than asked, or the tree's rays hit other things.
bool count(const std::string& name,
           const World& world,
           const Bvh8& tree,
           const RayBuffer& rays,
           RayKind kind,
           double most) {
  const bool any = RayMaker::any_hit(kind);
  const Ours ours = count_ours(world, rays, any);
  TreeCounts theirs;
  for (std::size_t i = 0; i < rays.size(); ++i)
    tree.count({{rays.ox[i], rays.oy[i], rays.oz[i]},
                {rays.dx[i], rays.dy[i], rays.dz[i]},
                rays.t_min[i],
                rays.t_max[i]},
               any,
               theirs);
  const auto n = static_cast<double>(rays.size());
  const double nodes = static_cast<double>(theirs.nodes) / n;
  const double leaves = static_cast<double>(theirs.leaves) / n;
  const double ratio = (ours.boxes + ours.triangles) / (nodes + leaves);
  std::printf("| %s | %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n",
              name.c_str(),
              kRayKinds[static_cast<std::size_t>(kind)],
              ours.visits,
              ours.boxes,
              ours.triangles,
              nodes,
              leaves,
              ratio);
  const bool same = std::abs(static_cast<double>(theirs.hits) / n - ours.hits) <= kDisagree;
  return same && (most == 0 || ratio <= most);
}

bool count_scene(const std::string& name, const Options& o) {
  const SceneFile file = triangles_of(name);
  const World world(file.scene, {});
  const RayMaker maker(file, world, o.size);
  const Bvh8 tree(file.scene.geometry.triangles);
  const auto slash = name.rfind('/');
  const std::string shown = slash == std::string::npos ? name : name.substr(slash + 1);
  bool within = true;
  for (const RayKind kind : {RayKind::kShadow, RayKind::kMirror, RayKind::kScattered})
    within &= count(shown, world, tree, maker.make(kind), kind, o.most);
  return within;
}

bool set_option(const std::string& word, const std::string& value, Options& o) {
  if (word == "--scene")
    o.scenes.push_back(value);
  else if (word == "--size")
    o.size = std::atoi(value.c_str());
  else if (word == "--most")
    o.most = std::atof(value.c_str());
  else
    return false;
  return o.size >= 32 && o.size <= 4096;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const auto set = [&](const char* word, const char* value) {
    return set_option(word, value, options);
  };
  if (!set_options(argc, argv, set)) {
    std::fprintf(stderr, "usage: counts [--size N] [--most RATIO] [--scene NAME]...\n");
    return 2;
  }
  if (options.scenes.empty())
    options.scenes = {"mount 8", "knot 15", "gears 4"};
  std::printf(
      "| scene | rays | cells | rows of boxes | rows of triangles | nodes | leaves | "
      "rows / nodes and leaves |\n|---|---|--:|--:|--:|--:|--:|--:|\n");
  bool within = true;
  for (const std::string& scene : options.scenes)
    within &= count_scene(scene, options);
  return within ? 0 : 1;
}
