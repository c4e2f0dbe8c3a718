// All hits and crossings of rays, listed and counted, beside closest hits and Embree with a filter
// that counts or collects each hit and rejects it. One thread; the methods take turns, and answers
// are compared.
//
// lists [--scene NAME]... [--size N] [--rounds N]
//
// A scene is a file, `GENERATOR SIZE`, `shells N` (balls within each other), `torus N` (about N
// triangles), `spheres N`, or `N of FILE`: copies of a mesh in a row. Rays go through the N x N
// pixels of a camera that looks along the row, in the order of a render; points of contains() lie
// where they pass the middle.
//
// Prints a table of Markdown: nanoseconds a ray, the least of the rounds. `closest`: a stream of
// all rays. Embree (robust): rtcIntersect1; lists are sorted by (t, id).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/inside.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#if GRELHA_EMBREE
#include "perf/embree_api.hpp"
#endif

namespace {

using namespace grelha;
using namespace grelha::perf;

/// Share of rays of which Embree may count other hits: at edges and silhouettes, by rounding.
constexpr double kDiffer = .02;
constexpr double kAllowed = 1e-4;  ///< relative difference of t

enum Method {
  kClosest,
  kCountHits,
  kAllHits,
  kCountCrossings,
  kCrossings,
  kContains,
  kEmbreeCount,
  kEmbreeList,
  kMethods
};
constexpr const char* kNames[kMethods] = {"closest",
                                          "count_hits",
                                          "all_hits",
                                          "count_crossings",
                                          "crossings",
                                          "contains",
                                          "Embree count",
                                          "Embree list"};

struct Options {
  int size = 128, rounds = 5;
  std::vector<std::string> scenes;
};

// ---- scenes ----

void add_copy(Scene& to, const Scene& mesh, float scale, float z) {
  const Triangles& from = mesh.geometry.triangles;
  Triangles& t = to.geometry.triangles;
  const auto vertices = static_cast<std::uint32_t>(t.x.size());
  to.geometry.objects.push_back({static_cast<std::uint32_t>(t.size()),  //
                                 static_cast<std::uint32_t>(from.size())});
  for (std::size_t i = 0; i < from.x.size(); ++i) {
    t.x.push_back(scale * from.x[i]);
    t.y.push_back(scale * from.y[i]);
    t.z.push_back(scale * from.z[i] + z);
  }
  for (std::size_t i = 0; i < from.size(); ++i) {
    t.a.push_back(vertices + from.a[i]);
    t.b.push_back(vertices + from.b[i]);
    t.c.push_back(vertices + from.c[i]);
    t.material.push_back(0);
  }
}

Scene spheres(int count) {
  constexpr double kHits = 10;  // a ray, of a square of 2 x 2
  const double radius = std::sqrt(2 * kHits / (std::numbers::pi * count));
  Scene s = test::empty_scene();
  test::Random random(1);
  for (int i = 0; i < count; ++i)
    s.geometry.spheres.add(random.point(1), static_cast<float>(radius), 0);
  return s;
}

struct Box {
  float lo[3] = {1e30f, 1e30f, 1e30f}, hi[3] = {-1e30f, -1e30f, -1e30f};

