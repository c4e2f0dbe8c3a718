#pragma once
// One ray, by itself or in a packet.

#include "kernel/base/lanes_four.hpp"
#include "kernel/traverse/packet.hpp"

namespace grelha::GRELHA_ISA {

/// A ray by itself.
struct Single : RayGroup<1> {
  const TriangleBlock* block = nullptr;  ///< of the last triangle that came first
};

/// One ray of a group, as tests of one ray take it.
template <class Group>
struct RayOf {
  Group& rays;
  int i;
};
template <>
struct RayOf<Single> {
  Single& rays;
  static constexpr int i = 0;
};
using PacketRay = RayOf<Packet>;
using SingleRay = RayOf<Single>;

template <class Group>
inline std::uint32_t id_of(const RayOf<Group>& r) {
  return id_of(r.rays.id[r.i]);
}
template <class Group>
inline void set_hit(const RayOf<Group>& r, const CrossingSpan& t, std::uint32_t id) {
  r.rays.best[r.i] = t.hi;
  r.rays.low[r.i] = t.lo;
  r.rays.id[r.i] = bits_of(id);
}

/// Sets the inverse direction and the near sides of boxes, which tests of triangles also need.
inline void set_inverse(Single& r, const Vec3<float>& d) {
  const Four least = four(min_advance(d.x, d.y, d.z));
  const Four dir{d.x, d.y, d.z, 1};
  const Four inverse = four(1) / with_advance(dir, least);
  const FourInts low{0, 1, 2, 0};
  store(r.inverse, inverse);
  store(r.near, inverse < four(0) ? low + 3 : low);
}

/// The direction and the ends of a ray, as set_length_units() has them.
inline Vec3<float> set_length_unit(Single& r, const Ray& ray) {
  const Vec3<float> dir{ray.dir.x, ray.dir.y, ray.dir.z};
  const float unit = length_unit(dir);
  *r.unit = unit;
  *r.t_min = *r.given_t_min = ray.t_min;
  *r.best = *r.given_t_max = ray.t_max;
  if (unit == 1) [[likely]]
    return dir;
  *r.best = *r.given_t_max = finite_end(unit, ray.t_max);
  count_in(unit, *r.t_min, *r.best);
  return {dir.x / unit, dir.y / unit, dir.z / unit};
}

/// t of a hit between the ends of its search, which rounding may have taken it to.
inline float strictly_between(float t, float t_min, float t_max) {
  const float after = t > t_min ? t : next_above(t_min);
  return (after < t_max ? after : next_below(t_max)) + 0.f;  // no zero is -0
}

/// Prepares a ray by itself, as prepare(Packet&) does many. False: it hits nothing, r is
/// incomplete.
inline bool prepare(Single& r, const Ray& ray, bool any_triangles) {
  if (!(next_above(ray.t_min) < ray.t_max))
    return false;
  const Vec3<float> d = set_length_unit(r, ray);
  const Float3& org = ray.org;
  const float dd = dot(d, d);
  // NaN and infinity times zero are NaN
  const float sum = ((org.x + org.y) + (org.z + dd)) + 1 / dd;
  if (!(sum * 0 == 0))
    return false;
  *r.org[0] = org.x;
  *r.org[1] = org.y;
  *r.org[2] = org.z;
  *r.dir[0] = d.x;
  *r.dir[1] = d.y;
  *r.dir[2] = d.z;
  *r.low = *r.best;
  *r.id = bits_of(kNoPrimitive);
  r.given = {{r.org[0], r.org[1], r.org[2]},
             {r.dir[0], r.dir[1], r.dir[2]},
             r.given_t_min,
             r.given_t_max,
             r.unit};
  *r.inv_dd = 1 / dd;
  *r.inv_length = inverse_length(d, *r.inv_dd);
  *r.axis = 0;
  if (any_triangles) {
    *r.axis = static_cast<float>(largest_axis(d.x, d.y, d.z));
    const Vec3<float> q = permute_axes<float>(*r.axis, d);
    store(r.shear, Four{q.x, q.y, 1, 1} / four(q.z));
    set_inverse(r, d);
  }
  return true;
}

}  // namespace grelha::GRELHA_ISA
