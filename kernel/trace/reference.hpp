#pragma once
// The report's way, kept as the reference all others are measured against: one ray, one primitive
// at a time, cell by cell. Amanatides & Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing",
// 1987, with two mends: plane distances come from the plane's index instead of adding up, and
// mailboxes stand with the ray instead of the primitive.

#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

/// The primitives a ray has met (hashed; may forget, never wrong).
struct RayMailbox {
  static constexpr unsigned kSize = 64;
  std::uint32_t held[kSize];
  bool seen(std::uint32_t id) {
    std::uint32_t& slot = held[id % kSize];
    if (slot == id)
      return true;
    slot = id;
    return false;
  }
};

template <bool kAny>
inline bool take(Single& r, bool hit, Number t, std::uint32_t id) {
  if (!hit)
    return false;
  const Number best = tested_best(r);
  if (kAny) {
    if (!(t < best))
      return false;
    set_best(r, -kInfinity);
    r.id = id;
    return true;
  }
  if (t < best || (t == best && r.id != kNoPrimitive && id < r.id)) {
    set_best(r, t);
    r.id = id;
  }
  return false;
}

template <bool kAny>
inline bool reference_cell(
    Single& r, const CellLists& lists, std::size_t cell, RayMailbox* box, Counters& n) {
  const auto& from = tested_org(r);
  const Vec3<Number> org{from[0], from[1], from[2]}, dir{r.dir[0], r.dir[1], r.dir[2]};
  if (lists.triangle_first) {
    const int k = r.axis, kx = kNextAxis[k], ky = kPreviousAxis[k];
    const Shear<Number> shear{r.shear[0], r.shear[1], r.shear[2]};
    for (std::uint32_t b = lists.triangle_first[cell]; b < lists.triangle_first[cell + 1]; ++b) {
      const TriangleBlock& block = lists.triangles[b];
      for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i) {
        if (box && box->seen(block.id[i]))
          continue;
        ++n.triangle;
        Number t = 0;
        const auto ray_and_triangle = [&] {
          return RayAndTriangle<Number>{{from[kx], from[ky], from[k]},
                                        {r.dir[kx], r.dir[ky], r.dir[k]},
                                        {{block.a[kx][i], block.a[ky][i], block.a[k][i]},
                                         {block.b[kx][i], block.b[ky][i], block.b[k][i]},
                                         {block.c[kx][i], block.c[ky][i], block.c[k][i]}}};
        };
        const Number t_min = tested_t_min(r);
        const Number t_max = kInfinity;  // exactly where, whatever is met already
        const bool hit = hit_triangle<false>(ray_and_triangle, shear, t_min, t_max, t);
        if (take<kAny>(r, hit, t, block.id[i]))
          return true;
      }
    }
  }
  if (lists.sphere_first)
    for (std::uint32_t i = lists.sphere_first[cell]; i < lists.sphere_first[cell + 1]; ++i) {
      if (box && box->seen(lists.sphere_id[i]))
        continue;
      ++n.sphere;
      Number t = 0;
      const bool hit = hit_sphere<Number>(org,
                                          dir,
                                          r.inv_dd,
                                          tested_t_min(r),
                                          {lists.sx[i], lists.sy[i], lists.sz[i]},
                                          lists.sr[i],
                                          t);
      if (take<kAny>(r, hit, t, lists.sphere_id[i]))
        return true;
    }
  if (lists.cone_first)
    for (std::uint32_t i = lists.cone_first[cell]; i < lists.cone_first[cell + 1]; ++i) {
      if (box && box->seen(lists.cone_id[i]))
        continue;
      ++n.cone;
      const auto& c = lists.cone;
      Number t = 0;
      const bool hit = hit_cone<Number>(org,
                                        dir,
                                        r.inv_dd,
                                        r.t_min,
                                        {{c[0][i], c[1][i], c[2][i]},
                                         {c[3][i], c[4][i], c[5][i]},
                                         c[6][i],
                                         c[7][i],
                                         c[8][i],
                                         c[9][i]},
                                        t);
      if (take<kAny>(r, hit, t, lists.cone_id[i]))
        return true;
    }
  return false;
}

