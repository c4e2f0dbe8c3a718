#pragma once
// The rays of a packet against a whole scene: planes and outside primitives first, then each grid
// with what t is left.

#include "kernel/trace/afar.hpp"
#include "kernel/trace/point_traversal.hpp"
#include "kernel/walk/packet_traversal.hpp"

namespace grelha::GRELHA_ISA {

/// More than any t by which a ray comes nearer.
inline constexpr double kFarthest = 1e300;

/// Whether a ray that starts far away comes nearer by that much of t.
inline bool moves(double shift) {
  return shift > 0 && shift < kFarthest;
}

/// Moves the origin of a ray that starts far from everything finite to where it comes near, in
/// double: from afar float tests would be off by eps times the distance, more than the grids allow
/// for. Returns the t it moved by. A function of ray and scene alone, so every way of tracing sees
/// the same ray.
inline double approach(const SceneView& scene, float (&org)[3], const float (&dir)[3]) {
  bool far = false;
  for (int a = 0; a < 3; ++a)
    far |= org[a] < scene.box_lo[a] - scene.reach || org[a] > scene.box_hi[a] + scene.reach;
  if (!far || !scene.finite)
    return 0;
  double dd = 0;
  double along = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = dir[a];
    const double c = .5 * (static_cast<double>(scene.box_lo[a]) + scene.box_hi[a]) - org[a];
    dd += d * d;
    along += c * d;
  }
  const double shift = along / dd - scene.reach / __builtin_sqrt(dd);
  if (!moves(shift))
    return 0;
  for (int a = 0; a < 3; ++a)
    org[a] = static_cast<float>(org[a] + shift * dir[a]);
  return shift;
}

/// Where a ray meets a plane, in double.
inline double plane_t(const GeometryView& g,
                      std::uint32_t i,
                      const float (&org)[3],
                      const float (&dir)[3]) {
  const double n[3] = {g.of<Plane>().fields.normal[0][i],
                       g.of<Plane>().fields.normal[1][i],
                       g.of<Plane>().fields.normal[2][i]},
               p[3] = {g.of<Plane>().fields.point[0][i],
                       g.of<Plane>().fields.point[1][i],
                       g.of<Plane>().fields.point[2][i]};
  double away = 0;
  double along = 0;
  for (int a = 0; a < 3; ++a) {
    away += n[a] * (p[a] - org[a]);
    along += n[a] * dir[a];
  }
  return away / along;
}

/// Moves ray i of a packet, which has met planes and nothing else yet, on by `shift`. How far it is
/// from its plane is taken again in double, lest that hides what stands before it.
inline void move_near(const SceneView& scene, Packet<InFloat>& p, int i, double shift) {
  const float from[3] = {p.org[0][i], p.org[1][i], p.org[2][i]};
  const float dir[3] = {p.dir[0][i], p.dir[1][i], p.dir[2][i]};
  const std::uint32_t plane = id_of(p.id[i]);
  const bool met = plane != kNoPrimitive && p.best[i] > -kInfinity;
  const double best = met ? plane_t(scene.geometry, plane, from, dir) : p.best[i];
  p.t_min[i] = static_cast<float>(p.t_min[i] - shift);
  p.best[i] = static_cast<float>(best - shift);
  p.shift[i] = static_cast<float>(shift);
}
inline void move_near(const SceneView&, Packet<InDouble>& p, int i, double shift) {
  p.shift[i] = shift;
  p.t_min[i] = not_above(p.after[i] - shift);
  p.best[i] = not_below(p.nearest[i] - shift);
}

/// Rays of a group that start further than `reach` from everything finite.
inline Mask<Lanes> starts_beyond(const SceneView& scene, float reach, const WalkingRays& p, int i) {
  Mask<Lanes> far = Lanes(0) != Lanes(0);
  for (int a = 0; a < 3; ++a) {
    const Lanes o = load<Lanes>(p.org[a] + i);
    const Mask<Lanes> before = o < Lanes(scene.box_lo[a] - reach);
    const Mask<Lanes> behind = o > Lanes(scene.box_hi[a] + reach);
    far = either(far, either(before, behind));
  }
  return far;
}

