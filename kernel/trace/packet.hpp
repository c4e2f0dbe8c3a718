#pragma once
// Rays side by side, and the tests of all of them against one primitive (SIMD over rays).

#include "kernel/shapes/cone.hpp"
#include "kernel/shapes/plane.hpp"
#include "kernel/shapes/sphere.hpp"
#include "grelha/stats.hpp"
#include "kernel/shapes/triangle.hpp"
#include "kernel/grid/view.hpp"

namespace grelha::GRELHA_ISA {

/// Most rays in a packet. A word has a bit for each group of lanes.
inline constexpr int kPacket = kWidth<Lanes> == 1 ? 64 : 256;
inline constexpr float kInfinity = __builtin_inff();

/// Up to kPacket rays as arrays. A ray searches (t_min, best); best <= t_min switches it off.
/// Places between `size` and the end of the last group are switched off. `id` holds the bits of the
/// nearest primitive so far.
struct Packet {
  alignas(64) float org[3][kPacket];
  alignas(64) float dir[3][kPacket];
  alignas(64) Number inv_dd[kPacket];
  alignas(64) float t_min[kPacket];
  alignas(64) float best[kPacket];
  alignas(64) float start[kPacket];  ///< t from which a grid is still to be searched
  alignas(64) float id[kPacket];
  alignas(64) Number shear[3][kPacket];
  alignas(64) float axis[kPacket];  ///< of the shear: 0, 1 or 2
  /// how far a ray was brought near, in t; set only when `moved`
  alignas(64) Number shift[kPacket];
#ifdef GRELHA_DOUBLE
  // What is tested: rays as they came, with t from their own origins. What is above is for the
  // grids then, org, t_min and best those of rays brought near; t_min is not above the true one,
  // and best not below.
  alignas(64) double from[3][kPacket];
  alignas(64) float after[kPacket];
  alignas(64) double nearest[kPacket];
  const float* low[3] = {};  ///< what is to be added to the origins as they came, or null
#endif
  bool moved = false;
  int group_axis[kPacket / kWidth<Lanes>];  ///< the axis all rays of a group share, or -1
  int size, groups;
  std::uint64_t live;  ///< bit g: group g has a ray that still searches
};

/// What tests take of ray i.
#ifdef GRELHA_DOUBLE
inline const double* tested_org(const Packet& p, int axis) { return p.from[axis]; }
inline const float* tested_t_min(const Packet& p) { return p.after; }
inline const double* tested_best(const Packet& p) { return p.nearest; }
inline void set_best(Packet& p, int i, double t) {
  p.nearest[i] = t;
  p.best[i] = not_below(p.moved ? t - p.shift[i] : t);
}
#else
inline const float* tested_org(const Packet& p, int axis) { return p.org[axis]; }
inline const float* tested_t_min(const Packet& p) { return p.t_min; }
inline const float* tested_best(const Packet& p) { return p.best; }
inline void set_best(Packet& p, int i, float t) { p.best[i] = t; }
#endif

inline std::uint32_t id_of(float bits) { return static_cast<std::uint32_t>(float_bits(bits)); }
inline float bits_of(std::uint32_t id) { return bits_float(static_cast<std::int32_t>(id)); }

/// A component of a direction below this meets none of its planes on any way that counts, and taken
/// instead of it never makes NaN: over a scene the ray strays by 1e-12 of it, where float strays by
/// 1e-7.
template <class Real>
inline Real least_headway(const Real& x, const Real& y, const Real& z) {
  return Real(1e-12f) * greater(greater(magnitude(x), magnitude(y)), magnitude(z));
}
inline Lanes least_headway(const Packet& p, int i) {
  return least_headway(
      load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i));
}

inline Vec3<Exact> origin(const Packet& p, int i) {
  return {take<Exact>(tested_org(p, 0) + i),
          take<Exact>(tested_org(p, 1) + i),
          take<Exact>(tested_org(p, 2) + i)};
}
inline Vec3<Exact> direction(const Packet& p, int i) {
  return {take<Exact>(p.dir[0] + i), take<Exact>(p.dir[1] + i), take<Exact>(p.dir[2] + i)};
}