  explicit Box(const Geometry& g) {
    const std::vector<float>* const all[][2] = {{&g.triangles.x, &g.spheres.x},
                                                {&g.triangles.y, &g.spheres.y},
                                                {&g.triangles.z, &g.spheres.z}};
    for (int a = 0; a < 3; ++a)
      for (const auto* const some : all[a])
        for (const float v : *some) {
          lo[a] = std::min(lo[a], v);
          hi[a] = std::max(hi[a], v);
        }
  }
  float middle(int axis) const { return (lo[axis] + hi[axis]) / 2; }
  float length(int axis) const { return hi[axis] - lo[axis]; }
};

Scene meshes_of(const std::string& name) {
  Scene s = scene_named(name).scene;
  s.geometry.spheres = {};
  s.geometry.cones = {};
  s.geometry.planes = {};
  s.geometry.triangles.nx.clear();
  s.geometry.triangles.ny.clear();
  s.geometry.triangles.nz.clear();
  return s;
}

Scene scene_of(const std::string& name) {
  const int number = std::atoi(name.substr(name.find(' ') + 1).c_str());
  if (name.starts_with("spheres "))
    return spheres(number);
  if (name.starts_with("torus ")) {
    const int around = static_cast<int>(std::sqrt(number));
    return test::torus_mesh(around, around / 2, .4);
  }
  Scene s = test::empty_scene();
  if (name.starts_with("shells ")) {
    const Scene ball = test::ball_mesh(64, 32);
    for (int i = 0; i < number; ++i)
      add_copy(s, ball, 1 - .5f * static_cast<float>(i) / static_cast<float>(number), 0);
    return s;
  }
  const auto of = name.find(" of ");
  if (of == std::string::npos)
    return meshes_of(name);
  const Scene mesh = meshes_of(name.substr(of + 4));
  const float step = 1.01f * Box(mesh.geometry).length(2);
  for (int i = 0; i < std::atoi(name.c_str()); ++i)
    add_copy(s, mesh, 1, step * static_cast<float>(i));
  return s;
}

std::string shown(const std::string& name) {
  const auto of = name.find(" of ");
  const std::string copies = of == std::string::npos ? "" : name.substr(0, of + 4);
  return copies + std::filesystem::path(name.substr(copies.size())).stem().string();
}

/// A camera before the box whose picture is as large as its middle, a little beside its axis.
Camera camera_at(const Box& box, int size) {
  const double width = std::max(box.length(0), box.length(1));
  const double away = 3 * std::max<double>(width, box.length(2));
  Camera c;
  c.at = {box.middle(0), box.middle(1), box.middle(2)};
  c.eye = {c.at.x + static_cast<float>(.1 * width),
           c.at.y + static_cast<float>(.07 * width),
           c.at.z + static_cast<float>(away)};
  c.up = {0, 1, 0};
  c.angle_deg = 360 / std::numbers::pi * std::atan(.5 * width / away);
  c.width = c.height = size;
  return c;
}

// ---- Embree ----

/// Hits that the filter of its scene saw.
struct Seen {
  bool listed = false;
  std::size_t count = 0;
  std::vector<Hit> hits;
};

#if GRELHA_EMBREE
void reject(const RTCFilterFunctionNArguments* args) {
  Seen& seen = *static_cast<Seen*>(args->geometryUserPtr);
  args->valid[0] = 0;
  ++seen.count;
  if (!seen.listed)
    return;
  // a scene has spheres or triangles, so these are Grelha's ids
  seen.hits.push_back({RTCRayN_tfar(args->ray, args->N, 0), RTCHitN_primID(args->hit, args->N, 0)});
}

class Embree {
 public:
  explicit Embree(const Geometry& g)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const bool round = g.spheres.size() != 0;
    RTCGeometry made = rtcNewGeometry(
        device_, round ? RTC_GEOMETRY_TYPE_SPHERE_POINT : RTC_GEOMETRY_TYPE_TRIANGLE);
    round ? put(made, g.spheres) : put(made, g.triangles);
    rtcSetGeometryUserData(made, &seen_);
    rtcSetGeometryIntersectFilterFunction(made, reject);
    rtcCommitGeometry(made);
    rtcAttachGeometry(scene_, made);
    rtcReleaseGeometry(made);
    rtcCommitScene(scene_);
  }
  ~Embree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void count(const RayBuffer& rays, std::vector<std::uint32_t>& counts) {
    seen_.listed = false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      seen_.count = 0;
      shoot(rays, i);
      counts[i] = static_cast<std::uint32_t>(seen_.count);
    }
  }
  void list(const RayBuffer& rays, HitLists& lists) {
    seen_.listed = true;
    seen_.hits.clear();
    lists.offset.assign(1, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      shoot(rays, i);
      std::sort(
          seen_.hits.begin() + static_cast<std::ptrdiff_t>(lists.offset.back()),
          seen_.hits.end(),
          [](const Hit& a, const Hit& b) { return a.t < b.t || (a.t == b.t && a.id < b.id); });
      lists.offset.push_back(seen_.hits.size());
    }
    lists.hits.swap(seen_.hits);
  }

 private:
  static void put(RTCGeometry g, const Spheres& s) {
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), s.size()));
    for (std::size_t i = 0; i < s.size(); ++i)
      for (const float x : {s.x[i], s.y[i], s.z[i], s.radius[i]})
        *v++ = x;
  }
  static void put(RTCGeometry g, const Triangles& t) {
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), t.x.size()));
    auto* c = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), t.size()));
    for (std::size_t i = 0; i < t.x.size(); ++i)
      for (const float x : {t.x[i], t.y[i], t.z[i]})
        *v++ = x;
    for (std::size_t i = 0; i < t.size(); ++i)
      for (const std::uint32_t corner : {t.a[i], t.b[i], t.c[i]})
        *c++ = corner;
  }
  void shoot(const RayBuffer& r, std::size_t i) {
    RTCRayHit hit{};
    hit.ray = {
        r.ox[i], r.oy[i], r.oz[i], r.t_min[i], r.dx[i], r.dy[i], r.dz[i], 0, r.t_max[i], ~0u, 0, 0};
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(scene_, hint_, hit);
  }

  RTCDevice device_;
  RTCScene scene_;
  EmbreeHint hint_{true};
  Seen seen_;
};
#else
struct Embree {
  explicit Embree(const Geometry&) {}
  void count(const RayBuffer&, std::vector<std::uint32_t>&) {}
  void list(const RayBuffer&, HitLists&) {}
};
#endif