/// Where approach() would move the rays of a group of lanes to, whether they start far or not, and
/// their t from there.
struct Approached {
  double shift[kWidth<Lanes>];
  float org[3][kWidth<Lanes>];
  float t_min[kWidth<Lanes>], best[kWidth<Lanes>];
  float shift_f[kWidth<Lanes>];
  float moves[kWidth<Lanes>];  ///< 1: what starts far is moved

  [[gnu::always_inline]] Approached(const SceneView& scene, const WalkingRays& p, int i) {
    for (int k = 0; k < kWidth<Lanes>; k += kWidth<DoubleLanes>)
      move_part(scene, p, i, k);
  }

 private:
  [[gnu::always_inline]] void move_part(const SceneView& scene,
                                        const WalkingRays& p,
                                        int i,
                                        int k) {
    DoubleLanes dd(0);
    DoubleLanes along(0);
    DoubleLanes o[3], d[3];
    for (int a = 0; a < 3; ++a) {
      o[a] = take<DoubleLanes>(p.org[a] + i + k);
      d[a] = take<DoubleLanes>(p.dir[a] + i + k);
      const double middle = .5 * (static_cast<double>(scene.box_lo[a]) + scene.box_hi[a]);
      const DoubleLanes c = DoubleLanes(middle) - o[a];
      dd = dd + d[a] * d[a];
      along = along + c * d[a];
    }
    const DoubleLanes reach(static_cast<double>(scene.reach));
    const DoubleLanes by = along / dd - reach / square_root(dd);
    store(shift + k, by);
    store_narrow(t_min + k, take<DoubleLanes>(p.t_min + i + k) - by);
    store_narrow(best + k, take<DoubleLanes>(p.best + i + k) - by);
    store_narrow(shift_f + k, by);
    const DoubleLanes no(0);
    const auto moving = both(by > no, by < DoubleLanes(kFarthest));
    store_narrow(moves + k, select(moving, DoubleLanes(1), no));
    for (int a = 0; a < 3; ++a)
      store_narrow(org[a] + k, o[a] + by * d[a]);
  }
};

/// Whether there is anything that has no end.
inline bool any_infinite(const SceneView& scene) {
  bool some = false;
  InfiniteShapes::for_each([&]<class Shape>() { some |= scene.geometry.of<Shape>().count > 0; });
  return some;
}

/// Moves rays of a group that have met nothing.
[[gnu::always_inline]] inline void move_near(const SceneView& scene,
                                             Packet<InFloat>& p,
                                             int i,
                                             const Approached& to) {
  const Mask<Lanes> moving = load<Lanes>(to.moves) > Lanes(0);
  const Mask<Lanes> moved = both(starts_beyond(scene, scene.reach, p, i), moving);
  const auto take = [&](float* of, const float* from) {
    store(of + i, select(moved, load<Lanes>(from), load<Lanes>(of + i)));
  };
  take(p.t_min, to.t_min);
  take(p.best, to.best);
  take(p.shift, to.shift_f);
  for (int a = 0; a < 3; ++a)
    take(p.org[a], to.org[a]);
}

/// approach() for the rays of a packet that have met planes and nothing else yet. Planes come
/// first, since a ray that leaves a plane and is then moved along would meet it again, by as little
/// as the rounding of the way.
template <class In>
inline void bring_near(const SceneView& scene, Packet<In>& p) {
  p.moved = false;
  if (!scene.finite)
    return;
  for (int i = 0; i < p.size; i += kWidth<Lanes>) {
    const unsigned far = bits(starts_beyond(scene, scene.reach, p, i));
    if (far == 0)
      continue;
    if (!p.moved)
      for (typename In::Number& shift : p.shift)
        shift = 0;
    p.moved = true;
    const Approached to(scene, p, i);
    if constexpr (!In::kDouble)
      if (!any_infinite(scene)) {
        move_near(scene, p, i, to);
        continue;
      }
    each_bit(far, [&](int k) {
      if (i + k >= p.size || !moves(to.shift[k]))
        return;
      move_near(scene, p, i + k, to.shift[k]);
      for (int a = 0; a < 3; ++a)
        p.org[a][i + k] = to.org[a][k];
    });
  }
}

