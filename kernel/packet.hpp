#pragma once
// Rays side by side, and the tests of all of them against one primitive (SIMD over rays).

#include "kernel/cone.hpp"
#include "kernel/plane.hpp"
#include "kernel/sphere.hpp"
#include "kernel/stats.hpp"
#include "kernel/triangle.hpp"
#include "kernel/view.hpp"

namespace grelha::GRELHA_ISA {

/// Most rays in a packet. A word has a bit for each group of lanes.
inline constexpr int kPacket = kWidth<Lanes> == 1 ? 64 : 256;
inline constexpr float kInfinity = __builtin_inff();

/// What a trace counts, by the kind of its tests.
struct Counters {
  std::uint64_t visits = 0, sphere = 0, triangle = 0, cone = 0, plane = 0;
  std::uint64_t formed = 0, fell_back = 0, issued = 0, busy = 0;
};

/// Up to kPacket rays as arrays. A ray searches (t_min, best); best <= t_min switches it off. Places between `size` and the
/// end of the last group are switched off. `id` holds the bits of the nearest primitive so far.
struct Packet {
  alignas(64) float org[3][kPacket];
  alignas(64) float dir[3][kPacket];
  alignas(64) float inv_dd[kPacket];
  alignas(64) float t_min[kPacket];
  alignas(64) float best[kPacket];
  alignas(64) float start[kPacket];       ///< t from which a grid is still to be searched
  alignas(64) float id[kPacket];
  alignas(64) float shear[3][kPacket];
  alignas(64) float axis[kPacket];        ///< of the shear: 0, 1 or 2
  alignas(64) float shift[kPacket];       ///< how far a ray was brought near, in t; set only when `moved`
  bool moved = false;
  int group_axis[kPacket / kWidth<Lanes>];  ///< the axis all rays of a group share, or -1
  int size, groups;
  std::uint64_t live;  ///< bit g: group g has a ray that still searches
};

inline std::uint32_t id_of(float bits) { return static_cast<std::uint32_t>(float_bits(bits)); }
inline float bits_of(std::uint32_t id) { return bits_float(static_cast<std::int32_t>(id)); }

/// A component of a direction below this meets none of its planes on any way that counts, and taken instead of it never makes NaN:
/// over a scene the ray strays by 1e-12 of it, where float strays by 1e-7.
template <class Real>
inline Real least_headway(const Real& x, const Real& y, const Real& z) {
  return Real(1e-12f) * greater(greater(magnitude(x), magnitude(y)), magnitude(z));
}
inline Lanes least_headway(const Packet& p, int i) {
  return least_headway(load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i));
}

/// Completes a packet whose org, dir, t_min, best and size are set.
inline void prepare(Packet& p, bool any_triangles) {
  constexpr int w = kWidth<Lanes>;
  p.groups = (p.size + w - 1) / w;
  p.live = ~std::uint64_t{0} >> (64 - p.groups);
  for (int i = p.size; i < p.groups * w; ++i) {  // repeat the last ray, switched off
    for (int a = 0; a < 3; ++a) p.org[a][i] = p.org[a][p.size - 1], p.dir[a][i] = p.dir[a][p.size - 1];
    p.t_min[i] = 0, p.best[i] = -kInfinity;
  }
  const float no_id = bits_of(kNoPrimitive);
  for (int g = 0; g < p.groups; ++g) {
    const int i = g * w;
    const Vec3<Lanes> d{load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i)};
    const Vec3<Lanes> o{load<Lanes>(p.org[0] + i), load<Lanes>(p.org[1] + i), load<Lanes>(p.org[2] + i)};
    const Lanes dd = dot(d, d), inv = Lanes(1) / dd;
    store(p.inv_dd + i, inv);
    store(p.id + i, Lanes(no_id));
    // NaN and infinity times zero are NaN; a ray with one, or without a direction, meets nothing.
    const Mask<Lanes> sound = ((o.x + o.y) + (o.z + dd) + inv) * Lanes(0) == Lanes(0);
    store(p.best + i, select(sound, load<Lanes>(p.best + i), Lanes(-kInfinity)));
    if (!any_triangles) continue;
    const Lanes ax = magnitude(d.x), ay = magnitude(d.y), az = magnitude(d.z);
    const Mask<Lanes> x_first = both(ax >= ay, ax >= az), y_first = ay >= az;
    const Lanes axis = select(x_first, Lanes(0), select(y_first, Lanes(1), Lanes(2)));
    const Lanes dz = select(x_first, d.x, select(y_first, d.y, d.z));
    const Lanes dx = select(x_first, d.y, select(y_first, d.z, d.x));
    const Lanes dy = select(x_first, d.z, select(y_first, d.x, d.y));
    store(p.axis + i, axis);
    store(p.shear[0] + i, dx / dz), store(p.shear[1] + i, dy / dz), store(p.shear[2] + i, Lanes(1) / dz);
    p.group_axis[g] = none(axis != Lanes(p.axis[i])) ? static_cast<int>(p.axis[i]) : -1;
  }
}

