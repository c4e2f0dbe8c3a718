// Measures the cost of rays that start far from a small mesh in a vast scene, and compares it with
// Embree (robust, its fastest mode). One thread and one process; the methods take turns.
//
// afar [--rays N] [--rounds N] [--floor SIZES] [--scene NAME]...
//
// A scene is a file or `GENERATOR SIZE`; only its triangles are used. The mesh stands on a floor
// SIZES times as wide as the mesh. Rays start a given number of mesh sizes away above the floor and
// go to points in the bounding box of the mesh: `eye`, 64 consecutive rays from one origin;
// `scattered`, each ray from its own origin. Each call traces one ray.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "perf/embree.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr double kDisagree = .005;

struct Options {
  int rays = 1 << 15, rounds = 9;
  double floor = 4e4;
  std::vector<std::string> scenes;
};

struct Bounds {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  double middle(int a) const { return .5 * (lo[a] + hi[a]); }
  double size() const { return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}); }
};

Bounds bounds_of(const Triangles& t) {
  Bounds b;
  const std::vector<float>* const all[] = {&t.x, &t.y, &t.z};
  for (int a = 0; a < 3; ++a)
    for (const float v : *all[a]) {
      b.lo[a] = std::min(b.lo[a], double(v));
      b.hi[a] = std::max(b.hi[a], double(v));
    }
  return b;
}

/// A mesh, y upwards, on a floor of two triangles.
Scene on_a_floor(const std::string& name, double sizes, Bounds& mesh) {
  Scene scene = scene_named(name).scene;
  scene.geometry.spheres = {};
  scene.geometry.cones = {};
  scene.geometry.planes = {};
  Triangles& t = scene.geometry.triangles;
  mesh = bounds_of(t);
  if (scene.geometry.objects.empty())
    scene.geometry.objects.push_back({0, std::uint32_t(t.size())});
  const auto first = std::uint32_t(t.x.size());
  for (const int corner : {0, 1, 3, 2}) {
    const double side = .5 * sizes * mesh.size();
    t.x.push_back(float(mesh.middle(0) + (corner & 1 ? side : -side)));
    t.y.push_back(float(mesh.lo[1]));
    t.z.push_back(float(mesh.middle(2) + (corner & 2 ? side : -side)));
  }
  if (!t.nx.empty())
    for (std::vector<float>* n : {&t.nx, &t.ny, &t.nz})
      n->resize(t.x.size());
  for (const std::uint32_t second : {1u, 2u}) {
    t.a.push_back(first);
    t.b.push_back(first + second);
    t.c.push_back(first + second + 1);
    t.material.push_back(0);
  }
  return scene;
}

/// `rays` rays from origins `sizes` mesh sizes away; each run of `share` rays has one origin.
RayBuffer rays_from(const Bounds& mesh, double sizes, int rays, int share) {
  std::mt19937 random(7);
  const auto unit = [&] { return double(random() >> 8) * 0x1p-24; };
  RayBuffer all;
  double eye[3] = {}, aim[3] = {};
  for (int i = 0; i < rays; ++i) {
    if (i % share == 0) {
      const double up = .02 + .9 * unit(), turn = 6.28 * unit(), flat = std::sqrt(1 - up * up);
      const double way[3] = {flat * std::cos(turn), up, flat * std::sin(turn)};
      for (int a = 0; a < 3; ++a) {
        eye[a] = mesh.middle(a) + sizes * mesh.size() * way[a];
        aim[a] = mesh.lo[a] + unit() * (mesh.hi[a] - mesh.lo[a]);
      }
    }
    double d[3], dd = 0;
    for (int a = 0; a < 3; ++a) {
      // the rays of one origin are as dense as 64 x 64 rays across the mesh
      const double beside = share > 1 ? (unit() - .5) / 8 * mesh.size() : 0;
      d[a] = aim[a] + beside - eye[a];
      dd += d[a] * d[a];
    }
    for (double& c : d)
      c /= std::sqrt(dd);
    all.add({float(eye[0]), float(eye[1]), float(eye[2])},
            {float(d[0]), float(d[1]), float(d[2])},
            INFINITY);
  }
  return all;
}

