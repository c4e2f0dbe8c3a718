// Measures wrong answers and time: meshes, rays at vertices, edges and faces from near and from
// afar. Rational numbers (GMP) decide each answer. Compares Grelha with Embree, fast and robust, on
// one thread; and where CMake found CGAL, with its kernel of exact
// constructions and with that of exact predicates alone.
//
// exact [--rays N] [--rounds N] [--scene NAME]...
//
// Prints CSV; perf/exact.py draws it.
//
// A scene is a file or `GENERATOR SIZE`; only its triangles are used. The default is two real
// scans. Each is tested in place, and translated by a thousand and by a million of its diagonals.
// An answer is wrong if it is a false hit, a missed hit or another triangle. At equal t the lower
// id is right; Embree specifies no order, so any of the ids is accepted.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "perf/embree.hpp"
#include "perf/exact/cgal.hpp"
#include "perf/workloads.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rational.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;
using test::at;
using test::minus;
using test::Random;

struct Options {
  int rays = 6000, rounds = 5;
  std::vector<std::string> scenes;
};

Options parse(int argc, char** argv) {
  Options o;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i];
    if (word == "--rays")
      o.rays = std::atoi(argv[i + 1]);
    else if (word == "--rounds")
      o.rounds = std::atoi(argv[i + 1]);
    else if (word == "--scene")
      o.scenes.emplace_back(argv[i + 1]);
  }
  if (o.scenes.empty())
    o.scenes = {GRELHA_SHARED_SCENES "/ply/bunny.ply", GRELHA_SHARED_SCENES "/ply/horse.ply"};
  return o;
}

/// The triangles of a scene, moved by `away` of its diagonals along an axis aslant.
Scene moved_mesh(const std::string& name, double away, double& size, Float3& middle) {
  Scene s = scene_named(name).scene;
  s.geometry.spheres = {};
  s.geometry.cones = {};
  s.geometry.planes = {};
  Triangles& t = s.geometry.triangles;
  t.nx.clear();
  t.ny.clear();
  t.nz.clear();
  float lo[3], hi[3];
  std::vector<float>* const all[] = {&t.x, &t.y, &t.z};
  size = 0;
  for (int a = 0; a < 3; ++a) {
    lo[a] = *std::min_element(all[a]->begin(), all[a]->end());
    hi[a] = *std::max_element(all[a]->begin(), all[a]->end());
    size += (double(hi[a]) - lo[a]) * (double(hi[a]) - lo[a]);
  }
  size = std::sqrt(size);
  constexpr double kWay[3] = {1, -.7, .4};
  float* const to[] = {&middle.x, &middle.y, &middle.z};
  for (int a = 0; a < 3; ++a) {
    const double by = away * size * kWay[a];
    for (float& x : *all[a])
      x = static_cast<float>(x + by);
    *to[a] = static_cast<float>(.5 * (double(lo[a]) + hi[a]) + by);
  }
  return s;
}

/// A third each at vertices, at edges and at faces, from places `away` diagonals off.
std::vector<Ray> aimed(const Scene& s, double size, const Float3& middle, double away, int count) {
  Random random(3);
  std::vector<Ray> rays;
  const Triangles& t = s.geometry.triangles;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t k = random.below(static_cast<std::uint32_t>(t.a.size()));
    const Float3 a = test::vertex(s, t.a[k]);
    const Float3 b = test::vertex(s, t.b[k]);
    const Float3 c = test::vertex(s, t.c[k]);
    const Float3 on_edge = at(a, random.unit(), minus(b, a));
    const Float3 inside = at(on_edge, .5 * random.unit(), minus(c, on_edge));
    const Float3 aim = i % 3 == 0 ? a : i % 3 == 1 ? on_edge : inside;
    const Float3 org = at(middle, away * size, random.direction());
    rays.push_back({org, minus(aim, org)});
  }
  return rays;
}

RayBuffer buffer_of(const std::vector<Ray>& rays) {
  RayBuffer b;
  for (const Ray& r : rays)
    b.add({r.org.x, r.org.y, r.org.z}, {r.dir.x, r.dir.y, r.dir.z}, r.t_max);
  return b;
}

/// The exact answers.
struct Judged {
  std::vector<test::rational::First> first;
};

Judged judge(const Scene& s, const std::vector<Ray>& rays) {
  Judged j;
  const test::rational::FirstTriangle first(s);
  for (const Ray& r : rays)
    j.first.push_back(first(r));
  return j;
}

