// The ways of the 2019 report, one after the other, on all rays of a picture: JSON for report.py.
//
// report SCENE SAMPLES [ROUNDS]
//
// Pictures have 512 x 512 pixels and paths of at most 6 rays, as in the report's program.
//
// Without grid, with a grid of the report's M = 2 cell by cell, with mailboxes, with threads: the
// plain scalar walk of one ray and one primitive at a time. Then packets on the grid the kernel
// chooses. A picture's rays are recorded once and each way traces them all; where that would take
// long without grid, every so many-th. What a picture costs besides (camera rays, shading, queues)
// is measured in a whole render and the same for all.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>

#include <omp.h>

#include "perf/frame_rays.hpp"
#include "tests/reference/reference.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr double kMostTests = 2e9;  ///< ray against primitive, without grid

int measure(const char* path, int samples, int rounds) {
  SceneFile file = read_scene(path, [](const std::string&) {});
  Camera camera = file.camera;
  camera.width = camera.height = 512;
  if (samples == 1)
    camera.aperture = 0;
  RenderOptions options;
  options.depth = 6;
  options.sampling.samples = samples;
  options.phases = true;
  const World bare(file.scene, {.grid = false}), coarse(file.scene, {.density = 2}),
      world(file.scene, BuildOptions{});
  const FrameRays rays = rays_of_frame(world, camera, options);
  std::size_t count = 0;
  for (const RaySet& set : rays)
    count += set.rays.size();
  const Geometry& g = file.scene.geometry;
  const std::size_t primitives =
      g.spheres.size() + g.triangles.size() + g.cones.size() + g.planes.size();
  const std::size_t stride = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(count * primitives) / kMostTests + .5));
  const FrameRays few = stride > 1 ? thinned(rays, stride) : FrameRays{};

  const int threads = omp_get_num_procs();
  std::map<std::string, double> least;
  const auto keep = [&](const std::string& name, double seconds) {
    const auto [at, fresh] = least.try_emplace(name, seconds);
    if (!fresh)
      at->second = std::min(at->second, seconds);
  };
  const auto trace_all = [&](const World& w, const TraceSettings& s, const FrameRays& r, int n) {
    const auto t = trace_seconds(w, reference_walk(), s, r, n);
    return t[0] + t[1] + t[2];
  };
  const TraceSettings plain{.mailbox = false}, mailbox{.mailbox = true};
  for (int round = 0; round < rounds; ++round) {
    for (const int n : {1, threads}) {
      RenderOptions o = options;
      o.threads = n;
      RenderStats stats;
      const auto now = n == 1 ? cpu_seconds : now_seconds;
      const double start = now();
      render(world, camera, o, stats);
      const double whole = now() - start;
      const std::string with = n == 1 ? "" : " threads";
      keep("packets" + with, whole);
      const auto of = [&](Phase p) { return stats.phases[static_cast<std::size_t>(p)]; };
      double all = 0;
      for (const double s : stats.phases)
        all += s;
      keep("rest" + with,
           whole * (1 - (of(Phase::primary) + of(Phase::bounce) + of(Phase::shadow)) / all));
    }
    keep("grid", trace_all(coarse, plain, rays, 1));
    keep("mailboxes", trace_all(coarse, mailbox, rays, 1));
    keep("grid threads", trace_all(coarse, plain, rays, threads));
    if (round == 0 || stride == 1)
      keep("no grid", trace_all(bare, plain, stride > 1 ? few : rays, 1));
  }
  std::size_t traced = 0;
  for (const RaySet& set : stride > 1 ? few : rays)
    traced += set.rays.size();
  least["no grid"] *= static_cast<double>(count) / static_cast<double>(traced);
  std::printf("{\"rays\": %zu, \"primitives\": %zu, \"stride\": %zu, \"threads\": %d",
              count,
              primitives,
              stride,
              threads);
  for (const auto& [name, seconds] : least)
    std::printf(", \"%s\": %g", name.c_str(), seconds);
  std::printf("}\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3)
    return std::fputs("usage: report SCENE SAMPLES [ROUNDS]\n", stderr), 2;
  try {
    return measure(argv[1], std::atoi(argv[2]), argc > 3 ? std::atoi(argv[3]) : 3);
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "%s\n", e.what()), 1;
  }
}
