#include "perf/precision/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "kernel/world/world_impl.hpp"
#include "perf/embree.hpp"
#include "perf/precision/counters.hpp"
#include "perf/precision/workload.hpp"
#include "perf/workloads.hpp"
#include "tests/support/oracle.hpp"

namespace grelha::perf {
namespace {

namespace oracle = test::oracle;

/// A scene, camera rays to judge by and four times as many on a side to time.
struct SceneWork {
  std::string name;
  SceneFile file;
  World world;
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
    Camera camera = file.camera;
    camera.width = camera.height = side;
    return camera_rays(camera);
  }
  /// The nearest of all primitives; where two are equally near the first.
  void judge(std::size_t i) {
    const auto& v = world.impl().view;
    const auto& g = v.geometry;
    const oracle::Ray ray{Float3{judged.ox[i], judged.oy[i], judged.oz[i]},
                          Float3{judged.dx[i], judged.dy[i], judged.dz[i]}};
    oracle::Real nearest = 1e30L;
    int which = -1;
    const auto note = [&](const std::optional<oracle::Crossing>& c, std::uint32_t id) {
      if (c && c->t < nearest) {
        nearest = c->t;
        which = static_cast<int>(id);
      }
    };
    const auto three = [](const float* const(&of)[3], std::uint32_t k) {
      return Float3{of[0][k], of[1][k], of[2][k]};
    };
    const auto& planes = g.of<Plane>();
    const auto& spheres = g.of<Sphere>();
    const auto& triangles = g.of<Triangle>();
    const auto corner = [&](std::uint32_t k) { return oracle::V(three(triangles.vertex, k)); };
    for (std::uint32_t k = 0; k < planes.count; ++k)
      note(oracle::Sheet{three(planes.fields.point, k), three(planes.fields.normal, k)}.first(ray,
                                                                                              0),
           k);
    for (std::uint32_t k = 0; k < spheres.count; ++k)
      note(oracle::Ball{three(spheres.fields.center, k), spheres.fields.radius[k]}.first(ray, 0),
           v.geometry.ids.begin(PrimitiveKind::kSphere) + k);
    for (std::uint32_t k = 0; k < triangles.count; ++k)
      note(oracle::Facet{corner(triangles.corner[0][k]),
                         corner(triangles.corner[1][k]),
                         corner(triangles.corner[2][k])}
               .first(ray, 0),
           v.geometry.ids.begin(PrimitiveKind::kTriangle) + k);
    truth.t.push_back(static_cast<double>(nearest));
    truth.triangle.push_back(which);
  }
};

struct SceneHits {
  std::vector<float> t;
  std::vector<double> t_double;
  std::vector<std::uint32_t> id;
};

void trace_scene(const SceneWork& work,
                 const Variant& variant,
                 bool in_double,
                 const RayBuffer& r,
                 SceneHits& hits) {
  hits.t.resize(r.size());
  hits.id.resize(r.size());
  TraceCounts counts;
  const Hits out{.t = hits.t.data(),
                 .id = hits.id.data(),
                 .t_double = hits.t_double.empty() ? nullptr : hits.t_double.data()};
  (in_double ? variant.loops.in_double.closest : variant.loops.closest)(
      work.world.impl().view, r.view(), out, {}, counts);
}

/// Sets all counters but the time's. `t` of ray i is what judge gets.
template <class T>
void judge_scene(benchmark::State& state,
                 const SceneWork& work,
                 const std::vector<std::uint32_t>& id,
                 const T& t) {
  Errors errors;
  errors.rays = static_cast<double>(work.judged.size());
  for (std::size_t i = 0; i < id.size(); ++i) {
    const bool met = id[i] != kNoPrimitive, there = work.truth.triangle[i] >= 0;
    // Where two meet either is right.
    const bool same =
        met && there &&
        (static_cast<int>(id[i]) == work.truth.triangle[i] || ulps(t(i), work.truth.t[i]) < 64);
    if (same)
      errors.ulps.push_back(ulps(t(i), work.truth.t[i]));
    else if (met || there) {
      ++errors.wrong;
      errors.leaks += !met;
    }
  }
  set_counters(state, std::move(errors));
}

void run_embree(benchmark::State& state, const SceneWork& work, bool robust) {
  const auto scene = make_embree_scene(work.file.scene, robust);
  const EmbreeMode mode{"16 coherent", 16, true};
  scene->trace(work.judged, false, mode);
  const Answers a = scene->answers();
  for (auto _ : state)
    scene->trace(work.timed, false, mode);
  set_time(state, static_cast<double>(work.timed.size()));
  judge_scene(state, work, a.id, [&](std::size_t i) { return static_cast<double>(a.t[i]); });
}

void run_scene(benchmark::State& state,
               const SceneWork& work,
               const Variant& variant,
               bool in_double) {
  SceneHits hits;
  hits.t_double.resize(work.judged.size());
  trace_scene(work, variant, in_double, work.judged, hits);
  const SceneHits judged = hits;
  hits.t_double.clear();
  for (auto _ : state) {
    trace_scene(work, variant, in_double, work.timed, hits);
    benchmark::DoNotOptimize(hits.t.data());
  }
  set_time(state, static_cast<double>(work.timed.size()));
  judge_scene(state, work, judged.id, [&](std::size_t i) { return judged.t_double[i]; });
}

std::vector<SceneWork> scene_works(int groups) {
  const int side = std::max(8, static_cast<int>(std::sqrt(groups)));
  std::vector<SceneWork> works;
  works.reserve(2);
  works.emplace_back("mount", 6, side);
  works.emplace_back("balls", 3, side);
  return works;
}

void register_variants(const std::vector<SceneWork>& works) {
  for (const Variant* v : variants()) {
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
}

void register_embree(const std::vector<SceneWork>& works) {
  for (const bool robust : {false, true})
    for (const SceneWork& work : works)
      benchmark::RegisterBenchmark(
          (std::string(robust ? "embree/robust/" : "embree/default/") + work.name).c_str(),
          [&work, robust](benchmark::State& s) { run_embree(s, work, robust); });
}

}  // namespace

int run_scenes(int groups) {
  const std::vector<SceneWork> works = scene_works(groups);
  register_variants(works);
  if (!embree_modes().empty())
    register_embree(works);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace grelha::perf