/// Notes hits of one group against one primitive: nearer wins, then the lower id. With kAny a hit ends the ray's search.
template <bool kAny>
inline void note(Packet& p, int i, const Mask<Lanes>& hit, const Lanes& t, std::uint32_t id) {
  const Lanes best = load<Lanes>(p.best + i);
  if constexpr (kAny) {
    const Mask<Lanes> closer = both(hit, t < best);
    if (none(closer)) return;
    store(p.best + i, select(closer, Lanes(-kInfinity), best));
    store(p.id + i, select(closer, Lanes(bits_of(id)), load<Lanes>(p.id + i)));
  } else {
    const Mask<Lanes> candidate = both(hit, t <= best);
    if (none(candidate)) return;
    const Mask<Lanes> tie = both(candidate, t == best);
    if (none(tie)) {
      store(p.best + i, select(candidate, t, best));
      store(p.id + i, select(candidate, Lanes(bits_of(id)), load<Lanes>(p.id + i)));
      return;
    }
    float at[kWidth<Lanes>];
    store(at, t);
    const unsigned lanes = bits(candidate), ties = bits(tie);
    for (int k = 0; k < kWidth<Lanes>; ++k) {
      if (!(lanes >> k & 1)) continue;
      const std::uint32_t held = id_of(p.id[i + k]);
      if ((ties >> k & 1) && (held == kNoPrimitive || held <= id)) continue;
      p.best[i + k] = at[k], p.id[i + k] = bits_of(id);
    }
  }
}

/// Runs `test(i)` for the first lane i of every live group.
template <class Test>
inline void each_live_group(const Packet& p, const Test& test) {
  for (std::uint64_t left = p.live; left != 0; left &= left - 1) {
    const int g = __builtin_ctzll(left);
    test(g * kWidth<Lanes>, g);
  }
}

inline void count_lanes(const Packet& p, Counters& n, std::uint64_t& tests) {
  each_live_group(p, [&](int i, int) {
    n.issued += kWidth<Lanes>;
    const unsigned on = bits(load<Lanes>(p.best + i) > load<Lanes>(p.t_min + i));
    n.busy += static_cast<unsigned>(__builtin_popcount(on));
    tests += static_cast<unsigned>(__builtin_popcount(on));
  });
}

inline Vec3<Lanes> origin(const Packet& p, int i) {
  return {load<Lanes>(p.org[0] + i), load<Lanes>(p.org[1] + i), load<Lanes>(p.org[2] + i)};
}
inline Vec3<Lanes> direction(const Packet& p, int i) {
  return {load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i)};
}

template <bool kAny>
inline void test_sphere(Packet& p, float x, float y, float z, float r, std::uint32_t id) {
  const Vec3<Lanes> center{Lanes(x), Lanes(y), Lanes(z)};
  const Lanes radius(r);
  each_live_group(p, [&](int i, int) {
    Lanes t(0);
    const Mask<Lanes> hit = hit_sphere<Lanes>(origin(p, i), direction(p, i), load<Lanes>(p.inv_dd + i),
                                              load<Lanes>(p.t_min + i), center, radius, t);
    note<kAny>(p, i, hit, t, id);
  });
}

