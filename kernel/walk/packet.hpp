#pragma once
// Rays side by side in float or in double, and the tests of all of them against one primitive (SIMD
// over rays).

#include "grelha/stats.hpp"
#include "kernel/walk/walking_rays.hpp"

namespace grelha::GRELHA_ISA {

/// What is tested in float: the rays that walk.
template <class In>
struct TestedRays {};

/// What is tested in double: rays as they came, with t from their own origins. Those that walk are
/// these brought near; their t_min is not above the true one, and best not below.
template <>
struct TestedRays<InDouble> {
  alignas(64) double from[3][kPacket];
  alignas(64) float after[kPacket];
  alignas(64) double nearest[kPacket];
  const float* low[3] = {};  ///< what is to be added to the origins as they came, or null
};

/// How packets of a size fared in a stream: whether to ask the next one to go together.
class Luck {
 public:
  /// Where most fell apart one in 16 is asked all the same.
  bool worth_asking() { return sum_ >= 0 || ++left_out_ % 16 == 0; }
  /// `saved`: the share of its rays' ways that a packet went together.
  void note(float saved) {
    // asking costs as much as a fifth of the rays' ways (measured)
    sum_ += static_cast<int>(10 * saved) - 2;
    sum_ = sum_ > kMost ? kMost : sum_ < -kMost ? -kMost : sum_;
  }

 private:
  static constexpr int kMost = 24;
  int sum_ = 0;
  unsigned left_out_ = 0;
};

/// Rays that are tested against primitives in float or in double.
template <class In>
struct Packet : WalkingRays, TestedRays<In> {
  using Number = typename In::Number;
  alignas(64) Number inv_dd[kPacket];
  alignas(64) Number shear[3][kPacket];
  /// how far a ray was brought near, in t; set only when `moved`
  alignas(64) Number shift[kPacket];
  bool moved = false;
  Luck small_luck, middle_luck, large_luck;  ///< of packets of up to 16, 64 and 256
};

/// What tests take of ray i.
inline const float* tested_org(const Packet<InFloat>& p, int axis) {
  return p.org[axis];
}
inline const float* tested_t_min(const Packet<InFloat>& p) {
  return p.t_min;
}
inline const float* tested_best(const Packet<InFloat>& p) {
  return p.best;
}
inline void set_best(Packet<InFloat>& p, int i, float t) {
  p.best[i] = t;
}

inline const double* tested_org(const Packet<InDouble>& p, int axis) {
  return p.from[axis];
}
inline const float* tested_t_min(const Packet<InDouble>& p) {
  return p.after;
}
inline const double* tested_best(const Packet<InDouble>& p) {
  return p.nearest;
}
inline void set_best(Packet<InDouble>& p, int i, double t) {
  p.nearest[i] = t;
  p.best[i] = not_below(p.moved ? t - p.shift[i] : t);
}

template <class In>
inline Vec3<typename In::Rays> origin(const Packet<In>& p, int i) {
  using Real = typename In::Rays;
  return {take<Real>(tested_org(p, 0) + i),
          take<Real>(tested_org(p, 1) + i),
          take<Real>(tested_org(p, 2) + i)};
}
template <class In>
inline Vec3<typename In::Rays> direction(const Packet<In>& p, int i) {
  return take_vec<typename In::Rays>(p.dir, i);
}

/// Lets tests in float take the rays that walk.
inline void set_tested(Packet<InFloat>&) {}
/// Lets tests in double take the rays as they came.
inline void set_tested(Packet<InDouble>& p) {
  const int end = p.groups * kWidth<Lanes>;
  p.moved = false;
  __builtin_memcpy(p.after, p.t_min, sizeof p.after);
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < end; ++i)
      p.from[a][i] = p.org[a][i];
    for (int i = 0; i < p.size && p.low[a]; ++i)
      p.from[a][i] += p.low[a][i];
  }
  for (int i = 0; i < end; ++i)
    p.nearest[i] = p.best[i] == kInfinity ? kEndOfFloats : p.best[i];
}

/// What tests take of directions from i on.
template <class In>
[[gnu::always_inline]] inline void set_directions(Packet<In>& p, int i, bool any_triangles) {
  using Real = typename In::Rays;
  const Vec3<Real> d = direction(p, i);
  store(p.inv_dd + i, Real(1) / dot(d, d));
  if (!any_triangles)
    return;
  const Vec3<Real> q = permuted(take<Real>(p.axis + i), d);
  store(p.shear[0] + i, q.x / q.z);
  store(p.shear[1] + i, q.y / q.z);
  store(p.shear[2] + i, Real(1) / q.z);
}

