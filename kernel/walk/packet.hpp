#pragma once
// Rays side by side, and tests of a packet's rays against one primitive (SIMD over rays).

#include "grelha/stats.hpp"
#include "kernel/walk/walking_rays.hpp"

namespace grelha::GRELHA_ISA {

/// How packets of a size fared in a stream: tells whether to try the next one together.
class Luck {
 public:
  /// If most packets fell apart, one in 16 is tried all the same.
  bool worth_asking() { return sum_ >= 0 || ++left_out_ % 16 == 0; }
  /// `saved`: the share of its rays' ways that the packet went together.
  void note(float saved) {
    // trying costs as much as a fifth of the rays' ways (measured)
    sum_ += static_cast<int>(10 * saved) - 2;
    sum_ = sum_ > kMost ? kMost : sum_ < -kMost ? -kMost : sum_;
  }

 private:
  static constexpr int kMost = 24;
  int sum_ = 0;
  unsigned left_out_ = 0;
};

/// Rays that walk grids and are tested against primitives.
struct Packet : WalkingRays {
  alignas(64) float inv_dd[kPacket];
  alignas(64) float inv_length[kPacket];
  alignas(64) float shear[3][kPacket];
  const GeometryView* geometry = nullptr;
  Luck small_luck, middle_luck, large_luck;  ///< of packets of up to 16, 64 and 256
};

/// The rays from i on, as tests read them.
[[gnu::always_inline]] inline RayLanes<Lanes> ray_lanes(const Packet& p, int i) {
  return {.org = take_vec<Lanes>(p.org, i),
          .dir = take_vec<Lanes>(p.dir, i),
          .inv_dd = load<Lanes>(p.inv_dd + i),
          .inv_length = load<Lanes>(p.inv_length + i),
          .t_min = load<Lanes>(p.t_min + i),
          .off = Lanes(p.off),
          .room = Lanes(p.room),
          .base = p.base,
          .given = &p.given,
          .first = i,
          .step = 1};
}

/// Precomputes what tests read of the directions from i on.
[[gnu::always_inline]] inline void set_directions(Packet& p, int i, bool any_triangles) {
  const Vec3<Lanes> d = take_vec<Lanes>(p.dir, i);
  const Lanes inv_dd = Lanes(1) / dot(d, d);
  store(p.inv_dd + i, inv_dd);
  store(p.inv_length + i, inverse_length(d, inv_dd));
  if (!any_triangles)
    return;
  const Vec3<Lanes> q = permuted(load<Lanes>(p.axis + i), d);
  store(p.shear[0] + i, q.x / q.z);
  store(p.shear[1] + i, q.y / q.z);
  store(p.shear[2] + i, Lanes(1) / q.z);
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

/// Completes a packet whose org, dir, t_min, best and size are set.
inline void prepare(Packet& p, const GeometryView& geometry, bool any_triangles) {
  p.geometry = &geometry;
  p.room = kInfinity;
  p.given = {{p.org[0], p.org[1], p.org[2]}, {p.dir[0], p.dir[1], p.dir[2]}, p.t_min, nullptr};
  p.end = p.best;
  prepare_to_walk(
      p, [&](int g) __attribute__((always_inline)) {
        const int i = g * kWidth<Lanes>;
        store(p.low + i, load<Lanes>(p.best + i));
        if (any_triangles)
          set_axes(p, i, g);
        set_directions(p, i, any_triangles);
      });
}

/// Ids of the primitives that the rays from i on hit.
inline LaneWords ids_at(const Packet& p, int i) {
  return load_words<Lanes>(reinterpret_cast<const std::uint32_t*>(p.id + i));
}

/// True if the hit of primitive `id` comes first, where floats cannot tell it from ray i's hit so
/// far or from the end of its search.
[[gnu::noinline, gnu::cold]] inline bool wins_tie(const Packet& p, int i, std::uint32_t id) {
  const ExactRay ray = p.given.ray(i);
  const std::uint32_t held = id_of(p.id[i]);
  return held == kNoPrimitive ? comes_before(*p.geometry, ray, id, p.end[i])
                              : comes_first(*p.geometry, ray, id, held);
}

/// Takes a hit of a lane that ties, and narrows the span of t of the first one.
template <bool kAny>
[[gnu::noinline, gnu::cold]] void note_tie(Packet& p, int i, std::uint32_t id) {
  if (wins_tie(p, i, id))
    p.id[i] = bits_of(id);
  const std::uint32_t held = id_of(p.id[i]);
  if (held == kNoPrimitive)
    return;
  const CrossingSpan span = crossing_span(*p.geometry, p.given.ray(i), held, p.given.shift_of(i));
  p.best[i] = kAny ? -kInfinity : span.hi;
  p.low[i] = kAny ? -kInfinity : span.lo;
}

/// Notes hits of lanes from i on against one primitive: nearer wins, then the lower id. With kAny a
/// hit ends the ray's search.
template <bool kAny>
inline void note(Packet& p, int i, const Found<Lanes>& found, std::uint32_t id) {
  const Lanes best = load<Lanes>(p.best + i);
  const Mask<Lanes> candidate = both(found.some, found.lo <= best);
  if (none(candidate))
    return;
  const Lanes low = load<Lanes>(p.low + i);
  const Mask<Lanes> closer = both(candidate, found.hi < low);
  const Lanes over(-kInfinity);
  store(p.best + i, select(closer, kAny ? over : found.hi, best));
  store(p.low + i, select(closer, kAny ? over : found.lo, low));
  store(p.id + i, select(closer, Lanes(bits_of(id)), load<Lanes>(p.id + i)));
  const unsigned other = lanes_where(ids_at(p, i) != id);
  each_bit(bits(but_not(candidate, closer)) & other, [&](int k) { note_tie<kAny>(p, i + k, id); });
}

/// Tests all live rays against a primitive of a kind and counts that: runs `test(i, g)` for the
/// first lane i of every live group g.
template <class Shape, class Test>
[[gnu::always_inline]] inline void each_tested(const Packet& p, Counters& n, const Test& test) {
  unsigned busy = 0;  // in one pass with the tests: these look at best and t_min as well
  each_live_group(
      p, [&](int i, int g) __attribute__((always_inline)) {
        const unsigned on = bits(load<Lanes>(p.best + i) > load<Lanes>(p.t_min + i));
        busy += static_cast<unsigned>(__builtin_popcount(on));
        test(i, g);
      });
  n.issued += static_cast<unsigned>(__builtin_popcountll(p.live) * kWidth<Lanes>);
  n.busy += busy;
  n.tests[kNumber<Shape>] += busy;
}

/// All live rays against primitive `index` of many.
template <bool kAny, class Shape>
inline void test_one(
    Packet& p, const FieldArrays<Shape>& of, std::uint32_t index, std::uint32_t id, Counters& n) {
  const auto one = broadcast<Shape, Lanes>(of, index);
  each_tested<Shape>(p, n, [&](int i, int) {
    note<kAny>(p, i, meet<Shape>(ray_lanes(p, i), one, load<Lanes>(p.best + i)), id);
  });
}

/// A triangle that the rays of a packet are tested against, as it is and in their frame.
struct TestedTriangle {
  const Packet* p;
  const Triangle::Fields<float>& as_it_is;
  const float (*corner)[3];
};

/// It and the rays from i on.
struct TriangleAndRays {
  const TestedTriangle* with;
  int i;
  float off() const { return with->p->off; }
  ExactRay given(int k) const { return with->p->given.ray(i + k); }
  double shift(int k) const { return with->p->given.shift_of(i + k); }
  void take_corners(int, float (&to)[3][3]) const {
    __builtin_memcpy(to, with->as_it_is.corner, sizeof to);
  }
};

/// The same of a group whose rays share an axis.
struct AlignedRays : TriangleAndRays {
  int axis;
  RayAndTriangle<Lanes> operator()() const {
    const int k = axis;
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const Packet& p = *with->p;
    const auto corner = [&](int c) {
      const float* const v = with->corner[c];
      return Vec3<Lanes>{Lanes(v[kx]), Lanes(v[ky]), Lanes(v[k])};
    };
    return {{load<Lanes>(p.org[kx] + i), load<Lanes>(p.org[ky] + i), load<Lanes>(p.org[k] + i)},
            {load<Lanes>(p.dir[kx] + i), load<Lanes>(p.dir[ky] + i), load<Lanes>(p.dir[k] + i)},
            {corner(0), corner(1), corner(2)}};
  }
};

/// The same of a group whose rays do not.
struct MixedRays : TriangleAndRays {
  RayAndTriangle<Lanes> operator()() const {
    const Packet& p = *with->p;
    const Lanes axis = load<Lanes>(p.axis + i);
    const auto corner = [&](int c) {
      const float* const v = with->corner[c];
      return permuted<Lanes>(axis, {Lanes(v[0]), Lanes(v[1]), Lanes(v[2])});
    };
    return {permuted(axis, take_vec<Lanes>(p.org, i)),
            permuted(axis, take_vec<Lanes>(p.dir, i)),
            {corner(0), corner(1), corner(2)}};
  }
};

template <bool kAny>
[[gnu::noinline]] void test_triangle(Packet& p,
                                     const Triangle::Fields<float>& triangle,
                                     std::uint32_t id,
                                     Counters& n) {
  Triangle::Fields<float> framed;
  for (int k = 0; p.base && k < 3; ++k)
    for (int a = 0; a < 3; ++a)
      framed.corner[k][a] = triangle.corner[k][a] - p.base[a];
  const TestedTriangle with{&p, triangle, p.base ? framed.corner : triangle.corner};
  each_tested<Triangle>(
      p, n, [&](int i, int g) __attribute__((always_inline)) {
        const Shear<Lanes> shear{load<Lanes>(p.shear[0] + i),
                                 load<Lanes>(p.shear[1] + i),
                                 load<Lanes>(p.shear[2] + i),
                                 Lanes(p.off)};
        const Lanes t_min = load<Lanes>(p.t_min + i);
        const Lanes best = load<Lanes>(p.best + i);
        const int axis = p.group_axis[g];
        note<kAny>(p,
                   i,
                   axis >= 0 ? meet_triangle(AlignedRays{{&with, i}, axis}, shear, t_min, best)
                             : meet_triangle(MixedRays{{&with, i}}, shear, t_min, best),
                   id);
      });
}

}  // namespace grelha::GRELHA_ISA
