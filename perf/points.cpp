// What rays to a point cost through a grid in its perspective, beside the scene's own grids and
// Embree on the same rays: one thread, one process, taking turns.
//
// points [--scene NAME]... [--size N] [--rounds N]
//
// The point is the scene's first light. Points that ask are what a camera of N x N pixels meets,
// and what mirrors there would show, where they face the light; in the order of the picture.
// A scene is `GENERATOR SIZE` or a file, below the folder of real scenes or elsewhere. No way is
// timed whose answers are wrong: those of the point grid are the World's, Embree's differ in
// kDisagree of them. Building is of one thread, by the clock of the processor.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "frontend/input/read_scene.hpp"
#include "grelha/point_grid.hpp"
#include "perf/embree.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr double kDisagree = .005;

const char* const kScenes[] = {"balls 4",
                               "balls 5",
                               "mount 6",
                               "mount 8",
                               "gears 4",
                               "rings 7",
                               "stadium 6",
                               "spd/teapot.nff",
                               "ply/bunny.ply",
                               "ply/dragon.ply",
                               "ply/armadillo.ply"};

struct Options {
  std::vector<std::string> scenes;
  int size = 512, rounds = 7;
};

/// Points that ask, and the same as rays; of unit length, as Embree's cone curves want them.
struct Asked {
  std::vector<Float3> points;
  std::vector<std::uint32_t> leaves;
  RayBuffer rays;
};

