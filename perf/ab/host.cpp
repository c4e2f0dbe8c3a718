// Times two copies of the kernel in turns, in one process, on the same rays, and compares every
// answer bit by bit. ab.py runs it, once a scene.
//
// ab_host --other LIBRARY --this LIBRARY --scene NAME [--kinds A,B] [--modes A,B] [--rounds N]
//         [--size N] [--embree 1]
//
// Prints CSV. A scene is a file, or GENERATOR SIZE. Times are ns a ray, the least of all rounds;
// that of Embree also of its ways of being asked that fit the mode.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "perf/ab/copies.hpp"
#include "perf/ab/exact_rays.hpp"
#include "perf/embree.hpp"
#include "perf/ray_sets.hpp"
#include "perf/timing.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr const char* kModeNames[] = {"render", "calls", "streams", "no-t"};  ///< by Way
constexpr struct {
  const char* name;
  RayKind kind;
} kPictureKinds[] = {{"primary", RayKind::kPrimary},
                     {"lens", RayKind::kLens},
                     {"area", RayKind::kArea},
                     {"glossy", RayKind::kGlossy},
                     {"scattered", RayKind::kScattered},
                     {"shadow", RayKind::kShadow},
                     {"mirror", RayKind::kMirror}};

struct Options {
  std::string other, now, scene;
  std::vector<std::string> kinds, modes;
  int rounds = 5, size = 512;
  bool embree = false;
};

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> found;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');)
    found.push_back(word);
  return found;
}

bool set_option(const std::string& word, const std::string& value, Options& o) {
  if (word == "--other")
    o.other = value;
  else if (word == "--this")
    o.now = value;
  else if (word == "--scene")
    o.scene = value;
  else if (word == "--kinds")
    o.kinds = words(value);
  else if (word == "--modes")
    o.modes = words(value);
  else if (word == "--rounds")
    o.rounds = std::atoi(value.c_str());
  else if (word == "--size")
    o.size = std::atoi(value.c_str());
  else if (word == "--embree")
    o.embree = value == "1";
  else
    return false;
  return true;
}

bool wanted(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A scene, and who traces its rays.
struct Arena {
  SceneFile file;
  CopyWorld other, now;
  std::unique_ptr<EmbreeScene> embree;

  Arena(SceneFile f, const KernelCopy& a, const KernelCopy& b, bool beside_embree)
      : file(std::move(f)), other(a, file.scene.geometry), now(b, file.scene.geometry) {
    if (beside_embree && !(embree = make_embree_scene(file.scene, true)))
      throw std::runtime_error("this build has no Embree");
  }
};

/// The least time that `run` has taken so far.
template <class Run>
void time(double& least, const Run& run) {
  const double start = cpu_ns();
  run();
  least = std::min(least, cpu_ns() - start);
}

bool fits(const EmbreeMode& m, Way way) {
  return way == kCalls ? m.width == 1 : way == kStreams ? m.width == 8 : true;
}

void measure(const Arena& arena,
             const char* kind,
             Way way,
             const RayBuffer& rays,
             bool any,
             const Options& options) {
  const CopyWorld* const worlds[] = {&arena.other, &arena.now};
  Answers answers[2];
  double least[] = {std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  double embree = std::numeric_limits<double>::max();
  for (Answers& a : answers)
    a.resize(rays.size(), any);
  // Each always follows the other: what follows itself would find its World in the cache.
  for (int round = 0; round < options.rounds; ++round)
    for (int who = 0; who < 2; ++who)
      time(least[who], [&] { worlds[who]->run(way, rays, answers[who]); });
  for (int round = 0; arena.embree && round < options.rounds; ++round)
    for (const EmbreeMode& m : embree_modes())
      if (fits(m, way))
        time(embree, [&] { arena.embree->trace(rays, any, m); });
  std::size_t differing = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    differing += !answers[1].same(i, answers[0], i);
  const auto count = static_cast<double>(rays.size());
  std::printf("%s,%s,%zu,%.2f,%.2f,",
              kind,
              kModeNames[way],
              rays.size(),
              least[0] / count,
              least[1] / count);
  if (arena.embree)
    std::printf("%.2f", embree / count);
  std::printf(",%zu\n", differing);
  std::fflush(stdout);
}

/// In every mode that was asked for.
void measure(
    const Arena& arena, const char* kind, const RayBuffer& rays, bool any, const Options& options) {
  if (rays.size() == 0)
    return;
  for (const Way way : {kAsRender, kCalls, kStreams, kWithoutT})
    if (wanted(options.modes, kModeNames[way]) && !(way == kWithoutT && any))
      measure(arena, kind, way, rays, any, options);
}

void run(const Options& options) {
  const KernelCopy other(options.other), now(options.now);
  SceneFile file = scene_named(options.scene);
  std::printf("kind,mode,rays,other_ns,this_ns,embree_ns,differing\n");
  {
    const Arena arena(file, other, now, options.embree);
    const World world(arena.file.scene, {});
    const RayMaker maker(arena.file, world, options.size);
    for (const auto& k : kPictureKinds)
      if (wanted(options.kinds, k.name))
        measure(arena, k.name, maker.make(k.kind), RayMaker::any_hit(k.kind), options);
  }
  if (!wanted(options.kinds, "vertices") && !wanted(options.kinds, "edges"))
    return;
  snap(file.scene.geometry.triangles);
  const Arena arena(std::move(file), other, now, options.embree);
  for (const char* const name : {"vertices", "edges"})
    if (wanted(options.kinds, name)) {
      const bool at_edges = name[0] == 'e';
      const RayBuffer rays = exact_rays(arena.file.scene.geometry.triangles, at_edges);
      measure(arena, name, rays, false, options);
    }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const auto set = [&](const std::string& word, const std::string& value) {
    return set_option(word, value, options);
  };
  if (!set_options(argc, argv, set) || options.rounds < 1 || options.size < 32) {
    std::fprintf(stderr, "ab_host: see `./run perf ab --help`\n");
    return 2;
  }
  try {
    run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "ab: %s\n", e.what());
    return 1;
  }
}