/// What stands in no grid since it has no end.
template <bool kAny, class In>
inline void test_infinite(const SceneView& scene, Packet<In>& p, Counters& n) {
  const GeometryView& g = scene.geometry;
  InfiniteShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::Arrays& all = g.of<Shape>();
    for (std::uint32_t i = 0; i < all.count; ++i)
      test_one<kAny, Shape>(p, all.fields, i, g.ids.begin(Shape::kKind) + i, n);
  });
}

/// The triangles that lie in no grid.
template <bool kAny, class In>
inline void test_outside(const Triangle::CellList& list, Packet<In>& p, Counters& n) {
  for (std::uint32_t b = 0; b < list.first[1]; ++b) {
    const TriangleBlock& block = list.blocks[b];
    for (int i = 0; i < kBlock && block.a[0][i] == block.a[0][i]; ++i)
      test_triangle<kAny>(p, triangle_of(block, i), block.id[i], n);
  }
}

/// The few primitives that lie in no grid, each against all rays.
template <bool kAny, class In>
inline void test_outside(const CellLists& lists, Packet<In>& p, Counters& n) {
  if (lists.of<Triangle>().first)
    test_outside<kAny>(lists.of<Triangle>(), p, n);
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    for (std::uint32_t i = 0; list.first && i < list.first[1]; ++i)
      test_one<kAny, Shape>(p, list.fields, i, list.id[i], n);
  });
}

/// Whether a grid is for a ray as it is; there may be another way for those from afar.
inline bool serves(const GridView& g, const float (&org)[3]) {
  return g.serves == Serves::kAll || starts_near(g, org) == (g.serves != Serves::kFar);
}

/// Sets where each ray is to be searched from in a grid: nowhere when the grid is not for it as it
/// is. False: it is for none.
inline bool start_in(const GridView& g, WalkingRays& p) {
  for (int i = 0; i < p.size; i += kWidth<Lanes>)
    store(p.start + i, load<Lanes>(p.t_min + i));
  if (g.serves == Serves::kAll)
    return true;
  bool some = false;
  each_live_group(p, [&](int i, int) {
    Mask<Lanes> away = Lanes(0) != Lanes(0);
    for (int a = 0; a < 3; ++a) {
      const Lanes o = load<Lanes>(p.org[a] + i);
      away = either(away, either(o<Lanes(g.near_lo[a]), o> Lanes(g.near_hi[a])));
    }
    const bool near = g.serves != Serves::kFar;
    const Lanes start = load<Lanes>(p.start + i), never(kInfinity);
    const Lanes from = select(away, near ? never : start, near ? start : never);
    some |= any(from < never);
    store(p.start + i, from);
  });
  return some;
}

/// Where a ray comes to a grid; infinity: never, or along a plane of it.
inline float entry(const GridView& g, const float (&org)[3], const float (&dir)[3], float t_min) {
  float t0 = t_min;
  float t1 = kInfinity;
  for (int a = 0; a < 3; ++a) {
    const float inv = 1 / dir[a];
    const float x = (g.lo_f[a] - org[a]) * inv;
    const float y = (g.hi_f[a] - org[a]) * inv;
    t0 = greater(lesser(x, y), t0);
    t1 = lesser(greater(x, y), t1);
  }
  return t0 <= t1 ? t0 : kInfinity;
}

