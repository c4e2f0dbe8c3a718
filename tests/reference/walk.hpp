#pragma once
// The report's way, kept as the reference all others are measured against: one ray, one primitive
// at a time, cell by cell. Amanatides & Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing",
// 1987, with two mends: plane distances come from the plane's index instead of adding up, and
// mailboxes stand with the ray instead of the primitive.
//
// It shares with the kernel the tests of primitives and the rules of what a ray is (how far origins
// are brought near, which grid serves whom), and nothing of how rays are walked.

#include "grelha/rays.hpp"
#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

/// The primitives a ray has met (hashed; may forget, never wrong).
struct RayMailbox {
  static constexpr unsigned kSize = 64;
  std::uint32_t held[kSize];
  void clear() {
    for (std::uint32_t& id : held)
      id = kNoPrimitive;
  }
  bool seen(std::uint32_t id) {
    std::uint32_t& slot = held[id % kSize];
    if (slot == id)
      return true;
    slot = id;
    return false;
  }
};

/// A ray on its way. Primitives are tested in Real, from where the ray came in double, from where
/// it was brought near in float; grids are always walked in float, from there.
template <class Real>
struct WalkedRay {
  static constexpr bool kInDouble = sizeof(Real) == sizeof(double);
  float near_org[3];
  float dir[3];
  float near_t_min;
  float near_best;  ///< never below the true one
  Real org[3];
  Real t_min;
  Real best;
  Real shift = 0;  ///< t by which the ray was brought near
  Real inv_dd;
  int axis;
  Shear<Real> shear;
  std::uint32_t id = kNoPrimitive;

  void set_best(Real t) {
    best = t;
    near_best = kInDouble ? not_below(t - shift) : static_cast<float>(t);
  }
};

/// Takes a hit that is the best so far. Returns whether the search is over.
template <bool kAny, class Real>
bool take(WalkedRay<Real>& r, bool hit, Real t, std::uint32_t id) {
  if (!hit)
    return false;
  if (kAny) {
    if (!(t < r.best))
      return false;
    r.set_best(-kInfinity);
    r.id = id;
    return true;
  }
  if (t < r.best || (t == r.best && r.id != kNoPrimitive && id < r.id)) {
    r.set_best(t);
    r.id = id;
  }
  return false;
}

template <bool kAny, class Real>
bool test_triangles(
    WalkedRay<Real>& r, const CellLists& lists, std::size_t cell, RayMailbox* box, Counters& n) {
  const int k = r.axis;
  const int kx = kNextAxis[k];
  const int ky = kPreviousAxis[k];
  const auto [first, end] = lists.of<Triangle>().blocks_of(cell);
  for (std::uint32_t b = first; b < end; ++b) {
    const TriangleBlock& block = lists.of<Triangle>().blocks[b];
    for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i) {
      if (box && box->seen(block.id[i]))
        continue;
      ++n.tests[kNumber<Triangle>];
      const auto ray_and_triangle = [&] {
        return RayAndTriangle<Real>{{r.org[kx], r.org[ky], r.org[k]},
                                    {r.dir[kx], r.dir[ky], r.dir[k]},
                                    {{block.a[kx][i], block.a[ky][i], block.a[k][i]},
                                     {block.b[kx][i], block.b[ky][i], block.b[k][i]},
                                     {block.c[kx][i], block.c[ky][i], block.c[k][i]}}};
      };
      const Real t_max = kInfinity;  // exactly where, whatever is met already
      Real t = 0;
      const bool hit = hit_triangle<false>(ray_and_triangle, r.shear, r.t_min, t_max, t);
      if (take<kAny>(r, hit, t, block.id[i]))
        return true;
    }
  }
  return false;
}

template <bool kAny, class Real>
bool test_spheres(
    WalkedRay<Real>& r, const CellLists& lists, std::size_t cell, RayMailbox* box, Counters& n) {
  for (std::uint32_t i = lists.of<Sphere>().first[cell]; i < lists.of<Sphere>().first[cell + 1];
       ++i) {
    if (box && box->seen(lists.of<Sphere>().id[i]))
      continue;
    ++n.tests[kNumber<Sphere>];
    Real t = 0;
    const bool hit = hit_sphere<Real>({r.org[0], r.org[1], r.org[2]},
                                      {r.dir[0], r.dir[1], r.dir[2]},
                                      r.inv_dd,
                                      r.t_min,
                                      {lists.of<Sphere>().fields.center[0][i],
                                       lists.of<Sphere>().fields.center[1][i],
                                       lists.of<Sphere>().fields.center[2][i]},
                                      lists.of<Sphere>().fields.radius[i],
                                      t);
    if (take<kAny>(r, hit, t, lists.of<Sphere>().id[i]))
      return true;
  }
  return false;
}

