// What a ray-triangle test costs and how far off it is: by instruction set, in single and double
// precision, watertight (Woop, Benthin, Wald 2013) or after Möller and Trumbore (1997), with and
// without fused multiply-add.
//
// precision [--scenes] [--groups N] [Google Benchmark options; --benchmark_format=json]
//
// Each test is one benchmark, isa/precision/method. Its counters say how it erred, judged in 113
// bits, where the six products of three differences of floats are exact for the sizes used here:
//
// max_ulp, p999_ulp  |t - true t| in units in the last place of the true t as a float, of rays
//                    through random triangles
// wrong              of these, rays whose nearest triangle is another than the true one
// leaks              of rays from within a closed hull aimed at its corners and edges, those that
//                    meet nothing
// ns                 a test of a ray and a triangle, of triangles at most four times as long as
//                    wide
//
// With --scenes whole traces instead, isa/precision/scene: camera rays of generated scenes through
// their grids. Errors are those of t before it is rounded, judged in long double against every
// primitive of the scene; leaks: rays that meet nothing where there is something; ns: a ray. Beside
// them embree/default/scene and embree/robust/scene, 16 coherent rays side by side, where Embree
// is.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <benchmark/benchmark.h>

#include "kernel/grid/world_impl.hpp"
#include "perf/embree.hpp"
#include "perf/precision_loops.hpp"
#include "perf/workloads.hpp"
#include "tests/support/oracle.hpp"

namespace {

using namespace grelha::perf;

__extension__ typedef __float128 Quad;

/// Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double unit() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  double between(double a, double b) { return a + (b - a) * unit(); }
  int below(int n) { return static_cast<int>(unit() * n); }

 private:
  std::uint64_t state_;
};

