// The call that python_time.py measures, in C++: nearest hits of rays at a mesh.
//
// same_call FOLDER ROUNDS THREADS
//
// FOLDER holds vertices, faces, origins and directions: float32 or uint32, three a row. Prints the
// least seconds of the rounds for all rays, into arrays that are there, and for one ray.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "grelha/owning_world.hpp"
#include "grelha/query.hpp"

namespace {

using namespace grelha;
using Clock = std::chrono::steady_clock;

template <class Row>
std::vector<Row> rows(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<Row> read(static_cast<std::size_t>(file.tellg()) / sizeof(Row));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(read.data()),
            static_cast<std::streamsize>(read.size() * sizeof(Row)));
  return read;
}

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4)
    return 2;
  const std::string folder = argv[1];
  const int rounds = std::atoi(argv[2]);
  const auto vertices = rows<Float3>(folder + "/vertices");
  const auto faces = rows<std::array<std::uint32_t, 3>>(folder + "/faces");
  const OffsetScene scene =
      scene_of(PointArray(vertices), triangles_of<std::uint32_t>(faces, vertices.size()));
  const World world(scene, {});
  const auto org = rows<Float3>(folder + "/origins"), dir = rows<Float3>(folder + "/directions");
  const auto t = std::make_unique_for_overwrite<float[]>(org.size());
  const auto u = std::make_unique_for_overwrite<float[]>(org.size());
  const auto v = std::make_unique_for_overwrite<float[]>(org.size());
  const auto id = std::make_unique_for_overwrite<std::uint32_t[]>(org.size());
  double many = 1e300, one = 1e300;
  std::size_t met = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto start = Clock::now();
    closest(world,
            Rays::of(org, dir),
            {.t = t.get(), .id = id.get(), .u = u.get(), .v = v.get()},
            {.threads = std::atoi(argv[3])});
    many = std::min(many, since(start));
    met += id[0] != kNoPrimitive;
    constexpr std::size_t kCalls = 2000;
    const std::size_t step = org.size() / kCalls;
    const auto calls = Clock::now();
    for (std::size_t i = 0; i < kCalls; ++i)
      met += closest(world, Ray{org[i * step], dir[i * step]}) ? 1 : 0;
    one = std::min(one, since(calls) / kCalls);
  }
  std::printf("%.9f %.9f %zu\n", many, one, met);
  return 0;
}
