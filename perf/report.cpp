// The ways of the 2019 report, one after the other, on all rays of a picture: JSON for report.py.
//
// report SCENE SAMPLES [ROUNDS]
//
// Pictures have 512 x 512 pixels and paths of at most 6 rays, as in the report's program.
//
// The first methods are the plain scalar walk of one ray and one primitive at a time: without grid,
// with a grid of the report's M = 2, with mailboxes, with threads. The last one traces packets on
// the grid that the kernel chooses. The rays of a picture are recorded once, and each method traces
// every ray; without grid only every n-th ray if all would take too long. The remaining cost of a
// picture (camera rays, shading, queues) is measured in a whole render and is the same for all
// methods.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>

#include <omp.h>

#include "frontend/input/read_scene.hpp"
#include "perf/frame_rays.hpp"
#include "tests/reference/reference.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr int kSide = 512, kDepth = 6;
constexpr double kMostTests = 2e9;  ///< ray against primitive, without grid

/// A picture of a scene, and the least seconds of each way to trace it.
struct Picture {
  SceneFile file;
  Camera camera;
  RenderOptions options;
  World bare{file.scene, {.grid = false}};
  World coarse{file.scene, {.density = 2}};
  World world{file.scene, {}};
  FrameRays rays = rays_of_frame(world, camera, options);
  std::map<std::string, double> least{};

  void keep(const std::string& way, double seconds) {
    const auto [at, fresh] = least.try_emplace(way, seconds);
    if (!fresh)
      at->second = std::min(at->second, seconds);
  }
  std::size_t primitives() const {
    const Geometry& g = file.scene.geometry;
    return g.spheres.size() + g.triangles.size() + g.cones.size() + g.planes.size();
  }
};

std::size_t count_of(const FrameRays& rays) {
  std::size_t count = 0;
  for (const RaySet& set : rays)
    count += set.rays.size();
  return count;
}

/// Times whole renders, and their time outside of tracing.
void render_packets(Picture& p, int threads) {
  RenderOptions o = p.options;
  o.threads = threads;
  RenderStats stats;
  const auto now = threads == 1 ? cpu_seconds : now_seconds;
  const double start = now();
  render(p.world, p.camera, o, stats);
  const double whole = now() - start;
  const std::string with = threads == 1 ? "" : " threads";
  p.keep("packets" + with, whole);
  const auto of = [&](Phase phase) { return stats.phases[static_cast<std::size_t>(phase)]; };
  double all = 0;
  for (const double s : stats.phases)
    all += s;
  const double tracing = of(Phase::primary) + of(Phase::bounce) + of(Phase::shadow);
  p.keep("rest" + with, whole * (1 - tracing / all));
}

double trace_all(const World& w, const TraceOptions& settings, const FrameRays& rays, int threads) {
  const auto t = trace_seconds(w, reference_walk(), settings, rays, threads);
  return t[0] + t[1] + t[2];
}

void print(const Picture& p, std::size_t stride, int threads) {
  std::printf("{\"rays\": %zu, \"primitives\": %zu, \"stride\": %zu, \"threads\": %d",
              count_of(p.rays),
              p.primitives(),
              stride,
              threads);
  for (const auto& [name, seconds] : p.least)
    std::printf(", \"%s\": %g", name.c_str(), seconds);
  std::printf("}\n");
}

/// Returns n if every n-th ray is traced without grid.
std::size_t stride_without_grid(const Picture& p) {
  const double tests = static_cast<double>(count_of(p.rays) * p.primitives());
  return std::max<std::size_t>(1, static_cast<std::size_t>(tests / kMostTests + .5));
}

void measure(Picture& p, int rounds) {
  const std::size_t stride = stride_without_grid(p);
  const FrameRays few = stride > 1 ? thinned(p.rays, stride) : FrameRays{};
  const FrameRays& some = stride > 1 ? few : p.rays;
  const int threads = omp_get_num_procs();
  const TraceOptions plain{.mailbox = false}, mailbox{.mailbox = true};
  for (int round = 0; round < rounds; ++round) {
    for (const int n : {1, threads})
      render_packets(p, n);
    p.keep("grid", trace_all(p.coarse, plain, p.rays, 1));
    p.keep("mailboxes", trace_all(p.coarse, mailbox, p.rays, 1));
    p.keep("grid threads", trace_all(p.coarse, plain, p.rays, threads));
    if (round == 0 || stride == 1)
      p.keep("no grid", trace_all(p.bare, plain, some, 1));
  }
  const double traced = static_cast<double>(count_of(some));
  p.least["no grid"] *= static_cast<double>(count_of(p.rays)) / traced;
  print(p, stride, threads);
}

void measure(const char* path, int samples, int rounds) {
  const SceneFile file = read_scene(path, [](const std::string&) {});
  Camera camera = file.camera;
  camera.width = camera.height = kSide;
  if (samples == 1)
    camera.aperture = 0;
  RenderOptions options;
  options.depth = kDepth;
  options.sampling.samples = samples;
  options.phases = true;
  Picture picture{file, camera, options};
  measure(picture, rounds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fputs("usage: report SCENE SAMPLES [ROUNDS]\n", stderr);
    return 2;
  }
  try {
    measure(argv[1], std::atoi(argv[2]), argc > 3 ? std::atoi(argv[3]) : 3);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
