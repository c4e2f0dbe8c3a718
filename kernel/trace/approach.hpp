#pragma once
// Rays that start far from everything finite are brought near before they walk.

#include "kernel/grid/view.hpp"
#include "kernel/walk/packet.hpp"

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
/// from its plane is taken again in double, lest that hides what stands before it. One that met a
/// plane on the way meets nothing finite before it: that ray stays, and its search is over.
/// Returns whether it moves.
inline bool move_near(const SceneView& scene, Packet<InFloat>& p, int i, double shift) {
  const float from[3] = {p.org[0][i], p.org[1][i], p.org[2][i]};
  const float dir[3] = {p.dir[0][i], p.dir[1][i], p.dir[2][i]};
  const std::uint32_t plane = id_of(p.id[i]);
  const bool met = plane != kNoPrimitive && p.best[i] > -kInfinity;
  const double best = met ? plane_t(scene.geometry, plane, from, dir) : p.best[i];
  if (met && !(best > shift)) {
    p.t_min[i] = p.best[i];
    return false;
  }
  p.t_min[i] = static_cast<float>(p.t_min[i] - shift);
  p.best[i] = static_cast<float>(best - shift);
  p.shift[i] = static_cast<float>(shift);
  return true;
}
inline bool move_near(const SceneView&, Packet<InDouble>& p, int i, double shift) {
  p.shift[i] = shift;
  p.t_min[i] = not_above(p.after[i] - shift);
  p.best[i] = not_below(p.nearest[i] - shift);
  return true;
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
      if (i + k >= p.size || !moves(to.shift[k]) || !move_near(scene, p, i + k, to.shift[k]))
        return;
      for (int a = 0; a < 3; ++a)
        p.org[a][i + k] = to.org[a][k];
    });
  }
}

}  // namespace grelha::GRELHA_ISA