/// Lost, false, other triangles. `any_of_equal`: of equal t each is right, which t tells.
struct Wrong {
  int lost = 0, wrong = 0, other = 0;
};
Wrong compare(const Judged& j,
              const std::vector<std::uint32_t>& id,
              const std::vector<float>& t,
              bool any_of_equal) {
  Wrong w;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const bool met = id[i] != kNoPrimitive;
    const bool should = j.first[i].id != kNoPrimitive;
    w.lost += should && !met;
    w.wrong += met && !should;
    const bool near = any_of_equal && std::abs(t[i] / j.first[i].t - 1) < 1e-5f;
    w.other += met && should && id[i] != j.first[i].id && !near;
  }
  return w;
}

template <class Trace>
double least_ns(int rounds, std::size_t rays, const Trace& trace) {
  double least = 1e300;
  for (int i = 0; i < rounds; ++i) {
    const auto start = std::chrono::steady_clock::now();
    trace();
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    least = std::min(least, took.count() / static_cast<double>(rays));
  }
  return least;
}

/// A line of the table: where, and who was asked.
struct Row {
  std::string mesh;
  double moved, away;
  void tell(const char* who, const Wrong& w, double ns) const {
    std::printf("%s,%g,%g,%s,%d,%d,%d,%.1f\n",
                mesh.c_str(),
                moved,
                away,
                who,
                w.lost,
                w.wrong,
                w.other,
                ns);
    std::fflush(stdout);
  }
};

void ask_embree(const Row& row,
                const Scene& s,
                bool robust,
                const RayBuffer& rays,
                const Judged& j,
                int rounds) {
  const auto embree = make_embree_scene(s, robust);
  if (!embree)
    return;
  const EmbreeMode mode{"", 1, false};
  const double ns = least_ns(rounds, j.first.size(), [&] { embree->trace(rays, false, mode); });
  const Answers a = embree->answers();
  row.tell(robust ? "embree robust" : "embree", compare(j, a.id, a.t, true), ns);
}

void ask_cgal(const Row& row,
              const Scene& s,
              bool exact,
              const std::vector<Ray>& rays,
              const Judged& j,
              int rounds) {
  const auto tree = make_cgal_tree(s, exact);
  if (!tree)
    return;
  std::vector<Hit> hits(rays.size());
  const double ns = least_ns(rounds, rays.size(), [&] { tree->closest(rays, hits); });
  std::vector<std::uint32_t> id;
  std::vector<float> t;
  for (const Hit& h : hits) {
    id.push_back(h.id);
    t.push_back(h.t);
  }
  row.tell(exact ? "CGAL exact" : "CGAL predicates", compare(j, id, t, true), ns);
}

void ask_all(const std::string& name, double moved, double away, const Options& o) {
  double size = 0;
  Float3 middle{};
  const Scene s = moved_mesh(name, moved, size, middle);
  const std::vector<Ray> rays = aimed(s, size, middle, away, o.rays);
  const Judged j = judge(s, rays);
  const World world(s, {});
  std::vector<Hit> hits(rays.size());
  const auto ask = [&](const Row& row, const char* who, const auto& trace) {
    const double ns = least_ns(o.rounds, rays.size(), trace);
    std::vector<std::uint32_t> id;
    std::vector<float> t;
    for (const Hit& h : hits) {
      id.push_back(h.id);
      t.push_back(h.t);
    }
    row.tell(who, compare(j, id, t, false), ns);
  };
  const Row row{name.substr(name.find_last_of('/') + 1), moved, away};
  ask(row, "grelha calls", [&] {
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = closest(world, rays[i]);
  });
  ask(row, "grelha streams", [&] { closest(world, std::span(rays), std::span(hits)); });
  const RayBuffer buffer = buffer_of(rays);
  ask_embree(row, s, true, buffer, j, o.rounds);
  ask_embree(row, s, false, buffer, j, o.rounds);
  ask_cgal(row, s, true, rays, j, 1);
  ask_cgal(row, s, false, rays, j, 1);
}

}  // namespace

int main(int argc, char** argv) {
  const Options o = parse(argc, argv);
  std::printf("# %d rays a row, a third each at vertices, at edges and at faces; one thread; %s\n",
              o.rays,
              embree_name().empty() ? "no Embree here" : embree_name().c_str());
  if (!make_cgal_tree({}, false))
    std::fprintf(stderr, "skipped: no CGAL here\n");
  std::printf("mesh,moved,eye,who,lost,false,other,ns\n");
  for (const std::string& name : o.scenes)
    for (const double moved : {0., 1e3, 1e6})
      for (const double away : {.8, 3., 100., 1e4})
        ask_all(name, moved, away, o);
  return 0;
}