template <bool kAny>
inline void test_cone(Packet& p, const float* const (&c)[10], std::uint32_t at, std::uint32_t id) {
  const ConeSide<Lanes> side{{Lanes(c[0][at]), Lanes(c[1][at]), Lanes(c[2][at])},
                             {Lanes(c[3][at]), Lanes(c[4][at]), Lanes(c[5][at])},
                             Lanes(c[6][at]), Lanes(c[7][at]), Lanes(c[8][at]), Lanes(c[9][at])};
  each_live_group(p, [&](int i, int) {
    Lanes t(0);
    const Mask<Lanes> hit = hit_cone<Lanes>(origin(p, i), direction(p, i), load<Lanes>(p.inv_dd + i),
                                            load<Lanes>(p.t_min + i), side, t);
    note<kAny>(p, i, hit, t, id);
  });
}

template <bool kAny>
inline void test_plane(Packet& p, const Vec3<float>& point, const Vec3<float>& normal, std::uint32_t id) {
  const Vec3<Lanes> q{Lanes(point.x), Lanes(point.y), Lanes(point.z)};
  const Vec3<Lanes> m{Lanes(normal.x), Lanes(normal.y), Lanes(normal.z)};
  each_live_group(p, [&](int i, int) {
    Lanes t(0);
    const Mask<Lanes> hit = hit_plane<Lanes>(origin(p, i), direction(p, i), load<Lanes>(p.t_min + i), q, m, t);
    note<kAny>(p, i, hit, t, id);
  });
}

/// Corners and origin of a group whose rays stand on different axes, permuted lane by lane.
inline Vec3<Lanes> permuted(const Lanes& axis, const Vec3<Lanes>& v) {
  const Mask<Lanes> x = axis == Lanes(0), y = axis == Lanes(1);
  return {select(x, v.y, select(y, v.z, v.x)), select(x, v.z, select(y, v.x, v.y)), select(x, v.x, select(y, v.y, v.z))};
}

template <bool kAny>
inline void test_triangle(Packet& p, const float (&a)[3], const float (&b)[3], const float (&c)[3], std::uint32_t id) {
  each_live_group(p, [&](int i, int g) {
    const Shear<Lanes> shear{load<Lanes>(p.shear[0] + i), load<Lanes>(p.shear[1] + i), load<Lanes>(p.shear[2] + i)};
    const Lanes t_min = load<Lanes>(p.t_min + i);
    Lanes t(0);
    Mask<Lanes> hit;
    if (const int k = p.group_axis[g]; k >= 0) {
      const int kx = k == 2 ? 0 : k + 1, ky = k == 0 ? 2 : k - 1;
      const Vec3<Lanes> org{load<Lanes>(p.org[kx] + i), load<Lanes>(p.org[ky] + i), load<Lanes>(p.org[k] + i)};
      hit = hit_triangle<Lanes>(org, shear, t_min, {Lanes(a[kx]), Lanes(a[ky]), Lanes(a[k])},
                                {Lanes(b[kx]), Lanes(b[ky]), Lanes(b[k])}, {Lanes(c[kx]), Lanes(c[ky]), Lanes(c[k])}, t);
    } else {
      const Lanes axis = load<Lanes>(p.axis + i);
      hit = hit_triangle<Lanes>(permuted(axis, origin(p, i)), shear, t_min,
                                permuted(axis, {Lanes(a[0]), Lanes(a[1]), Lanes(a[2])}),
                                permuted(axis, {Lanes(b[0]), Lanes(b[1]), Lanes(b[2])}),
                                permuted(axis, {Lanes(c[0]), Lanes(c[1]), Lanes(c[2])}), t);
    }
    note<kAny>(p, i, hit, t, id);
  });
}

}  // namespace grelha::GRELHA_ISA