/// Completes a packet whose org, dir, t_min, best and size are set.
inline void prepare(Packet& p, bool any_triangles) {
  constexpr int w = kWidth<Lanes>;
  p.groups = (p.size + w - 1) / w;
  p.live = ~std::uint64_t{0} >> (64 - p.groups);
  for (int i = p.size; i < p.groups * w; ++i) {  // repeat the last ray, switched off
    for (int a = 0; a < 3; ++a) {
      p.org[a][i] = p.org[a][p.size - 1];
      p.dir[a][i] = p.dir[a][p.size - 1];
    }
    p.t_min[i] = 0;
    p.best[i] = -kInfinity;
  }
  const float no_id = bits_of(kNoPrimitive);
  for (int g = 0; g < p.groups; ++g) {
    const int i = g * w;
    const Vec3<Lanes> d{
        load<Lanes>(p.dir[0] + i), load<Lanes>(p.dir[1] + i), load<Lanes>(p.dir[2] + i)};
    const Vec3<Lanes> o{
        load<Lanes>(p.org[0] + i), load<Lanes>(p.org[1] + i), load<Lanes>(p.org[2] + i)};
    const Lanes dd = dot(d, d), inv = Lanes(1) / dd;
    store(p.id + i, Lanes(no_id));
    // NaN and infinity times zero are NaN; a ray with one, or without a direction, meets nothing.
    const Mask<Lanes> sound = ((o.x + o.y) + (o.z + dd) + inv) * Lanes(0) == Lanes(0);
    store(p.best + i, select(sound, load<Lanes>(p.best + i), Lanes(-kInfinity)));
    if (any_triangles) {
      const Lanes ax = magnitude(d.x), ay = magnitude(d.y), az = magnitude(d.z);
      const Mask<Lanes> x_first = both(ax >= ay, ax >= az), y_first = ay >= az;
      const Lanes axis = select(x_first, Lanes(0), select(y_first, Lanes(1), Lanes(2)));
      store(p.axis + i, axis);
      p.group_axis[g] = none(axis != Lanes(p.axis[i])) ? static_cast<int>(p.axis[i]) : -1;
    }
    for (int k = i; k < i + w; k += kWidth<Exact>) {
      const Vec3<Exact> e = direction(p, k);
      store(p.inv_dd + k, Exact(1) / dot(e, e));
      if (!any_triangles)
        continue;
      const Vec3<Exact> q = permuted(take<Exact>(p.axis + k), e);
      store(p.shear[0] + k, q.x / q.z);
      store(p.shear[1] + k, q.y / q.z);
      store(p.shear[2] + k, Exact(1) / q.z);
    }
  }
#ifdef GRELHA_DOUBLE
  p.moved = false;
  __builtin_memcpy(p.after, p.t_min, sizeof p.after);
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < p.groups * w; ++i)
      p.from[a][i] = p.org[a][i];
    for (int i = 0; i < p.size && p.low[a]; ++i)
      p.from[a][i] += p.low[a][i];
  }
  for (int i = 0; i < p.groups * w; ++i)
    p.nearest[i] = p.best[i];
#endif
}

/// Notes hits of lanes from i on against one primitive: nearer wins, then the lower id. With kAny a
/// hit ends the ray's search.
template <bool kAny>
inline void note(Packet& p, int i, const Mask<Exact>& hit, const Exact& t, std::uint32_t id) {
  const Exact best = load<Exact>(tested_best(p) + i);
  const Mask<Exact> candidate = both(hit, kAny ? t < best : t <= best);
  if (none(candidate))
    return;
  const Mask<Exact> tie = both(candidate, t == best);
#ifndef GRELHA_DOUBLE
  if (kAny || none(tie)) {
    store(p.best + i, select(candidate, kAny ? Lanes(-kInfinity) : t, best));
    store(p.id + i, select(candidate, Lanes(bits_of(id)), load<Lanes>(p.id + i)));
    return;
  }
#else
  if (!kAny && none(tie)) {  // without a branch for each lane
    store(p.nearest + i, select(candidate, t, best));
    float near[kWidth<Exact>];
    const Exact here = p.moved ? t - load<Exact>(p.shift + i) : t;
    // more than rounding takes away
    store_narrow(near, here + (magnitude(here) * Exact(1.2e-7) + Exact(1e-44)));
    const unsigned lanes = bits(candidate);
    for (int k = 0; k < kWidth<Exact>; ++k) {
      const bool met = lanes >> k & 1;
      p.best[i + k] = met ? near[k] : p.best[i + k];
      p.id[i + k] = met ? bits_of(id) : p.id[i + k];
    }
    return;
  }
#endif
  Number at[kWidth<Exact>];
  store(at, t);
  const unsigned ties = bits(tie);
  for (unsigned left = bits(candidate); left != 0; left &= left - 1) {
    const int k = __builtin_ctz(left);
    const std::uint32_t held = id_of(p.id[i + k]);
    if ((ties >> k & 1) && (held == kNoPrimitive || held <= id))
      continue;
    set_best(p, i + k, kAny ? Number(-kInfinity) : at[k]);
    p.id[i + k] = bits_of(id);
  }
}

/// Runs `test(i)` for the first lane i of every live group.
template <class Test>
[[gnu::always_inline]] inline void each_live_group(const Packet& p, const Test& test) {
  for (std::uint64_t left = p.live; left != 0; left &= left - 1) {
    const int g = __builtin_ctzll(left);
    test(g * kWidth<Lanes>, g);
  }
}

/// Runs `test(i, g)` for the first lane i of every part, as wide as tests are, of every live group
/// g.
template <class Test>
[[gnu::always_inline]] inline void each_tested(const Packet& p, const Test& test) {
  each_live_group(
      p, [&](int first, int g) __attribute__((always_inline)) {
        for (int i = first; i < first + kWidth<Lanes>; i += kWidth<Exact>)
          test(i, g);
      });
}