/// Completes a packet whose org, dir, t_min, best and size are set, for walks; `complete(g)` does
/// what else is to be done for group g.
template <class Complete>
[[gnu::always_inline]] inline void prepare_to_walk(WalkingRays& p, const Complete& complete) {
  constexpr int w = kWidth<Lanes>;
  p.groups = (p.size + w - 1) / w;
  p.live = ~std::uint64_t{0} >> (64 - p.groups);
  p.has_units = false;
  fill_up(p);
  for (int g = 0; g < p.groups; ++g) {
    p.ahead.ask(g * w);
    store(p.id + g * w, Lanes(bits_of(kNoPrimitive)));
    check_rays(p, g * w);
    complete(g);
  }
}
inline void prepare_to_walk(WalkingRays& p) {
  prepare_to_walk(p, [](int) {});
}

/// The rest, of a group: for tests.
template <class In>
[[gnu::always_inline]] inline void prepare_to_test(Packet<In>& p, int group, bool any_triangles) {
  const int i = group * kWidth<Lanes>;
  if (any_triangles)
    set_axes(p, i, group);
  for (int k = i; k < i + kWidth<Lanes>; k += kWidth<typename In::Rays>)
    set_directions(p, k, any_triangles);
}

/// Completes a packet whose org, dir, t_min, best and size are set.
template <class In>
inline void prepare(Packet<In>& p, bool any_triangles) {
  prepare_to_walk(
      p, [&](int g) __attribute__((always_inline)) { prepare_to_test(p, g, any_triangles); });
  set_tested(p);
}

/// Stores hits of candidates from i on that tie with nothing met before.
template <bool kAny>
[[gnu::always_inline]] inline void store_hits(Packet<InFloat>& p,
                                              int i,
                                              const Mask<Lanes>& candidate,
                                              const Lanes& t,
                                              const Lanes& best,
                                              std::uint32_t id) {
  store(p.best + i, select(candidate, kAny ? Lanes(-kInfinity) : t, best));
  store(p.id + i, select(candidate, Lanes(bits_of(id)), load<Lanes>(p.id + i)));
}
/// The same, without a branch for each lane.
template <bool kAny>
[[gnu::always_inline]] inline void store_hits(Packet<InDouble>& p,
                                              int i,
                                              const Mask<DoubleLanes>& candidate,
                                              const DoubleLanes& t,
                                              const DoubleLanes& best,
                                              std::uint32_t id) {
  constexpr int w = kWidth<DoubleLanes>;
  store(p.nearest + i, select(candidate, t, best));
  float near[w];
  store_not_below(near, p.moved ? t - load<DoubleLanes>(p.shift + i) : t);
  const unsigned lanes = bits(candidate);
  for (int k = 0; k < w; ++k) {
    const bool met = lanes >> k & 1;
    p.best[i + k] = met ? near[k] : p.best[i + k];
    p.id[i + k] = met ? bits_of(id) : p.id[i + k];
  }
}

/// Stores hits of candidates from i on one by one: of those that tie, the lower id wins.
template <bool kAny, class In>
[[gnu::always_inline]] inline void store_one_by_one(Packet<In>& p,
                                                    int i,
                                                    unsigned candidates,
                                                    unsigned ties,
                                                    const typename In::Rays& t,
                                                    std::uint32_t id) {
  using Number = typename In::Number;
  Number at[kWidth<typename In::Rays>];
  store(at, t);
  each_bit(candidates, [&](int k) {
    const std::uint32_t held = id_of(p.id[i + k]);
    if ((ties >> k & 1) && (held == kNoPrimitive || held <= id))
      return;
    set_best(p, i + k, kAny ? Number(-kInfinity) : at[k]);
    p.id[i + k] = bits_of(id);
  });
}

/// Notes hits of lanes from i on against one primitive: nearer wins, then the lower id. With kAny a
/// hit ends the ray's search.
template <bool kAny, class In>
inline void note(Packet<In>& p,
                 int i,
                 const Mask<typename In::Rays>& hit,
                 const typename In::Rays& t,
                 std::uint32_t id) {
  using Real = typename In::Rays;
  const Real best = load<Real>(tested_best(p) + i);
  const Mask<Real> candidate = both(hit, kAny ? t < best : t <= best);
  if (none(candidate))
    return;
  const Mask<Real> tie = both(candidate, t == best);
  if (In::kDouble ? !kAny && none(tie) : kAny || none(tie))
    store_hits<kAny>(p, i, candidate, t, best, id);
  else
    store_one_by_one<kAny>(p, i, bits(candidate), bits(tie), t, id);
}