float dot(const Float3& a, const Float3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Float3 minus(const Float3& a, const Float3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// What shadow rays to a light start from, where `rays` meet surfaces that face it; and the mirror
/// rays that go on from all of them.
Asked facing(const World& world, const RayBuffer& rays, const Float3& light, RayBuffer& mirrored) {
  Asked asked;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Ray ray{{rays.ox[i], rays.oy[i], rays.oz[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}};
    const Hit hit = closest(world, ray);
    if (!hit)
      continue;
    const SurfacePoint s = surface(world, ray, hit);
    const bool inside = dot(s.normal, ray.dir) > 0;
    const float side = inside ? -1.f : 1.f, twice = 2 * dot(s.normal, ray.dir);
    const Float3 on = minus(ray.dir, {twice * s.normal.x, twice * s.normal.y, twice * s.normal.z});
    const Float3 from = s.leave(on);
    mirrored.add(
        {from.x, from.y, from.z}, {on.x, on.y, on.z}, std::numeric_limits<float>::infinity());
    const Float3 to = minus(light, s.point);
    if (side * dot(s.normal, to) <= 0)
      continue;
    const Float3 start = s.leave(to), dir = minus(light, start);
    const float length = std::sqrt(dot(dir, dir));
    const bool flat = primitive_of(world, hit.id).kind == PrimitiveKind::kTriangle;
    asked.points.push_back(start);
    asked.leaves.push_back(flat || !inside ? hit.id : kNoPrimitive);
    asked.rays.add(
        {start.x, start.y, start.z}, {dir.x / length, dir.y / length, dir.z / length}, length);
  }
  return asked;
}

/// ns a ray, the least of all rounds.
double least(const std::function<void()>& work, int rounds, std::size_t rays) {
  double best = 1e300;
  for (int i = 0; i < rounds; ++i) {
    const double begin = cpu_ns();
    work();
    best = std::min(best, cpu_ns() - begin);
  }
  return best / static_cast<double>(std::max<std::size_t>(rays, 1));
}

struct Timed {
  double world, grid, embree;
};

/// False: an answer is wrong.
bool time_rays(const World& world,
               const PointGrid& grid,
               EmbreeScene* embree,
               const Asked& asked,
               int rounds,
               Timed& timed) {
  const std::size_t n = asked.points.size();
  Points points = Points::of(asked.points);
  points.leaves = asked.leaves.data();
  std::vector<Ray> rays;
  for (const Float3& p : asked.points)
    rays.push_back({p, minus(grid.point(), p), 0, 1});
  std::vector<std::uint8_t> wanted(n), found(n);
  const QueryOptions options{.packet = 64};
  timed.world = least([&] { occluded(world, rays, wanted, options); }, rounds, n);
  timed.grid = least([&] { occluded(grid, points, found.data()); }, rounds, n);
  if (found != wanted)
    return false;
  timed.embree = 1e300;
  for (const EmbreeMode& mode : embree ? embree_modes() : std::vector<EmbreeMode>{}) {
    timed.embree =
        std::min(timed.embree, least([&] { embree->trace(asked.rays, true, mode); }, rounds, n));
    std::size_t other = 0;
    const Answers answers = embree->answers();
    for (std::size_t i = 0; i < n; ++i)
      other += answers.met(i) != (wanted[i] != 0);
    if (static_cast<double>(other) > kDisagree * static_cast<double>(n))
      std::printf("  (Embree %s: %zu answers differ)\n", mode.name, other);
  }
  return true;
}

SceneFile scene_named(std::string name) {
  const auto space = name.find(' ');
  if (space != std::string::npos)
    return make_scene(name.substr(0, space), std::atoi(name.c_str() + space));
  if (!std::filesystem::exists(name))
    name = GRELHA_SHARED_SCENES "/" + name;
  return read_scene(name, [](const std::string&) {});
}

bool row(const std::string& name, const Options& o) {
  const SceneFile file = scene_named(name);
  const Float3 light = file.scene.lights.empty() ? file.camera.eye : file.scene.lights[0].position;
  const World world(file.scene, {});
  const double scene_ms = 1e-6 * least([&] { World(file.scene, {.threads = 1}); }, o.rounds, 1);
  const double point_ms = 1e-6 * least([&] { PointGrid(world, light, 1); }, o.rounds, 1);
  const PointGrid grid(world, light);
  const auto embree = make_embree_scene(file.scene, true);
  Camera camera = file.camera;
  camera.width = camera.height = o.size;
  RayBuffer mirrored, unused;
  const Asked seen = facing(world, camera_rays(camera), light, mirrored);
  const Asked shown = facing(world, mirrored, light, unused);
  Timed a{}, b{};
  if (!time_rays(world, grid, embree.get(), seen, o.rounds, a) ||
      !time_rays(world, grid, embree.get(), shown, o.rounds, b)) {
    std::printf("%s: wrong answers\n", name.c_str());
    return false;
  }
  const double primitives =
      static_cast<double>(file.scene.geometry.triangles.size() +
                          file.scene.geometry.spheres.size() + file.scene.geometry.cones.size());
  std::printf(
      "| %s | %.0f | %.1f | %.1f | %.1f | %.2f | %.1f | %.1f | %.2f | %.1f | %.1f | %.1f |\n",
      name.c_str(),
      static_cast<double>(grid.bytes()) / primitives,
      a.world,
      a.grid,
      a.embree,
      a.grid / a.embree,
      b.world,
      b.grid,
      b.grid / b.embree,
      scene_ms,
      point_ms,
      1e6 * point_ms / (a.world - a.grid) / primitives);
  return true;
}

Options read_options(int count, char** words) {
  Options o;
  for (int i = 1; i + 1 < count; i += 2) {
    const std::string word = words[i];
    if (word == "--scene")
      o.scenes.push_back(words[i + 1]);
    else if (word == "--size")
      o.size = std::atoi(words[i + 1]);
    else if (word == "--rounds")
      o.rounds = std::atoi(words[i + 1]);
  }
  if (o.scenes.empty())
    o.scenes.assign(std::begin(kScenes), std::end(kScenes));
  return o;
}

}  // namespace

int main(int count, char** words) {
  const Options o = read_options(count, words);
  std::printf(
      "ns a ray; ms of one thread; rays a primitive from which building pays\n\n"
      "| scene | bytes a primitive | World | point grid | Embree | over Embree | mirrored: World | "
      "point grid | over Embree | World built | point grid built | pays from |\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  bool right = true;
  for (const std::string& scene : o.scenes)
    right &= row(scene, o);
  return right ? 0 : 1;
}