// ---- the table ----

struct Found {
  Answers closest;
  std::vector<std::uint32_t> hits, crossings, embree;
  HitLists lists, embree_lists;
  CrossingLists crossing_lists;
  std::vector<std::uint8_t> inside;

  explicit Found(std::size_t n) : hits(n), crossings(n), embree(n), inside(n) {}
};

/// Counts are those of the lists, and the first hit is the closest.
bool agree(const Found& f) {
  for (std::size_t i = 0; i < f.hits.size(); ++i) {
    const auto list = f.lists.of(i);
    const bool met = f.closest.met(i);
    if (list.size() != f.hits[i] || f.crossing_lists.of(i).size() != f.crossings[i] ||
        met == list.empty() ||
        (met && (list[0].t != f.closest.t[i] || list[0].id != f.closest.id[i]))) {
      std::printf("ray %zu: its lists and counts differ\n", i);
      return false;
    }
  }
  return true;
}

/// Embree's lists are about the same.
bool agrees_with_embree(const Found& f) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < f.hits.size(); ++i) {
    const auto own = f.lists.of(i), other = f.embree_lists.of(i);
    const bool near = std::equal(
        own.begin(), own.end(), other.begin(), other.end(), [](const Hit& a, const Hit& b) {
          return std::abs(a.t - b.t) <= kAllowed * std::abs(a.t);
        });
    differing += !near || f.embree[i] != other.size();
  }
  if (static_cast<double>(differing) <= kDiffer * static_cast<double>(f.hits.size()))
    return true;
  std::printf("Embree finds other hits for %zu rays of %zu\n", differing, f.hits.size());
  return false;
}

void print_row(const std::string& name, std::size_t primitives, const Found& f, const double* ns) {
  const double rays = static_cast<double>(f.hits.size());
  std::printf("| %s | %zu | %.1f |",
              shown(name).c_str(),
              primitives,
              static_cast<double>(f.lists.hits.size()) / rays);
  for (int k = 0; k < kMethods; ++k)
    ns[k] < 1e300 ? std::printf(" %.0f |", ns[k] / rays) : std::printf(" - |");
  std::printf(" %.1f |", ns[kCountHits] / ns[kClosest]);
  for (const auto& [own, other] : {std::pair{kCountHits, kEmbreeCount}, {kAllHits, kEmbreeList}})
    ns[other] < 1e300 ? std::printf(" %.2f |", ns[own] / ns[other]) : std::printf(" - |");
  std::printf("\n");
  std::fflush(stdout);
}

