// Measures the time to trace all rays of a picture and the time of the whole picture, with one
// thread and with two. The measurements take turns in one process.
//
// frame SCENE [ROUNDS]
//
// A 512 x 512 picture, one sample a pixel; JSON with the least of ROUNDS (9) times of each.
//
// frame.py runs this.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <utility>

#include <omp.h>

#include "frontend/input/read_scene.hpp"
#include "perf/frame_rays.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

int measure(const char* path, int rounds) {
  SceneFile file = read_scene(path, [](const std::string&) {});
  Camera camera = file.camera;
  camera.width = camera.height = 512;
  camera.aperture = 0;
  const World world(file.scene, BuildOptions{});
  const RenderOptions options;
  const FrameRays rays = rays_of_frame(world, camera, options);
  const auto whole = [&](int threads) {
    RenderOptions o = options;
    o.threads = threads;
    RenderStats stats;
    const double start = now_seconds(), cpu = cpu_seconds();
    render(world, camera, o, stats);
    return std::pair{now_seconds() - start, cpu_seconds() - cpu};
  };
  double one = 1e300, one_cpu = 1e300, two = 1e300, alone = 1e300;
  std::array<double, 3> least{1e300, 1e300, 1e300};
  for (int round = 0; round < rounds; ++round) {
    const auto [clock, cpu] = whole(1);
    one = std::min(one, clock);
    one_cpu = std::min(one_cpu, cpu);
    const auto t = trace_seconds(world, *find_variant("best"), {}, rays, 1);
    for (std::size_t k = 0; k < 3; ++k)
      least[k] = std::min(least[k], t[k]);
    alone = std::min(alone, t[0] + t[1] + t[2]);
    two = std::min(two, whole(2).first);
  }
  std::printf("{\"render\": %g, \"render cpu\": %g, \"render two threads\": %g, \"trace\": %g",
              one,
              one_cpu,
              two,
              alone);
  for (std::size_t k = 0; k < 3; ++k)
    std::printf(", \"%s\": {\"rays\": %zu, \"seconds\": %g}",
                kFrameKinds[k],
                rays[k].rays.size(),
                least[k]);
  std::printf("}\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: frame SCENE [ROUNDS]\n", stderr);
    return 2;
  }
  try {
    return measure(argv[1], argc > 2 ? std::atoi(argv[2]) : 9);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}
