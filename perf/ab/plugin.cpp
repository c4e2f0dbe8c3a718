// One copy of the kernel behind the functions of plain.hpp. Compiled against this tree and against
// the other, so it names only what both have: public queries, and two loops of a Variant.
#include "plain.hpp"  // of this folder: the other tree may have one of its own

#include <algorithm>
#include <span>
#include <vector>

#include "grelha/query.hpp"
#include "grelha/scene_spans.hpp"
#include "grelha/world.hpp"
#include "kernel/query/variants.hpp"
#if __has_include("kernel/world/world_impl.hpp")
#include "kernel/world/world_impl.hpp"
#else  // an older tree
#include "kernel/grid/world_impl.hpp"
#endif

namespace grelha::perf {
namespace {

std::vector<Object> objects_of(const PlainScene& s) {
  std::vector<Object> objects(s.objects);
  for (std::size_t i = 0; i < s.objects; ++i) {
    objects[i].first_triangle = s.object[0][i];
    objects[i].triangle_count = s.object[1][i];
  }
  return objects;
}

/// Has no materials: no ray asks for them.
SceneSpans spans_of(const PlainScene& s, const std::vector<Object>& objects) {
  SceneSpans to;
  GeometrySpans& g = to.geometry;
  Floats* const spheres[] = {&g.spheres.x, &g.spheres.y, &g.spheres.z, &g.spheres.radius};
  Floats* const vertices[] = {&g.triangles.x, &g.triangles.y, &g.triangles.z};
  Indices* const corners[] = {&g.triangles.a, &g.triangles.b, &g.triangles.c};
  ConeSpans& c = g.cones;
  Floats* const cones[] = {&c.base_x,
                           &c.base_y,
                           &c.base_z,
                           &c.base_radius,
                           &c.apex_x,
                           &c.apex_y,
                           &c.apex_z,
                           &c.apex_radius};
  PlaneSpans& p = g.planes;
  Floats* const planes[] = {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz};
  const auto refer = [](const auto& fields, const auto& arrays, std::size_t count) {
    for (std::size_t k = 0; k < std::size(fields); ++k)
      *fields[k] = {arrays[k], count};
  };
  refer(spheres, s.sphere, s.spheres);
  refer(vertices, s.vertex, s.vertices);
  refer(corners, s.corner, s.triangles);
  refer(cones, s.cone, s.cones);
  refer(planes, s.plane, s.planes);
  g.objects = objects;
  return to;
}

/// A World, and the one array that it refers to and the host does not have.
struct Built {
  std::vector<Object> objects;
  World world;
  explicit Built(const PlainScene& s) : objects(objects_of(s)), world(spans_of(s, objects), {}) {}
};

Rays some(const PlainRays& r, std::size_t first, std::size_t count) {
  Rays rays;
  for (int a = 0; a < 3; ++a) {
    rays.org[a] = r.org[a] + first;
    rays.dir[a] = r.dir[a] + first;
  }
  rays.t_min = r.t_min + first;
  rays.t_max = r.t_max + first;
  rays.count = count;
  return rays;
}

/// Past the library, as a render asks.
void ask_loops(const World& world, const PlainRays& r, float* t, const PlainAnswers& to) {
  const VariantLoops& loops = best_variant().loops;
  TraceCounts unused;
  Hits hits;
  hits.t = t;
  hits.id = to.id;
  if (to.blocked)
    loops.occluded(world.impl().view, some(r, 0, r.count), to.blocked, {}, unused);
  else
    loops.closest(world.impl().view, some(r, 0, r.count), hits, {}, unused);
}

void call_each(const World& world, const PlainRays& r, const PlainAnswers& to) {
  for (std::size_t i = 0; i < r.count; ++i) {
    const Ray ray{{r.org[0][i], r.org[1][i], r.org[2][i]},
                  {r.dir[0][i], r.dir[1][i], r.dir[2][i]},
                  r.t_min[i],
                  r.t_max[i]};
    if (to.blocked) {
      to.blocked[i] = occluded(world, ray);
      continue;
    }
    const Hit hit = closest(world, ray);
    to.t[i] = hit.t;
    to.id[i] = hit.id;
  }
}

void ask_in_streams(const World& world, const PlainRays& r, const PlainAnswers& to) {
  constexpr std::size_t kEach = 8;
  for (std::size_t i = 0; i < r.count; i += kEach) {
    const Rays rays = some(r, i, std::min(kEach, r.count - i));
    if (to.blocked) {
      occluded(world, rays, to.blocked + i);
      continue;
    }
    Hits hits;
    hits.t = to.t + i;
    hits.id = to.id + i;
    closest(world, rays, hits);
  }
}

}  // namespace

void* ab_world(const PlainScene* scene) {
  return new Built(*scene);
}

void ab_free(void* world) {
  delete static_cast<Built*>(world);
}

void ab_run(void* world, int way, const PlainRays* rays, const PlainAnswers* answers) {
  const World& w = static_cast<Built*>(world)->world;
  switch (way) {
    case kCalls:
      return call_each(w, *rays, *answers);
    case kStreams:
      return ask_in_streams(w, *rays, *answers);
    default:
      return ask_loops(w, *rays, way == kWithoutT ? nullptr : answers->t, *answers);
  }
}

}  // namespace grelha::perf
