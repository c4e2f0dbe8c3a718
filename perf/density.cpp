// Measures the cost of a ray as a function of the grid density M, by kind of ray and scene, and
// compares the kernel's own choice of M with it.
//
// density [--scene GENERATOR SIZE | FILE]... [--size N] [--rounds N] [--csv]
//
// All grids of a scene trace the same rays in one process and take turns. A ratio is the median
// over the rounds of the ratio of two CPU times of one round. Answers must have the same bits at
// every density. The kinds of rays are those of `trace` (perf/ray_sets.hpp); the last row of a
// scene is a whole plain picture, twice as wide. Columns: ns per ray (per picture) with the
// kernel's own choice, the ratio of that time to the best of all M, and the ratio of each M to that
// time.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/grid/world_impl.hpp"
#include "perf/ray_sets.hpp"
#include "perf/timing.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr float kChosen = 0;  ///< the kernel's own
constexpr float kDensities[] = {kChosen, .35f, .5f, .7f, 1, 1.4f, 2, 3};
constexpr std::size_t kWays = std::size(kDensities);

struct Options {
  std::vector<std::string> scenes;
  int size = 256, rounds = 5;
  bool csv = false;
};

/// CPU time of each density relative to that of the kernel's own choice, and this in ns.
struct Cell {
  double ratio[kWays], chosen_ns;
};

/// `work(w)` is what to time of the world w, once before anything is timed.
template <class Work>
Cell measure(int rounds, const Work& work) {
  std::vector<double> ns[kWays];
  for (std::size_t w = 0; w < kWays; ++w)
    work(w);
  for (int round = 0; round < rounds; ++round)
    for (std::size_t w = 0; w < kWays; ++w) {
      const double start = cpu_ns();
      work(w);
      ns[w].push_back(cpu_ns() - start);
    }
  Cell cell;
  cell.chosen_ns = median(ns[0]);
  for (std::size_t w = 0; w < kWays; ++w) {
    std::vector<double> r;
    for (std::size_t i = 0; i < ns[w].size(); ++i)
      r.push_back(ns[w][i] / ns[0][i]);
    cell.ratio[w] = median(r);
  }
  return cell;
}

using Worlds = std::vector<std::unique_ptr<World>>;

void trace_all(const World& world, const RayBuffer& rays, bool any, Answers& a) {
  TraceCounts unused;
  trace(world, *find_variant("best"), {}, rays.view(), any, a, unused);
}

Cell measure_kind(const Options& options, const Worlds& worlds, const RayBuffer& rays, bool any) {
  Answers truth, a;
  trace_all(*worlds[0], rays, any, truth);
  for (const auto& world : worlds) {
    trace_all(*world, rays, any, a);
    if (a != truth)
      throw std::runtime_error("wrong hits");
  }
  Cell cell = measure(options.rounds, [&](std::size_t w) { trace_all(*worlds[w], rays, any, a); });
  cell.chosen_ns /= static_cast<double>(rays.size());
  return cell;
}

/// A whole plain picture as the scene asks for it, by one thread.
Cell measure_picture(const Options& options, const SceneFile& file, const Worlds& worlds) {
  Camera camera = file.camera;
  camera.width = camera.height = 2 * options.size;
  camera.aperture = 0;
  RenderOptions render_options;
  render_options.threads = 1;
  RenderStats unused;
  return measure(options.rounds,
                 [&](std::size_t w) { render(*worlds[w], camera, render_options, unused); });
}

void print(const Options& options, const std::string& scene, const char* kind, const Cell& cell) {
  const double best = *std::min_element(std::begin(cell.ratio) + 1, std::end(cell.ratio));
  std::printf(options.csv ? "%s,%s,%.1f,%.3f" : "%-22s %-12s %10.1f %4.2f; ",
              scene.c_str(),
              kind,
              cell.chosen_ns,
              1 / best);
  for (std::size_t w = 1; w < kWays; ++w)
    std::printf(options.csv ? ",%.3f" : " %4.2f", cell.ratio[w]);
  std::printf("\n");
  std::fflush(stdout);
}

void run(const Options& options, const std::string& name) {
  const SceneFile file = scene_named(name);
  Worlds worlds;
  for (const float m : kDensities)
    worlds.push_back(std::make_unique<World>(file.scene, BuildOptions{.density = m}));
  const RayMaker maker(file, *worlds[0], options.size);
  const std::string shown = name.substr(name.rfind('/') + 1);
  for (std::size_t k = 0; k < kRayKinds.size(); ++k) {
    const RayBuffer rays = maker.make(static_cast<RayKind>(k));
    if (rays.size() >= 64)
      print(options,
            shown,
            kRayKinds[k],
            measure_kind(options, worlds, rays, RayMaker::any_hit(static_cast<RayKind>(k))));
  }
  print(options, shown, "picture", measure_picture(options, file, worlds));
}

bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--csv")
      o.csv = true;
    else if (i + 1 == argc)
      return false;
    else if (word == "--scene")
      o.scenes.push_back(argv[++i]);
    else if (word == "--size")
      o.size = std::atoi(argv[++i]);
    else if (word == "--rounds")
      o.rounds = std::atoi(argv[++i]);
    else
      return false;
  }
  if (o.scenes.empty())
    o.scenes = {"balls 4",
                "balls 5",
                "balls 6",
                "mount 6",
                "mount 8",
                "mount 9",
                "gears 4",
                "rings 7",
                "tree 11",
                "tetra 6",
                "lattice 12",
                "stadium 6",
                "knot 8"};
  return o.size >= 32 && o.size <= 16384 && o.rounds >= 1;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(
        stderr,
        "usage: density [--scene 'GENERATOR SIZE' | FILE]... [--size N] [--rounds N] [--csv]\n");
    return 2;
  }
  std::printf(
      options.csv ? "%s,%s,ns,over best" : "%-22s %-12s %10s %4s; ", "scene", "kind", "ns", "over");
  for (std::size_t w = 1; w < kWays; ++w)
    std::printf(options.csv ? ",%g" : " %4g", static_cast<double>(kDensities[w]));
  std::printf("\n");
  for (const std::string& scene : options.scenes)
    run(options, scene);
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "density: %s\n", e.what());
  return 1;
}
