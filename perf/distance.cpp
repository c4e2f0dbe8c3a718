// Closest points of meshes, beside Embree's point query and CGAL's AABB tree, and insides, beside
// CGAL's Side_of_triangle_mesh and VTK's vtkSelectEnclosedPoints and vtkImplicitPolyDataDistance.
// One thread; the methods take turns, and answers are compared.
//
// distance [--scene NAME]... [--points N] [--rounds N]
//
// A scene is a file, `GENERATOR SIZE`, or `ball N`: about N triangles on a sphere. Only its
// triangles are used. Prints a table of Markdown: microseconds a point, the least of the rounds.
// Points lie in the surface, at multiples of the mesh's size from it, near its middle, or in a
// lattice around it; each set in order (neighbours follow each other) and shuffled. `array`:
// closest_points(); `call`: closest_point() for each.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "grelha/distance.hpp"
#include "perf/distance/others.hpp"
#include "perf/embree.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr std::size_t kManyTriangles = 1'000'000;  ///< then an eighth of the points
constexpr double kFewerInMiddle = 64;              ///< times fewer points there: each takes long
constexpr double kAllowed = 1e-5;  ///< difference of distances, of these and of coordinates
constexpr const char* kNames[] = {"array", "call", "Embree", "CGAL"};

struct Options {
  std::size_t points = 10000;
  int rounds = 5;
  std::vector<std::string> scenes;
};

struct Bounds {
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};

  explicit Bounds(const Triangles& t) {
    const std::vector<float>* const all[] = {&t.x, &t.y, &t.z};
    for (int a = 0; a < 3; ++a)
      for (const float v : *all[a]) {
        lo[a] = std::min(lo[a], double{v});
        hi[a] = std::max(hi[a], double{v});
      }
  }
  double size() const { return std::max({hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]}); }
  Float3 at(double x, double y, double z) const {
    const double share[3] = {x, y, z};
    float p[3];
    for (int a = 0; a < 3; ++a)
      p[a] = static_cast<float>(lo[a] + share[a] * (hi[a] - lo[a]));
    return {p[0], p[1], p[2]};
  }
};

Float3 moved(const Float3& p, double by, const Float3& way) {
  return {static_cast<float>(p.x + by * way.x),
          static_cast<float>(p.y + by * way.y),
          static_cast<float>(p.z + by * way.z)};
}

/// Points on triangles that follow each other, moved by a distance in any direction.
std::vector<Float3> beside_surface(const Triangles& t, double by, std::size_t count) {
  test::Random random(3);
  std::vector<Float3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t one = i * t.size() / count;
    double u = random.in(0, 1), v = random.in(0, 1);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto mean = [&](const std::vector<float>& x) {
      return static_cast<float>((1 - u - v) * x[t.a[one]] + u * x[t.b[one]] + v * x[t.c[one]]);
    };
    points[i] = moved({mean(t.x), mean(t.y), mean(t.z)}, by, random.direction());
  }
  return points;
}

/// Points around the middle, along a spiral from pole to pole.
std::vector<Float3> around(const Bounds& box, double by, std::size_t count) {
  std::vector<Float3> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double turn = std::sqrt(std::numbers::pi * static_cast<double>(count)) * std::asin(z);
    const double flat = std::sqrt(1 - z * z);
    const Float3 way{static_cast<float>(flat * std::cos(turn)),
                     static_cast<float>(flat * std::sin(turn)),
                     static_cast<float>(z)};
    points[i] = moved(box.at(.5, .5, .5), by, way);
  }
  return points;
}

/// A lattice around the box, twice as wide.
std::vector<Float3> lattice(const Bounds& box, std::size_t count) {
  const auto side = static_cast<std::size_t>(std::cbrt(static_cast<double>(count)));
  std::vector<Float3> points;
  const auto share = [&](std::size_t i) {
    return 2 * (static_cast<double>(i) + .5) / static_cast<double>(side) - .5;
  };
  for (std::size_t z = 0; z < side; ++z)
    for (std::size_t y = 0; y < side; ++y)
      for (std::size_t x = 0; x < side; ++x)
        points.push_back(box.at(share(x), share(y), share(z)));
  return points;
}