template <bool kAny, class Real>
bool test_cones(
    WalkedRay<Real>& r, const CellLists& lists, std::size_t cell, RayMailbox* box, Counters& n) {
  for (std::uint32_t i = lists.of<Cone>().first[cell]; i < lists.of<Cone>().first[cell + 1]; ++i) {
    if (box && box->seen(lists.of<Cone>().id[i]))
      continue;
    ++n.tests[kNumber<Cone>];
    Real t = 0;
    const bool hit = hit_cone<Real>({r.org[0], r.org[1], r.org[2]},
                                    {r.dir[0], r.dir[1], r.dir[2]},
                                    r.inv_dd,
                                    r.t_min,
                                    broadcast<Cone, Real>(lists.of<Cone>().fields, i),
                                    t);
    if (take<kAny>(r, hit, t, lists.of<Cone>().id[i]))
      return true;
  }
  return false;
}

template <bool kAny, class Real>
bool test_lists(
    WalkedRay<Real>& r, const CellLists& lists, std::size_t cell, RayMailbox* box, Counters& n) {
  return (lists.of<Triangle>().first && test_triangles<kAny>(r, lists, cell, box, n)) ||
         (lists.of<Sphere>().first && test_spheres<kAny>(r, lists, cell, box, n)) ||
         (lists.of<Cone>().first && test_cones<kAny>(r, lists, cell, box, n));
}

template <bool kAny, class Real>
bool test_planes(WalkedRay<Real>& r, const GeometryView& g, Counters& n) {
  for (std::uint32_t p = 0; p < g.of<Plane>().count; ++p) {
    ++n.tests[kNumber<Plane>];
    Real t = 0;
    const bool hit = hit_plane<Real>({r.org[0], r.org[1], r.org[2]},
                                     {r.dir[0], r.dir[1], r.dir[2]},
                                     r.t_min,
                                     {g.of<Plane>().fields.point[0][p],
                                      g.of<Plane>().fields.point[1][p],
                                      g.of<Plane>().fields.point[2][p]},
                                     {g.of<Plane>().fields.normal[0][p],
                                      g.of<Plane>().fields.normal[1][p],
                                      g.of<Plane>().fields.normal[2][p]},
                                     t);
    if (take<kAny>(r, hit, t, p))
      return true;
  }
  return false;
}

template <bool kAny, class Real>
bool walk_grid(WalkedRay<Real>& r, const GridView& g, RayMailbox* box, Counters& n) {
  const GridRay ray = to_grid(g, r.near_org, r.dir);
  double t0 = r.near_t_min;
  double t1 = r.near_best;
  clip_to_grid(g, ray, t0, t1);
  if (!(t0 <= t1))
    return false;
  int at[3];
  int step[3];
  double next[3];
  const auto plane = [&](int a) { return (at[a] + (step[a] > 0 ? 1 : 0) - ray.p[a]) * ray.iq[a]; };
  for (int a = 0; a < 3; ++a) {
    at[a] = clamp_cell(ray.p[a] + t0 * ray.q[a], g.n[a]);
    step[a] = ray.q[a] > 0 ? 1 : -1;
    next[a] = plane(a);
  }
  const int most = g.n[0] + g.n[1] + g.n[2] + 3;
  for (int s = 0; s < most; ++s) {
    ++n.visits;
    const std::size_t cell = at[0] + static_cast<std::size_t>(g.n[0]) *
                                         (at[1] + static_cast<std::size_t>(g.n[1]) * at[2]);
    if (test_lists<kAny>(r, g.lists, cell, box, n))
      return true;
    const int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (r.near_best <= next[a] || !(next[a] <= t1))
      return false;
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= g.n[a])
      return false;
    next[a] = plane(a);
  }
  return false;
}

/// All cells of a grid, one after the other.
template <bool kAny, class Real>
bool test_cells(WalkedRay<Real>& r, const GridView& g, RayMailbox* box, Counters& n) {
  const std::size_t cells = static_cast<std::size_t>(g.n[0]) * static_cast<std::size_t>(g.n[1]) *
                            static_cast<std::size_t>(g.n[2]);
  for (std::size_t cell = 0; cell < cells; ++cell)
    if (test_lists<kAny>(r, g.lists, cell, box, n))
      return true;
  return false;
}

/// False when the ray can meet nothing.
template <class Real>
bool load_ray(const Ray& ray, WalkedRay<Real>& r) {
  const float org[3] = {ray.org.x, ray.org.y, ray.org.z};
  const float d[3] = {ray.dir.x, ray.dir.y, ray.dir.z};
  for (int a = 0; a < 3; ++a) {
    r.org[a] = r.near_org[a] = org[a];
    r.dir[a] = d[a];
  }
  r.t_min = r.near_t_min = ray.t_min;
  r.best = r.near_best = ray.t_max;
  if (sizeof(Real) == sizeof(double) && ray.t_max == kInfinity)
    r.best = static_cast<Real>(kEndOfFloats);
  const float dd = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  const Vec3<Real> dir{d[0], d[1], d[2]};
  r.inv_dd = 1 / dot(dir, dir);
  const int k = r.axis = shear_axis(d[0], d[1], d[2]);
  const Real along = d[k];
  r.shear = {d[kNextAxis[k]] / along, d[kPreviousAxis[k]] / along, 1 / along};
  return ((((org[0] + org[1]) + (org[2] + dd)) + 1 / dd) * 0 == 0) && r.best > r.t_min;
}

