#pragma once
// One ray, by itself or in a packet, and the values that tests read from either.

#include "kernel/base/lanes_four.hpp"
#include "kernel/traverse/packet.hpp"

namespace grelha::GRELHA_ISA {

/// A ray by itself.
struct Single : RayFrame {
  float org[3], dir[3], t_min;
  float best, low;  ///< t of the hit so far lies from low to best; both are t_max without one
  std::uint32_t id;
  int axis;  ///< of the shear
  /// inverse of the direction; this and the next fields with triangles only, with a spare element
  float inverse[4];
  /// the side of a box that the ray hits first, along each axis; the other is 3 elements on or back
  int near[4];
  float inv_dd, inv_length;
  float shear[4];                        ///< and one element more
  float unit;                            ///< length that t is counted in
  float given_t_min, given_t_max;        ///< in the caller's lengths
  const TriangleBlock* block = nullptr;  ///< of the last triangle that came first
};

/// A ray of a packet.
struct PacketRay {
  Packet& p;
  int i;
};

/// Values that tests read from a ray.
inline float origin(const Single& r, int axis) {
  return r.org[axis];
}
inline float direction(const Single& r, int axis) {
  return r.dir[axis];
}
inline float t_min_of(const Single& r) {
  return r.t_min;
}
inline float best_of(const Single& r) {
  return r.best;
}
inline float low_of(const Single& r) {
  return r.low;
}
inline float shear_of(const Single& r, int which) {
  return r.shear[which];
}
inline float inverse_of(const Single& r, int axis) {
  return r.inverse[axis];
}
inline int near_side(const Single& r, int axis) {
  return r.near[axis];
}
inline int axis_of(const Single& r) {
  return r.axis;
}
inline std::uint32_t id_of(const Single& r) {
  return r.id;
}
inline const RayFrame& frame_of(const Single& r) {
  return r;
}
inline void set_hit(Single& r, const CrossingSpan& t, std::uint32_t id) {
  r.best = t.hi;
  r.low = t.lo;
  r.id = id;
}
inline int index_of(const Single&) {
  return 0;
}

inline float origin(const PacketRay& r, int axis) {
  return r.p.org[axis][r.i];
}
inline float direction(const PacketRay& r, int axis) {
  return r.p.dir[axis][r.i];
}
inline float t_min_of(const PacketRay& r) {
  return r.p.t_min[r.i];
}
inline float best_of(const PacketRay& r) {
  return r.p.best[r.i];
}
inline float low_of(const PacketRay& r) {
  return r.p.low[r.i];
}
inline float shear_of(const PacketRay& r, int which) {
  return r.p.shear[which][r.i];
}
inline float inverse_of(const PacketRay& r, int axis) {
  return r.p.inverse[axis][r.i];
}
inline int near_side(const PacketRay& r, int axis) {
  return static_cast<int>(r.p.near[axis][r.i]);
}
inline int axis_of(const PacketRay& r) {
  return static_cast<int>(r.p.axis[r.i]);
}
inline std::uint32_t id_of(const PacketRay& r) {
  return id_of(r.p.id[r.i]);
}
inline const RayFrame& frame_of(const PacketRay& r) {
  return r.p;
}
inline void set_hit(const PacketRay& r, const CrossingSpan& t, std::uint32_t id) {
  r.p.best[r.i] = t.hi;
  r.p.low[r.i] = t.lo;
  r.p.id[r.i] = bits_of(id);
}
inline int index_of(const PacketRay& r) {
  return r.i;
}
inline float inverse_square(const Single& r) {
  return r.inv_dd;
}
inline float inverse_square(const PacketRay& r) {
  return r.p.inv_dd[r.i];
}
inline float inverse_length(const Single& r) {
  return r.inv_length;
}
inline float inverse_length(const PacketRay& r) {
  return r.p.inv_length[r.i];
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
  r.t_min = r.given_t_min = ray.t_min;
  r.best = r.given_t_max = ray.t_max;
  r.unit = length_unit(dir);
  if (r.unit == 1) [[likely]]
    return dir;
  r.best = r.given_t_max = finite_end(r.unit, ray.t_max);
  count_in(r.unit, r.t_min, r.best);
  return {dir.x / r.unit, dir.y / r.unit, dir.z / r.unit};
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
  r.org[0] = org.x;
  r.org[1] = org.y;
  r.org[2] = org.z;
  r.dir[0] = d.x;
  r.dir[1] = d.y;
  r.dir[2] = d.z;
  r.low = r.best;
  r.id = kNoPrimitive;
  r.given = {{r.org, r.org + 1, r.org + 2},
             {r.dir, r.dir + 1, r.dir + 2},
             &r.given_t_min,
             &r.given_t_max,
             &r.unit};
  r.inv_dd = 1 / dd;
  r.inv_length = inverse_length(d, r.inv_dd);
  r.axis = 0;
  if (any_triangles) {
    r.axis = largest_axis(d.x, d.y, d.z);
    const Vec3<float> q = permute_axes<float>(static_cast<float>(r.axis), d);
    store(r.shear, Four{q.x, q.y, 1, 1} / four(q.z));
    set_inverse(r, d);
  }
  return true;
}

}  // namespace grelha::GRELHA_ISA