/// The grids, for closest hits front to back as a ray meets them: what is met early cuts the others
/// short. Answers do not depend on it, since ties go to the lower id.
template <bool kAny, class Visit>
inline void each_grid(const SceneView& scene,
                      const float (&org)[3],
                      const float (&dir)[3],
                      float t_min,
                      const Visit& visit) {
  const int count = scene.grid_count;
  if (kAny || count < 2) {
    for (int g = 0; g < count; ++g)
      visit(scene.grids[g]);
    return;
  }
  int order[kMostGrids];
  float at[kMostGrids];
  for (int g = 0; g < count; ++g) {
    const float t = entry(scene.grids[g], org, dir, t_min);
    int i = g;
    for (; i > 0 && at[i - 1] > t; --i) {
      at[i] = at[i - 1];
      order[i] = order[i - 1];
    }
    at[i] = t;
    order[i] = g;
  }
  for (int i = 0; i < count; ++i)
    visit(scene.grids[order[i]]);
}
/// The same for a packet, as its first ray meets them.
template <bool kAny, class Visit>
inline void each_grid(const SceneView& scene, const WalkingRays& p, const Visit& visit) {
  const float org[3] = {p.org[0][0], p.org[1][0], p.org[2][0]};
  const float dir[3] = {p.dir[0][0], p.dir[1][0], p.dir[2][0]};
  each_grid<kAny>(scene, org, dir, p.t_min[0], visit);
}

template <bool kAny, class In>
inline void trace_alone(const SceneView& scene, Packet<In>& p, Counters& n) {
  for (int i = 0; i < p.size; ++i) {
    if (!(p.best[i] > p.t_min[i]))
      continue;
    PacketRay<In> r{p, i};
    test_cell<kAny>(r, scene.outside, 0, n);
  }
  each_grid<kAny>(scene, p, [&](const GridView& g) {
    if (start_in(g, p))
      walk_apart<kAny>(g, p, n);
    if (g.serves == Serves::kNearAndAfar)
      walk_from_afar<kAny>(g, p, n);
  });
}

/// Whether no ray of a packet starts further than `reach` from everything finite.
inline bool starts_within(const SceneView& scene, float reach, const WalkingRays& p) {
  Mask<Lanes> far = Lanes(0) != Lanes(0);
  for (int i = 0; i < p.size; i += kWidth<Lanes>)
    far = either(far, starts_beyond(scene, reach, p, i));
  return none(far);
}

/// Whether anything is in the way of the rays of a packet to a point; ray 0 is ray `first` of the
/// stream. False: some start too far away, and nothing is done.
[[gnu::noinline]] inline bool occlude_to_point(const SceneView& scene,
                                               Packet<InFloat>& p,
                                               const RaysToPoint& to,
                                               std::size_t first,
                                               Counters& n) {
  prepare_to_walk(p);
  const bool near = starts_within(scene, scene.reach, p);
  if (!near && !starts_within(scene, scene.point_reach, p))
    return false;
  test_infinite<true>(scene, p, n);
  p.moved = false;
  if (!near)
    bring_near(scene, p);
  const std::uint32_t* const leaves = to.leaves ? to.leaves + first : nullptr;
  PointSearch(scene.geometry, *to.grid, p, leaves, n).run();
  return true;
}

template <bool kAny, class In>
[[gnu::noinline]] void trace_packet(const SceneView& scene,
                                    Packet<In>& p,
                                    const TraceOptions& options,
                                    Counters& n) {
  const bool any_triangles = scene.geometry.of<Triangle>().count > 0;
  prepare(p, any_triangles);
  test_infinite<kAny>(scene, p, n);
  bring_near(scene, p);
  if (options.packet == 1)
    return trace_alone<kAny>(scene, p, n);
  test_outside<kAny>(scene.outside, p, n);
  each_grid<kAny>(scene, p, [&](const GridView& g) {
    if (start_in(g, p))
      traverse_packet<kAny>(g, p, options.packet, options.mailbox, n);
    if (g.serves == Serves::kNearAndAfar)
      walk_from_afar<kAny>(g, p, n);
  });
}

/// Where a ray of a packet met what it met, as t of the ray as it came.
inline float t_of(const Packet<InFloat>& p, int i) {
  return p.best[i] + (p.moved ? p.shift[i] : 0.f);
}
inline float t_of(const Packet<InDouble>& p, int i) {
  return static_cast<float>(p.nearest[i]);
}
/// The same before it is rounded.
inline double t_double(const Packet<InFloat>& p, int i) {
  return static_cast<double>(p.best[i]) + (p.moved ? p.shift[i] : 0.f);
}
inline double t_double(const Packet<InDouble>& p, int i) {
  return p.nearest[i];
}

}  // namespace grelha::GRELHA_ISA