template <bool kAny>
inline bool reference_walk(const GridView& g, Single& r, RayMailbox* box, Counters& n) {
  const GridRay ray = to_grid(g, r.org, r.dir);
  double t0 = r.t_min, t1 = r.best;
  clip_to_grid(g, ray, t0, t1);
  if (!(t0 <= t1))
    return false;
  int at[3], step[3];
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
    if (reference_cell<kAny>(r, g.lists, cell, box, n))
      return true;
    const int a = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (r.best <= next[a] || !(next[a] <= t1))
      return false;
    at[a] += step[a];
    if (at[a] < 0 || at[a] >= g.n[a])
      return false;
    next[a] = plane(a);
  }
  return false;
}

template <bool kAny>
inline void trace_reference(
    const SceneView& scene, const RayArrays& rays, int count, bool mailbox, Counters& n) {
  RayMailbox box;
  for (int i = 0; i < count; ++i) {
    Single r;
    r.org[0] = rays.ox[i];
    r.org[1] = rays.oy[i];
    r.org[2] = rays.oz[i];
    r.dir[0] = rays.dx[i];
    r.dir[1] = rays.dy[i];
    r.dir[2] = rays.dz[i];
    const float dd = (r.dir[0] * r.dir[0] + r.dir[1] * r.dir[1]) + r.dir[2] * r.dir[2];
    r.t_min = rays.t_min[i];
    r.best = rays.t[i];
    r.id = kNoPrimitive;
    rays.id[i] = kNoPrimitive;
    if (!((((r.org[0] + r.org[1]) + (r.org[2] + dd)) + 1 / dd) * 0 == 0) || !(r.best > r.t_min))
      continue;
    const Vec3<Number> dir{r.dir[0], r.dir[1], r.dir[2]};
    r.inv_dd = 1 / dot(dir, dir);
#ifdef GRELHA_DOUBLE
    for (int a = 0; a < 3; ++a)
      r.from[a] = r.org[a];
    r.after = r.t_min;
    r.nearest = r.best;
    r.shift = 0;
#endif
    const int k = r.axis = shear_axis(r.dir[0], r.dir[1], r.dir[2]), kx = k == 2 ? 0 : k + 1,
              ky = k == 0 ? 2 : k - 1;
    const Number along = r.dir[k];
    r.shear[0] = r.dir[kx] / along;
    r.shear[1] = r.dir[ky] / along;
    r.shear[2] = 1 / along;
    if (mailbox)
      __builtin_memset(box.held, 0xFF, sizeof box.held);
    RayMailbox* const m = mailbox ? &box : nullptr;
    const GeometryView& g = scene.geometry;
    bool done = false;
    for (std::uint32_t p = 0; p < g.plane_count && !done; ++p) {
      ++n.plane;
      Number t = 0;
      const bool hit = hit_plane<Number>({r.org[0], r.org[1], r.org[2]},
                                         dir,
                                         r.t_min,
                                         {g.px[p], g.py[p], g.pz[p]},
                                         {g.pnx[p], g.pny[p], g.pnz[p]},
                                         t);
      done = take<kAny>(r, hit, t, p);
    }
    [[maybe_unused]] const float from[3] = {r.org[0], r.org[1], r.org[2]};
    Number moved = 0;
    if (const double shift = done ? 0 : approach(scene, r.org, r.dir); shift > 0) {
#ifdef GRELHA_DOUBLE
      r.shift = shift, r.t_min = not_above(r.after - shift), r.best = not_below(r.nearest - shift);
#else
      rays.shift[i] = static_cast<float>(shift);
      const double best = r.id != kNoPrimitive ? plane_t(g, r.id, from, r.dir) : r.best;
      r.t_min = static_cast<float>(r.t_min - shift);
      r.best = static_cast<float>(best - shift);
#endif
      moved = static_cast<Number>(shift);
    }
    done = done || reference_cell<kAny>(r, scene.outside, 0, nullptr, n);
    for (int k2 = 0; k2 < scene.grid_count && !done; ++k2)
      if (serves(scene.grids[k2], r.org))
        done = reference_walk<kAny>(scene.grids[k2], r, m, n);
    rays.id[i] = r.id;
    rays.t[i] = static_cast<float>(tested_best(r) - (kDouble ? moved : 0));
    if (rays.whole)
      rays.whole[i] = kDouble ? tested_best(r) : unmoved(r.best, static_cast<float>(moved));
  }
}

}  // namespace grelha::GRELHA_ISA