struct PointSet {
  std::string name;
  std::vector<Float3> points;
};

std::vector<PointSet> point_sets(const Triangles& t, std::size_t count) {
  const Bounds box(t);
  const double size = box.size();
  const auto few = static_cast<std::size_t>(static_cast<double>(count) / kFewerInMiddle) + 1;
  return {{"in the surface", beside_surface(t, 0, count)},
          {".01 sizes", beside_surface(t, .01 * size, count)},
          {"1 size", around(box, size, count)},
          {"10 sizes", around(box, 10 * size, count)},
          {"1e4 sizes", around(box, 1e4 * size, count)},
          {"the middle", around(box, 1e-6 * size, few)},
          {"a lattice", lattice(box, count)}};
}

/// A way to find closest points, and what it took and found.
struct Method {
  std::function<void(std::span<const Float3>, std::span<ClosestPoint>)> closest;
  double us = 1e300;
  std::vector<ClosestPoint> found{};
};

/// Grelha's array and call, then others'.
std::vector<std::unique_ptr<Method>> methods_of(const World& world,
                                                const OtherTree* embree,
                                                const OtherTree* cgal) {
  std::vector<std::unique_ptr<Method>> methods(4);
  methods[0].reset(new Method{[&](auto points, auto found) {
    closest_points(world, points, found.first(points.size()), INFINITY, {.threads = 1});
  }});
  methods[1].reset(new Method{[&](auto points, auto found) {
    for (std::size_t i = 0; i < points.size(); ++i)
      found[i] = closest_point(world, points[i]);
  }});
  const OtherTree* const others[] = {embree, cgal};
  for (std::size_t k = 0; k < 2; ++k)
    if (const OtherTree* const other = others[k])
      methods[2 + k].reset(
          new Method{[other](auto points, auto found) { other->closest(points, found); }});
  return methods;
}

/// Grelha's two ways agree to the bit, others about.
bool is_same(const PointSet& set,
             const std::vector<ClosestPoint>& truth,
             const Method& m,
             bool own) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Float3 p = set.points[i];
    const double scale = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), truth[i].distance});
    const double off = std::abs(double{truth[i].distance} - m.found[i].distance);
    const bool same_bits = m.found[i].id == truth[i].id && m.found[i].point == truth[i].point;
    if (own ? !same_bits || off != 0 : !(off <= kAllowed * scale)) {
      std::printf("%s: point %zu: %.9g and %.9g\n",
                  set.name.c_str(),
                  i,
                  double{truth[i].distance},
                  double{m.found[i].distance});
      return false;
    }
  }
  return true;
}

/// Prints a row; false: some answer is wrong.
bool row(const std::string& scene,
         const PointSet& set,
         std::vector<std::unique_ptr<Method>> methods,
         int rounds) {
  const std::span warm_up = std::span(set.points).first((set.points.size() + 3) / 4);
  for (int round = 0; round < rounds; ++round)
    for (const auto& m : methods)
      if (m) {
        m->found.resize(set.points.size());
        m->closest(warm_up, m->found);  // what the others left in the caches is not measured
        const double from = cpu_ns();
        m->closest(set.points, m->found);
        m->us = std::min(m->us, (cpu_ns() - from) / 1e3 / static_cast<double>(set.points.size()));
      }
  std::printf("| %s | %s |", scene.c_str(), set.name.c_str());
  for (const auto& m : methods)
    m ? std::printf(" %.2f |", m->us) : std::printf(" - |");
  for (std::size_t k = 2; k < 4; ++k)
    methods[k] ? std::printf(" %.2f |", methods[0]->us / methods[k]->us) : std::printf(" - |");
  std::printf("\n");
  std::fflush(stdout);
  bool right = true;
  for (std::size_t k = 1; k < 4; ++k)
    right &= !methods[k] || is_same(set, methods[0]->found, *methods[k], k == 1);
  return right;
}