/// Moves a ray that starts far from everything to where it comes near, see approach(). Returns
/// whether its search is over: a plane that it meets before that hides all else.
template <class Real>
bool bring_near(const SceneView& scene, WalkedRay<Real>& r) {
  const float from[3] = {r.near_org[0], r.near_org[1], r.near_org[2]};
  const double shift = approach(scene, r.near_org, r.dir);
  if (!(shift > 0))
    return false;
  if (WalkedRay<Real>::kInDouble) {
    r.shift = static_cast<Real>(shift);
    r.near_t_min = not_above(r.t_min - shift);
    r.near_best = not_below(r.best - shift);
    return false;
  }
  const bool met = r.id != kNoPrimitive;
  const double best = met ? plane_t(scene.geometry, r.id, from, r.dir) : r.best;
  if (met && !(best > shift))
    return true;
  r.shift = static_cast<Real>(shift);
  r.t_min = r.near_t_min = static_cast<float>(r.t_min - shift);
  r.best = r.near_best = static_cast<float>(best - shift);
  for (int a = 0; a < 3; ++a)
    r.org[a] = r.near_org[a];
  return false;
}

template <bool kAny, class Real>
void trace_ray(const SceneView& scene, WalkedRay<Real>& r, RayMailbox* box, Counters& n) {
  if (test_planes<kAny>(r, scene.geometry, n))
    return;
  if (bring_near(scene, r) || test_lists<kAny>(r, scene.outside, 0, nullptr, n))
    return;
  for (int i = 0; i < scene.grid_count; ++i) {
    const GridView& g = scene.grids[i];
    if (serves(g, r.near_org) ? walk_grid<kAny>(r, g, box, n)
                              : g.serves == Serves::kNearAndAfar && test_cells<kAny>(r, g, box, n))
      return;
  }
}

/// Ray i of a view.
inline Ray ray_of(const Rays& rays, std::size_t i) {
  const auto k = static_cast<std::ptrdiff_t>(i);
  const auto vector = [&](const float* const(&of)[3], std::ptrdiff_t stride) {
    return Float3{of[0][k * stride], of[1][k * stride], of[2][k * stride]};
  };
  return {vector(rays.org, rays.org_stride),
          vector(rays.dir, rays.dir_stride),
          rays.t_min ? rays.t_min[k * rays.t_stride] : 0,
          rays.t_max ? rays.t_max[k * rays.t_stride] : kInfinity};
}

/// Calls `take(i, ray, r)` for each ray of a view: as it came, and as it was walked.
template <bool kAny, class Real, class Take>
void trace_reference(
    const SceneView& scene, const Rays& rays, bool mailbox, Counters& n, const Take& take) {
  RayMailbox box;
  for (std::size_t i = 0; i < rays.count; ++i) {
    const Ray ray = ray_of(rays, i);
    WalkedRay<Real> r;
    if (load_ray(ray, r)) {
      box.clear();
      trace_ray<kAny>(scene, r, mailbox ? &box : nullptr, n);
    }
    take(static_cast<std::ptrdiff_t>(i), ray, r);
  }
}

/// What the loops of a Variant do, see VariantLoops.
template <class Real>
void closest(
    const SceneView& scene, const Rays& rays, bool mailbox, Counters& n, const Hits& hits) {
  constexpr bool kInDouble = WalkedRay<Real>::kInDouble;
  const auto store = [&](std::ptrdiff_t i, const Ray& ray, const WalkedRay<Real>& r) {
    const bool met = r.id != kNoPrimitive;
    const float shift = static_cast<float>(r.shift);
    const auto answer = [&](auto t) {
      return met ? strictly_between(t, ray.t_min, ray.t_max) : ray.t_max;
    };
    if (hits.t)
      hits.t[i * hits.stride] = answer(static_cast<float>(kInDouble ? r.best : r.best + shift));
    if (hits.id)
      hits.id[i * hits.stride] = r.id;
    if (hits.t_double)
      hits.t_double[i] = answer(kInDouble ? double{r.best} : double{r.best} + shift);
  };
  trace_reference<false, Real>(scene, rays, mailbox, n, store);
}
template <class Real>
void occluded(
    const SceneView& scene, const Rays& rays, bool mailbox, Counters& n, std::uint8_t* blocked) {
  trace_reference<true, Real>(
      scene, rays, mailbox, n, [&](std::ptrdiff_t i, const Ray&, const WalkedRay<Real>& r) {
        blocked[i] = r.id != kNoPrimitive;
      });
}

}  // namespace grelha::GRELHA_ISA