/// Tests all live rays against a primitive of a kind and counts that: runs `test(i, g)` for the
/// first lane i of every part, as wide as tests are, of every live group g.
template <class Shape, class In, class Test>
[[gnu::always_inline]] inline void each_tested(const Packet<In>& p, Counters& n, const Test& test) {
  unsigned busy = 0;  // in one pass with the tests: these look at best and t_min as well
  each_live_group(
      p, [&](int first, int g) __attribute__((always_inline)) {
        const unsigned on = bits(load<Lanes>(p.best + first) > load<Lanes>(p.t_min + first));
        busy += static_cast<unsigned>(__builtin_popcount(on));
        for (int i = first; i < first + kWidth<Lanes>; i += kWidth<typename In::Rays>)
          test(i, g);
      });
  n.issued += static_cast<unsigned>(__builtin_popcountll(p.live) * kWidth<Lanes>);
  n.busy += busy;
  n.tests[kNumber<Shape>] += busy;
}

/// All live rays against primitive `index` of many.
template <bool kAny, class Shape, class In>
inline void test_one(Packet<In>& p,
                     const FieldArrays<Shape>& of,
                     std::uint32_t index,
                     std::uint32_t id,
                     Counters& n) {
  using Real = typename In::Rays;
  const auto one = broadcast<Shape, Real>(of, index);
  each_tested<Shape>(p, n, [&](int i, int) {
    const RayLanes<Real> ray{.org = origin(p, i),
                             .dir = direction(p, i),
                             .inv_dd = load<Real>(p.inv_dd + i),
                             .t_min = take<Real>(tested_t_min(p) + i)};
    Real t(0);
    const Mask<Real> hit = meet(ray, one, t);
    note<kAny>(p, i, hit, t, id);
  });
}

/// A triangle that the rays of a packet are tested against.
template <class In>
struct TestedTriangle {
  const Packet<In>* p;
  const float (&corner)[3][3];
};

/// It and the rays from i on, of a group whose rays share an axis.
template <class In>
struct AlignedRays {
  using Real = typename In::Rays;
  const TestedTriangle<In>* with;
  int i, axis;
  RayAndTriangle<Real> operator()() const {
    const int k = axis;
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const Packet<In>& p = *with->p;
    const auto corner = [&](const float* v) {
      return Vec3<Real>{Real(v[kx]), Real(v[ky]), Real(v[k])};
    };
    return {{take<Real>(tested_org(p, kx) + i),
             take<Real>(tested_org(p, ky) + i),
             take<Real>(tested_org(p, k) + i)},
            {take<Real>(p.dir[kx] + i), take<Real>(p.dir[ky] + i), take<Real>(p.dir[k] + i)},
            {corner(with->corner[0]), corner(with->corner[1]), corner(with->corner[2])}};
  }
};

/// The same of a group whose rays do not.
template <class In>
struct MixedRays {
  using Real = typename In::Rays;
  const TestedTriangle<In>* with;
  int i;
  RayAndTriangle<Real> operator()() const {
    const Packet<In>& p = *with->p;
    const Real axis = take<Real>(p.axis + i);
    const auto corner = [&](const float* v) {
      return permuted<Real>(axis, {Real(v[0]), Real(v[1]), Real(v[2])});
    };
    return {permuted(axis, origin(p, i)),
            permuted(axis, direction(p, i)),
            {corner(with->corner[0]), corner(with->corner[1]), corner(with->corner[2])}};
  }
};

template <bool kAny, class In>
[[gnu::noinline]] void test_triangle(Packet<In>& p,
                                     const Triangle::Fields<float>& triangle,
                                     std::uint32_t id,
                                     Counters& n) {
  using Real = typename In::Rays;
  const TestedTriangle<In> with{&p, triangle.corner};
  each_tested<Triangle>(
      p, n, [&](int i, int g) __attribute__((always_inline)) {
        const Shear<Real> shear{
            load<Real>(p.shear[0] + i), load<Real>(p.shear[1] + i), load<Real>(p.shear[2] + i)};
        const Real t_min = take<Real>(tested_t_min(p) + i);
        const Real t_max = load<Real>(tested_best(p) + i);
        Real t(0);
        const int axis = p.group_axis[g];
        const Mask<Real> hit =
            axis >= 0 ? hit_triangle<kAny>(AlignedRays<In>{&with, i, axis}, shear, t_min, t_max, t)
                      : hit_triangle<kAny>(MixedRays<In>{&with, i}, shear, t_min, t_max, t);
        note<kAny>(p, i, hit, t, id);
      });
}

}  // namespace grelha::GRELHA_ISA