Scene scene_of(const std::string& name) {
  Scene scene;
  if (name.starts_with("ball ")) {
    const int half = std::max(3, static_cast<int>(std::sqrt(std::atof(name.c_str() + 5) / 4)));
    return test::ball_mesh(2 * half, half);
  }
  scene = scene_named(name).scene;
  scene.geometry.spheres = {};
  scene.geometry.cones = {};
  scene.geometry.planes = {};
  return scene;
}

bool table(const std::string& name, const Options& o) {
  const Scene scene = scene_of(name);
  const Triangles& t = scene.geometry.triangles;
  const World world(scene, {});
  const auto embree = make_embree_tree(t);
  const auto cgal = make_cgal_tree(t);
  const std::string shown = std::filesystem::path(name).stem();
  bool right = true;
  const std::size_t fewer = t.size() > kManyTriangles ? 8 : 1;
  for (PointSet& set : point_sets(t, std::max<std::size_t>(1, o.points / fewer))) {
    right &= row(shown, set, methods_of(world, embree.get(), cgal.get()), o.rounds);
    std::shuffle(set.points.begin(), set.points.end(), std::mt19937(1));
    set.name += ", shuffled";
    right &= row(shown, set, methods_of(world, embree.get(), cgal.get()), o.rounds);
  }
  return right;
}

/// Insides of points beside the surface and in a lattice, of meshes that VTK can finish.
bool insides(const std::string& name, const Options& o) {
  constexpr std::size_t kMostTriangles = 300'000;
  const Scene scene = scene_of(name);
  const Triangles& t = scene.geometry.triangles;
  if (t.size() > kMostTriangles)
    return true;
  const std::string shown = std::filesystem::path(name).stem();
  const std::size_t count = std::max<std::size_t>(1, o.points / 4);
  bool right = true;
  for (const double by : {.01, .1})
    right &= print_insides(shown,
                           scene,
                           by == .01 ? ".01 sizes" : ".1 sizes",
                           beside_surface(t, by * Bounds(t).size(), count),
                           o.rounds);
  return print_insides(shown, scene, "a lattice", lattice(Bounds(t), count), o.rounds) && right;
}

bool set_option(const std::string& word, const char* value, Options& o) {
  const double number = std::atof(value);
  if (word == "--scene")
    o.scenes.emplace_back(value);
  else if (word == "--points" && number >= 1 && number <= 1e8)
    o.points = static_cast<std::size_t>(number);
  else if (word == "--rounds" && number >= 1 && number <= 4096)
    o.rounds = static_cast<int>(number);
  else
    return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  if (!set_options(argc, argv, [&](const std::string& word, const char* value) {
        return set_option(word, value, o);
      })) {
    std::fprintf(stderr, "distance [--scene NAME]... [--points N] [--rounds N]\n");
    return 2;
  }
  if (o.scenes.empty()) {
    o.scenes = {"mount 7", "ball 40000", "ball 2500000"};
    for (const char* scan : {"bunny", "dragon"}) {
      const std::string file = GRELHA_SHARED_SCENES "/ply/" + std::string(scan) + ".ply";
      if (std::filesystem::exists(file))
        o.scenes.push_back(file);
      else
        std::fprintf(stderr, "skipped: there is no %s\n", file.c_str());
    }
  }
  const Triangles none;
  if (embree_name().empty())
    std::fprintf(stderr, "skipped: Embree is not here\n");
#ifndef GRELHA_VTK
  std::fprintf(stderr, "skipped: VTK is not here (Debian: libvtk9-dev)\n");
#endif
#ifndef GRELHA_CGAL
  std::fprintf(stderr, "skipped: CGAL is not here (Debian: libcgal-dev)\n");
#endif
  std::printf("| scene | points |");
  for (const char* name : kNames)
    std::printf(" %s |", name);
  std::printf(" over Embree | over CGAL |\n|---|---|--:|--:|--:|--:|--:|--:|\n");
  bool right = true;
  for (const std::string& scene : o.scenes)
    right &= table(scene, o);
  std::printf(
      "\n| scene | points | closed | winding | number to .01 | to .001 | signed distance | CGAL "
      "inside | VTK inside | VTK distance | VTK others |\n"
      "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const std::string& scene : o.scenes)
    right &= insides(scene, o);
  return right ? 0 : 1;
}