struct Way {
  std::function<void()> trace;
  std::vector<double> ns{};
};

double best_of(const std::vector<Way>& ways, std::size_t from, std::size_t end) {
  double least = INFINITY;
  for (std::size_t i = from; i < end; ++i)
    least = std::min(least, median(ways[i].ns));
  return least;
}

/// False: some answer is wrong.
bool row(const std::string& name,
         const World& world,
         EmbreeScene* embree,
         const RayBuffer& rays,
         int rounds) {
  Answers truth, found;
  ask_in_streams(world, rays, false, rays.size(), {.packet = 256}, truth);
  call_each(world, rays, false, found);
  if (!(truth == found)) {
    std::printf("%s: calls and streams differ\n", name.c_str());
    return false;
  }
  std::vector<Way> ways{
      {[&] { ask_in_streams(world, rays, false, rays.size(), {.packet = 256}, found); }},
      {[&] { call_each(world, rays, false, found); }}};
  for (const EmbreeMode& mode : embree_modes())
    ways.push_back({[&, mode] { embree->trace(rays, false, mode); }});
  for (int round = 0; round < rounds; ++round)
    for (Way& way : ways) {
      const double from = cpu_ns();
      way.trace();
      way.ns.push_back((cpu_ns() - from) / double(rays.size()));
    }
  const double ours = median(ways[0].ns), one = median(ways[1].ns);
  std::printf("| %s | %.0f | %.0f |", name.c_str(), ours, one);
  if (embree) {
    const Answers theirs = embree->answers();
    std::size_t other = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      other += truth.met(i) != theirs.met(i);
    const double best = best_of(ways, 2, ways.size());
    std::printf(" %.0f | %.2f | %.2f |%s",
                best,
                ours / best,
                one / median(ways[2].ns),
                double(other) > kDisagree * double(rays.size()) ? " Embree meets others" : "");
  }
  std::printf("\n");
  std::fflush(stdout);
  return true;
}

bool table(const std::string& name, const Options& o) {
  Bounds mesh;
  const Scene scene = on_a_floor(name, o.floor, mesh);
  const World world(scene, {});
  const auto embree = make_embree_scene(scene, true);
  const auto slash = name.rfind('/');
  const std::string shown = slash == std::string::npos ? name : name.substr(slash + 1);
  bool right = true;
  for (const int share : {64, 1})
    for (const double sizes : {2., 10., 100., 1e3, 1e4}) {
      char text[200];
      std::snprintf(text,
                    sizeof text,
                    "%s, %s, %g sizes",
                    shown.c_str(),
                    share > 1 ? "eye" : "scattered",
                    sizes);
      right &= row(text, world, embree.get(), rays_from(mesh, sizes, o.rays, share), o.rounds);
    }
  return right;
}

bool set_option(const std::string& word, const std::string& value, Options& o) {
  const double number = std::atof(value.c_str());
  if (word == "--scene")
    o.scenes.push_back(value);
  else if (word == "--rays" && number >= 1 && number <= 1e7)
    o.rays = int(number);
  else if (word == "--rounds" && number >= 1 && number <= 4096)
    o.rounds = int(number);
  else if (word == "--floor" && number >= 1 && number <= 1e6)
    o.floor = number;
  else
    return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const auto set = [&](const char* word, const char* value) {
    return set_option(word, value, options);
  };
  if (!set_options(argc, argv, set)) {
    std::fprintf(stderr, "usage: afar [--rays N] [--rounds N] [--floor SIZES] [--scene NAME]...\n");
    return 2;
  }
  const std::string embree = embree_name();
  const bool beside = !embree.empty();
  if (beside)
    std::printf("beside %s\n", embree.c_str());
  std::printf("ns a ray, median of %d rounds\n\n| | stream | call |%s\n|---|--:|--:|%s\n",
              options.rounds,
              beside ? " Embree's best | stream over it | call over rtcIntersect1 |" : "",
              beside ? "--:|--:|--:|" : "");
  if (options.scenes.empty())
    options.scenes = {"knot 15"};
  bool right = true;
  for (const std::string& scene : options.scenes)
    right &= table(scene, options);
  return right ? 0 : 1;
}