inline void count_lanes(const Packet& p, Counters& n, std::uint64_t& tests) {
  each_live_group(p, [&](int i, int) {
    n.issued += kWidth<Lanes>;
    const unsigned on = bits(load<Lanes>(p.best + i) > load<Lanes>(p.t_min + i));
    n.busy += static_cast<unsigned>(__builtin_popcount(on));
    tests += static_cast<unsigned>(__builtin_popcount(on));
  });
}

template <bool kAny>
inline void test_sphere(Packet& p, float x, float y, float z, float r, std::uint32_t id) {
  const Vec3<Exact> center{Exact(x), Exact(y), Exact(z)};
  const Exact radius(r);
  each_tested(p, [&](int i, int) {
    Exact t(0);
    const Mask<Exact> hit = hit_sphere<Exact>(origin(p, i),
                                              direction(p, i),
                                              load<Exact>(p.inv_dd + i),
                                              take<Exact>(tested_t_min(p) + i),
                                              center,
                                              radius,
                                              t);
    note<kAny>(p, i, hit, t, id);
  });
}

template <bool kAny>
inline void test_cone(Packet& p, const float* const (&c)[10], std::uint32_t at, std::uint32_t id) {
  const ConeSide<Exact> side{{Exact(c[0][at]), Exact(c[1][at]), Exact(c[2][at])},
                             {Exact(c[3][at]), Exact(c[4][at]), Exact(c[5][at])},
                             Exact(c[6][at]),
                             Exact(c[7][at]),
                             Exact(c[8][at]),
                             Exact(c[9][at])};
  each_tested(p, [&](int i, int) {
    Exact t(0);
    const Mask<Exact> hit = hit_cone<Exact>(origin(p, i),
                                            direction(p, i),
                                            load<Exact>(p.inv_dd + i),
                                            take<Exact>(tested_t_min(p) + i),
                                            side,
                                            t);
    note<kAny>(p, i, hit, t, id);
  });
}

template <bool kAny>
inline void test_plane(Packet& p,
                       const Vec3<float>& point,
                       const Vec3<float>& normal,
                       std::uint32_t id) {
  const Vec3<Exact> q{Exact(point.x), Exact(point.y), Exact(point.z)};
  const Vec3<Exact> m{Exact(normal.x), Exact(normal.y), Exact(normal.z)};
  each_tested(p, [&](int i, int) {
    Exact t(0);
    const Mask<Exact> hit =
        hit_plane<Exact>(origin(p, i), direction(p, i), take<Exact>(tested_t_min(p) + i), q, m, t);
    note<kAny>(p, i, hit, t, id);
  });
}

/// A triangle that the rays of a packet are tested against.
struct TestedTriangle {
  const Packet* p;
  const float *a, *b, *c;
};

/// It and the rays from i on, of a group whose rays share an axis.
struct AlignedRays {
  const TestedTriangle* with;
  int i, axis;
  RayAndTriangle<Exact> operator()() const {
    const int k = axis, kx = kNextAxis[k], ky = kPreviousAxis[k];
    const Packet& p = *with->p;
    const auto corner = [&](const float* v) {
      return Vec3<Exact>{Exact(v[kx]), Exact(v[ky]), Exact(v[k])};
    };
    return {{take<Exact>(tested_org(p, kx) + i),
             take<Exact>(tested_org(p, ky) + i),
             take<Exact>(tested_org(p, k) + i)},
            {take<Exact>(p.dir[kx] + i), take<Exact>(p.dir[ky] + i), take<Exact>(p.dir[k] + i)},
            {corner(with->a), corner(with->b), corner(with->c)}};
  }
};

/// The same of a group whose rays do not.
struct MixedRays {
  const TestedTriangle* with;
  int i;
  RayAndTriangle<Exact> operator()() const {
    const Packet& p = *with->p;
    const Exact axis = take<Exact>(p.axis + i);
    const auto corner = [&](const float* v) {
      return permuted<Exact>(axis, {Exact(v[0]), Exact(v[1]), Exact(v[2])});
    };
    return {permuted(axis, origin(p, i)),
            permuted(axis, direction(p, i)),
            {corner(with->a), corner(with->b), corner(with->c)}};
  }
};

template <bool kAny>
[[gnu::noinline]] void test_triangle(
    Packet& p, const float (&a)[3], const float (&b)[3], const float (&c)[3], std::uint32_t id) {
  const TestedTriangle with{&p, a, b, c};
  each_tested(
      p, [&](int i, int g) __attribute__((always_inline)) {
        const Shear<Exact> shear{
            load<Exact>(p.shear[0] + i), load<Exact>(p.shear[1] + i), load<Exact>(p.shear[2] + i)};
        const Exact t_min = take<Exact>(tested_t_min(p) + i),
                    t_max = load<Exact>(tested_best(p) + i);
        Exact t(0);
        const int axis = p.group_axis[g];
        const Mask<Exact> hit =
            axis >= 0 ? hit_triangle<kAny>(AlignedRays{&with, i, axis}, shear, t_min, t_max, t)
                      : hit_triangle<kAny>(MixedRays{&with, i}, shear, t_min, t_max, t);
        note<kAny>(p, i, hit, t, id);
      });
}

}  // namespace grelha::GRELHA_ISA