/// Prints a row; false: some answer is wrong.
bool row(const std::string& name, const Options& o) {
  const Scene scene = scene_of(name);
  const Box box(scene.geometry);
  const World world(scene, {});
  const RayBuffer rays = camera_rays(camera_at(box, o.size));
  std::vector<Float3> points;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float t = (box.middle(2) - rays.oz[i]) / rays.dz[i];
    points.push_back({rays.ox[i] + t * rays.dx[i], rays.oy[i] + t * rays.dy[i], box.middle(2)});
  }
  Embree embree(scene.geometry);
  Found f(rays.size());
  std::function<void()> ways[kMethods];
  ways[kClosest] = [&] { ask_in_streams(world, rays, false, rays.size(), {}, f.closest); };
  ways[kCountHits] = [&] { count_hits(world, rays.view(), f.hits.data()); };
  ways[kAllHits] = [&] { f.lists = all_hits(world, rays.view()); };
  ways[kCountCrossings] = [&] { count_crossings(world, rays.view(), f.crossings.data()); };
  ways[kCrossings] = [&] { f.crossing_lists = crossings(world, rays.view()); };
  ways[kContains] = [&] { contains(world, points, f.inside, {.inside = InsideRule::kOdd}); };
#if GRELHA_EMBREE
  ways[kEmbreeCount] = [&] { embree.count(rays, f.embree); };
  ways[kEmbreeList] = [&] { embree.list(rays, f.embree_lists); };
#endif
  ways[kContains]();  // the first call checks the mesh
  std::array<double, kMethods> ns;
  ns.fill(1e300);
  for (int round = 0; round < o.rounds; ++round)
    for (int k = 0; k < kMethods; ++k)
      if (ways[k]) {
        const double from = cpu_ns();
        ways[k]();
        ns[static_cast<std::size_t>(k)] =
            std::min(ns[static_cast<std::size_t>(k)], cpu_ns() - from);
      }
  const std::size_t primitives = scene.geometry.triangles.size() + scene.geometry.spheres.size();
  const bool right = agree(f) && (!ways[kEmbreeCount] || agrees_with_embree(f));
  if (right)
    print_row(name, primitives, f, ns.data());
  return right;
}

bool set_option(const std::string& word, const char* value, Options& o) {
  const int number = std::atoi(value);
  if (word == "--scene")
    o.scenes.emplace_back(value);
  else if (word == "--size" && number >= 1 && number <= 4096)
    o.size = number;
  else if (word == "--rounds" && number >= 1 && number <= 4096)
    o.rounds = number;
  else
    return false;
  return true;
}

std::vector<std::string> usual_scenes() {
  std::vector<std::string> scenes{
      "mount 7", "torus 80000", "shells 10", "spheres 10000", "shells 32", "shells 110"};
  for (const auto& [copies, scan] : {std::pair{"", "armadillo"},
                                     {"", "bunny"},
                                     {"", "dragon"},
                                     {"8 of ", "bunny"},
                                     {"24 of ", "bunny10k"},
                                     {"84 of ", "bunny10k"}}) {
    const std::string file = GRELHA_SHARED_SCENES "/ply/" + std::string(scan) + ".ply";
    if (std::filesystem::exists(file))
      scenes.push_back(copies + file);
    else
      std::fprintf(stderr, "skipped: there is no %s\n", file.c_str());
  }
  return scenes;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  if (!set_options(argc, argv, [&](const std::string& word, const char* value) {
        return set_option(word, value, o);
      })) {
    std::fprintf(stderr, "lists [--scene NAME]... [--size N] [--rounds N]\n");
    return 2;
  }
  if (o.scenes.empty())
    o.scenes = usual_scenes();
#if !GRELHA_EMBREE
  std::fprintf(stderr, "skipped: Embree is not here\n");
#endif
  std::printf("| scene | primitives | hits a ray |");
  for (const char* name : kNames)
    std::printf(" %s |", name);
  std::printf(" count_hits / closest | count_hits / Embree | all_hits / Embree |\n|---|");
  for (int k = 0; k < kMethods + 5; ++k)
    std::printf("--:|");
  std::printf("\n");
  bool right = true;
  for (const std::string& scene : o.scenes)
    right &= row(scene, o);
  return right ? 0 : 1;
}