struct V {
  double x[3];
};
V operator+(const V& a, const V& b) {
  return {{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
}
V operator-(const V& a, const V& b) {
  return {{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}
V operator*(double s, const V& a) { return {{s * a.x[0], s * a.x[1], s * a.x[2]}}; }
V rounded(const V& a) {
  return {{double(float(a.x[0])), double(float(a.x[1])), double(float(a.x[2]))}};
}
V direction(Random& r) {
  for (;;) {
    const V v{{r.between(-1, 1), r.between(-1, 1), r.between(-1, 1)}};
    const double d = v.x[0] * v.x[0] + v.x[1] * v.x[1] + v.x[2] * v.x[2];
    if (d > .01 && d <= 1)
      return 1 / std::sqrt(d) * v;
  }
}
int major(const V& v) {
  const double a[3] = {std::abs(v.x[0]), std::abs(v.x[1]), std::abs(v.x[2])};
  return a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
}

void add(std::vector<float> (&to)[3], const V& v) {
  for (int a = 0; a < 3; ++a)
    to[a].push_back(static_cast<float>(v.x[a]));
}

/// Sixteen triangles, their sizes between .001 and 1 of their distance and up to `longest` times as
/// long as wide, each with a ray aimed at a point within it.
void add_random_group(Pairs& p, Random& r, double longest) {
  const V eye = std::exp2(r.between(-3, 3)) * direction(r);
  const int axis = r.below(3);
  for (int i = 0; i < kGroup;) {
    const V way = direction(r);
    const double far = std::exp2(r.between(-4, 4)), size = far * std::exp2(r.between(-10, 0)),
                 thin = std::exp2(-r.between(0, std::log2(longest)));
    const V at = eye + far * way, along = direction(r);
    const V a = rounded(at + size * along), b = rounded(at - size * along),
            c = rounded(at + size * thin * direction(r));
    double u = r.between(.01, .99), v = r.between(.01, .99);
    if (u + v > .99) {
      u = 1 - u;
      v = 1 - v;
    }
    if (u + v > .99)
      continue;
    const V dir = rounded((1 / far) * ((a + u * (b - a) + v * (c - a)) - rounded(eye)));
    if (major(dir) != axis)
      continue;
    add(p.org, eye);
    add(p.dir, dir);
    add(p.a, a);
    add(p.b, b);
    add(p.c, c);
    ++i;
  }
  p.axis.push_back(static_cast<std::uint8_t>(axis));
}

/// A double pyramid over eight corners around the rays' origin, and sixteen rays at its corners and
/// points of its edges.
void add_hull_group(Pairs& p, Random& r) {
  const double size = std::exp2(r.between(-6, 6));
  const V middle = std::exp2(r.between(-3, 3)) * direction(r);
  V ring[8],
      top = rounded(middle + size * V{{r.between(-.1, .1), r.between(-.1, .1), r.between(.5, 1)}});
  V bottom = rounded(middle - size * V{{r.between(-.1, .1), r.between(-.1, .1), r.between(.5, 1)}});
  for (int i = 0; i < 8; ++i) {
    const double angle = (i + r.between(-.2, .2)) * .78539816, wide = size * r.between(.7, 1);
    ring[i] = rounded(
        middle + V{{wide * std::cos(angle), wide * std::sin(angle), size * r.between(-.2, .2)}});
  }
  const V eye = rounded(middle + size * r.between(0, .1) * direction(r));
  const int axis = r.below(3);
  for (int i = 0; i < kGroup;) {
    const V &a = ring[r.below(8)], &tip = r.below(2) == 0 ? top : bottom;
    const int n = static_cast<int>(&a - ring);
    const V& b = r.below(2) == 0 ? tip : ring[(n + 1) % 8];
    const int kind = r.below(3);
    const double s = kind == 0 ? 0 : kind == 1 ? .5 : r.unit();
    const V dir = rounded((a + s * (b - a)) - eye);
    if (major(dir) != axis)
      continue;
    add(p.org, eye);
    add(p.dir, dir);
    ++i;
  }
  for (int i = 0; i < 8; ++i)
    for (const V& tip : {top, bottom})
      add(p.a, ring[i]), add(p.b, ring[(i + 1) % 8]), add(p.c, tip);
  p.axis.push_back(static_cast<std::uint8_t>(axis));
}

struct Q {
  Quad x[3];
};
Q difference(const std::vector<float> (&a)[3],
             std::size_t i,
             const std::vector<float> (&b)[3],
             std::size_t j) {
  return {{Quad(a[0][i]) - b[0][j], Quad(a[1][i]) - b[1][j], Quad(a[2][i]) - b[2][j]}};
}
Quad volume(const Q& a, const Q& b, const Q& c) {
  return a.x[0] * (b.x[1] * c.x[2] - b.x[2] * c.x[1]) +
         a.x[1] * (b.x[2] * c.x[0] - b.x[0] * c.x[2]) +
         a.x[2] * (b.x[0] * c.x[1] - b.x[1] * c.x[0]);
}

/// Exact: t at which ray i crosses triangle j, edges included; negative: it does not.
double crossing(const Pairs& p, std::size_t i, std::size_t j) {
  const Q d{{p.dir[0][i], p.dir[1][i], p.dir[2][i]}}, a = difference(p.a, j, p.org, i),
                                                      b = difference(p.b, j, p.org, i),
                                                      c = difference(p.c, j, p.org, i);
  const Quad u = volume(d, b, c), v = volume(d, c, a), w = volume(d, a, b), det = u + v + w;
  if (det == 0 || ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)))
    return -1;
  return static_cast<double>(volume(a, b, c) / det);
}

struct Truth {
  std::vector<double> t;
  std::vector<int> triangle;
};
Truth truth_of(const Pairs& p) {
  Truth out;
  for (std::size_t i = 0; i < p.org[0].size(); ++i) {
    double t = 1e30;
    int which = -1;
    for (int k = 0; k < kGroup; ++k)
      if (const double here = crossing(p, i, i / kGroup * kGroup + static_cast<std::size_t>(k));
          here > 0 && here < t) {
        t = here;
        which = k;
      }
    out.t.push_back(t);
    out.triangle.push_back(which);
  }
  return out;
}

double ulps(double t, double truth) {
  int exponent;
  std::frexp(truth, &exponent);
  return std::abs(t - truth) / std::ldexp(1, exponent - 24);
}

struct Workload {
  Pairs random, hulls, timed;
  Truth truth;
  explicit Workload(int groups) {
    Random r(1);
    for (int i = 0; i < groups; ++i) {
      add_random_group(random, r, 1000);
      add_hull_group(hulls, r);
      add_random_group(timed, r, 4);
    }
    truth = truth_of(random);
  }
};

PairHits room_for(const Pairs& p) {
  const std::size_t n = static_cast<std::size_t>(p.groups()) * kGroup;
  return {std::vector<double>(n), std::vector<int>(n)};
}

void set_counters(
    benchmark::State& state, std::vector<double> errors, double rays, double wrong, double leaks) {
  std::sort(errors.begin(), errors.end());
  state.counters["max_ulp"] = errors.empty() ? 0 : errors.back();
  state.counters["p999_ulp"] = errors.empty() ? 0 : errors[errors.size() * 999 / 1000];
  state.counters["rays"] = rays;
  state.counters["wrong"] = wrong;
  state.counters["leaks"] = leaks;
}

void run(benchmark::State& state, const Workload& work, void (*loop)(const Pairs&, PairHits&)) {
  PairHits hits = room_for(work.random), hulls = room_for(work.hulls);
  loop(work.hulls, hulls);
  loop(work.random, hits);
  double wrong = 0, leaks = 0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < hits.t.size(); ++i) {
    if (hits.triangle[i] != work.truth.triangle[i])
      ++wrong;
    else if (hits.triangle[i] >= 0)
      errors.push_back(ulps(hits.t[i], work.truth.t[i]));
  }
  for (const int t : hulls.triangle)
    leaks += t < 0;
  for (auto _ : state) {
    loop(work.timed, hits);
    benchmark::DoNotOptimize(hits.t.data());
  }
  const double tests = static_cast<double>(hits.t.size()) * kGroup;
  state.counters["ns"] = benchmark::Counter(
      tests * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  set_counters(state, std::move(errors), static_cast<double>(hits.t.size()), wrong, leaks);
}

// ---- scenes
// ------------------------------------------------------------------------------------------

namespace oracle = grelha::test::oracle;

/// A scene, camera rays to judge by and four times as many on a side to time.
struct SceneWork {
  std::string name;
  grelha::SceneFile file;
  grelha::World world;
  RayBuffer judged, timed;
  Truth truth;

  SceneWork(const std::string& scene, int size, int side)
      : name(scene + " " + std::to_string(size)),
        file(make_scene(scene, size)),
        world(file.scene, {}),
        judged(rays(side)),
        timed(rays(4 * side)) {
    for (std::size_t i = 0; i < judged.size(); ++i)
      judge(i);
  }

 private:
  RayBuffer rays(int side) const {
    grelha::Camera camera = file.camera;
    camera.width = camera.height = side;
    return camera_rays(camera);
  }
  /// The nearest of all primitives; where two are equally near the first.
  void judge(std::size_t i) {
    const auto& v = world.impl().view;
    const auto& g = v.geometry;
    const oracle::Ray ray{grelha::Float3{judged.ox[i], judged.oy[i], judged.oz[i]},
                          grelha::Float3{judged.dx[i], judged.dy[i], judged.dz[i]}};
    oracle::Real nearest = 1e30L;
    int which = -1;
    const auto note = [&](const std::optional<oracle::Crossing>& c, std::uint32_t id) {
      if (c && c->t < nearest) {
        nearest = c->t;
        which = static_cast<int>(id);
      }
    };
    const auto corner = [&](std::uint32_t k) {
      return oracle::V(grelha::Float3{g.tx[k], g.ty[k], g.tz[k]});
    };
    for (std::uint32_t k = 0; k < g.plane_count; ++k)
      note(oracle::Sheet{grelha::Float3{g.px[k], g.py[k], g.pz[k]},
                         grelha::Float3{g.pnx[k], g.pny[k], g.pnz[k]}}
               .first(ray, 0),
           k);
    for (std::uint32_t k = 0; k < g.sphere_count; ++k)
      note(oracle::Ball{grelha::Float3{g.sx[k], g.sy[k], g.sz[k]}, g.sr[k]}.first(ray, 0),
           v.geometry.ids.begin(grelha::PrimitiveKind::kSphere) + k);
    for (std::uint32_t k = 0; k < g.triangle_count; ++k)
      note(oracle::Facet{corner(g.ta[k]), corner(g.tb[k]), corner(g.tc[k])}.first(ray, 0),
           v.geometry.ids.begin(grelha::PrimitiveKind::kTriangle) + k);
    truth.t.push_back(static_cast<double>(nearest));
    truth.triangle.push_back(which);
  }
};

struct SceneHits {
  std::vector<float> t;
  std::vector<double> whole;
  std::vector<std::uint32_t> id;
};

void trace_scene(const SceneWork& work,
                 const grelha::Variant& variant,
                 bool in_double,
                 const RayBuffer& r,
                 SceneHits& hits) {
  hits.t = r.t_max;
  hits.id.resize(r.size());
  grelha::TraceCounts counts;
  const grelha::RaySpan span{r.ox.data(),
                             r.oy.data(),
                             r.oz.data(),
                             r.dx.data(),
                             r.dy.data(),
                             r.dz.data(),
                             r.t_min.data(),
                             hits.t.data(),
                             hits.id.data(),
                             static_cast<int>(r.size()),
                             hits.whole.empty() ? nullptr : hits.whole.data()};
  (in_double ? variant.loops.in_double.closest : variant.loops.closest)(
      work.world.impl().view, span, {}, counts);
}

/// Sets all counters but the time's. `t` of ray i is what judge gets.
template <class T>
void judge_scene(benchmark::State& state,
                 const SceneWork& work,
                 const std::vector<std::uint32_t>& id,
                 const T& t) {
  double wrong = 0, leaks = 0;
  std::vector<double> errors;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const bool met = id[i] != grelha::kNoPrimitive, there = work.truth.triangle[i] >= 0;
    // Where two meet either is right.
    const bool same =
        met && there &&
        (static_cast<int>(id[i]) == work.truth.triangle[i] || ulps(t(i), work.truth.t[i]) < 64);
    if (same)
      errors.push_back(ulps(t(i), work.truth.t[i]));
    else if (met || there) {
      ++wrong;
      leaks += !met;
    }
  }
  set_counters(state, std::move(errors), static_cast<double>(work.judged.size()), wrong, leaks);
}

void run_embree(benchmark::State& state, const SceneWork& work, bool robust) {
  const auto scene = make_embree_scene(work.file.scene, robust);
  const EmbreeMode mode{"16 coherent", 16, true};
  scene->trace(work.judged, false, mode);
  const Answers a = scene->answers();
  for (auto _ : state)
    scene->trace(work.timed, false, mode);
  const double timed = static_cast<double>(work.timed.size());
  state.counters["ns"] = benchmark::Counter(
      timed * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  judge_scene(state, work, a.id, [&](std::size_t i) { return static_cast<double>(a.t[i]); });
}

void run_scene(benchmark::State& state,
               const SceneWork& work,
               const grelha::Variant& variant,
               bool in_double) {
  SceneHits hits;
  hits.whole.resize(work.judged.size());
  trace_scene(work, variant, in_double, work.judged, hits);
  const SceneHits judged = hits;
  hits.whole.clear();
  for (auto _ : state) {
    trace_scene(work, variant, in_double, work.timed, hits);
    benchmark::DoNotOptimize(hits.t.data());
  }
  const double timed = static_cast<double>(work.timed.size());
  state.counters["ns"] = benchmark::Counter(
      timed * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  judge_scene(state, work, judged.id, [&](std::size_t i) { return judged.whole[i]; });
}

int run_scenes(int groups) {
  const int side = std::max(8, static_cast<int>(std::sqrt(groups)));
  std::vector<SceneWork> works;
  works.reserve(2);
  works.emplace_back("mount", 6, side);
  works.emplace_back("balls", 3, side);
  for (const grelha::Variant* v : grelha::variants()) {
    if (!v->runs_here()) {
      std::fprintf(
          stderr, "precision: this processor has no %s: left out\n", std::string(v->name).c_str());
      continue;
    }
    for (const bool in_double : {false, true})
      for (const SceneWork& work : works)
        benchmark::RegisterBenchmark(
            (std::string(v->name) + (in_double ? "/double/" : "/single/") + work.name).c_str(),
            [&work, v, in_double](benchmark::State& s) { run_scene(s, work, *v, in_double); });
  }
  if (!embree_modes().empty())
    for (const bool robust : {false, true})
      for (const SceneWork& work : works)
        benchmark::RegisterBenchmark(
            (std::string(robust ? "embree/robust/" : "embree/default/") + work.name).c_str(),
            [&work, robust](benchmark::State& s) { run_embree(s, work, robust); });
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  int groups = 4096, at = 1;
  const bool scenes = at < argc && std::string(argv[at]) == "--scenes";
  at += scenes;
  if (at + 1 < argc && std::string(argv[at]) == "--groups") {
    groups = std::atoi(argv[at + 1]);
    at += 2;
  }
  if (groups < 1 || at != argc) {
    std::fprintf(stderr, "usage: precision [--scenes] [--groups N] [Google Benchmark options]\n");
    return 2;
  }
  if (scenes)
    return run_scenes(groups);
  const Workload work(groups);
  std::vector<const PrecisionLoops*> all{&k_scalar_precision};
#ifdef GRELHA_X86_VARIANTS
  all.insert(all.end(),
             {&k_sse2_precision,
              &k_avx2_precision,
              &k_avx512_precision,
              &k_avx2_fused_precision,
              &k_avx512_fused_precision});
#endif
  for (const PrecisionLoops* isa : all) {
    if (!isa->runs_here()) {
      std::fprintf(
          stderr, "precision: this processor has no %s: left out\n", std::string(isa->isa).c_str());
      continue;
    }
    for (int in_double = 0; in_double < 2; ++in_double)
      for (int watertight = 0; watertight < 2; ++watertight)
        benchmark::RegisterBenchmark((std::string(isa->isa) + (isa->fused ? "+fma" : "") +
                                      (in_double ? "/double/" : "/single/") +
                                      (watertight ? "watertight" : "moeller-trumbore"))
                                         .c_str(),
                                     [&work, loop = isa->loop[in_double][watertight]](
                                         benchmark::State& s) { run(s, work, loop); });
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
