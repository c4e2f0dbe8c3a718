#pragma once
// Tests of the rays of a packet against one primitive (SIMD over rays).

#include "kernel/traverse/counts.hpp"
#include "kernel/traverse/take_hit.hpp"

namespace grelha::GRELHA_ISA {

/// The rays from i on, as tests read them.
[[gnu::always_inline]] inline SimdRays<VFloat> simd_rays(const Packet& p, int i) {
  return {.org = take_vec<VFloat>(p.org, i),
          .dir = take_vec<VFloat>(p.dir, i),
          .inv_dd = load<VFloat>(p.inv_dd + i),
          .inv_length = load<VFloat>(p.inv_length + i),
          .t_min = load<VFloat>(p.t_min + i),
          .frame_error = VFloat(p.frame_error),
          .error_bound = VFloat(p.error_bound),
          .base = p.base,
          .given = &p.given,
          .first = i,
          .step = 1};
}

/// Precomputes what tests read of the directions from i on.
[[gnu::always_inline]] inline void set_directions(Packet& p, int i, bool any_triangles) {
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  const VFloat inv_dd = VFloat(1) / dot(d, d);
  store(p.inv_dd + i, inv_dd);
  store(p.inv_length + i, inverse_length(d, inv_dd));
  if (!any_triangles)
    return;
  const Vec3<VFloat> q = permute_axes(load<VFloat>(p.axis + i), d);
  store(p.shear[0] + i, q.x / q.z);
  store(p.shear[1] + i, q.y / q.z);
  store(p.shear[2] + i, VFloat(1) / q.z);
}

/// Completes a packet whose org, dir, t_min, best and size are set.
inline void prepare(Packet& p, const GeometryView& geometry, bool any_triangles) {
  constexpr int w = kWidth<VFloat>;
  p.geometry = &geometry;
  p.error_bound = kInfinity;
  p.given = {{p.org[0], p.org[1], p.org[2]}, {p.dir[0], p.dir[1], p.dir[2]}, p.t_min, p.best};
  p.groups = (p.size + w - 1) / w;
  p.live = ~std::uint64_t{0} >> (64 - p.groups);
  p.has_units = false;
  p.has_slabs = false;
  fill_up(p);
  for (int g = 0; g < p.groups; ++g) {
    const int i = g * w;
    p.ahead.prefetch_row(i);
    store(p.id + i, VFloat(bits_of(kNoPrimitive)));
    store(p.hit_field_id + i, VFloat(bits_of(kNoPrimitive)));
    check_rays(p, i);
    store(p.low + i, load<VFloat>(p.best + i));
    if (any_triangles)
      set_axes(p, i, g);
    set_directions(p, i, any_triangles);
  }
}

/// Ids of the primitives that the rays from i on hit.
inline VUint ids_at(const Packet& p, int i) {
  return load_words<VFloat>(reinterpret_cast<const std::uint32_t*>(p.id + i));
}

/// Takes hits of selected lanes from i on against one primitive, one by one.
template <bool kAny>
[[gnu::noinline]] void take_hits(
    Packet& p, int i, const HitInterval<VFloat>& found, unsigned lanes, std::uint32_t id) {
  float lo[kWidth<VFloat>], hi[kWidth<VFloat>];
  store(lo, found.lo);
  store(hi, found.hi);
  each_bit(lanes, [&](int k) { take_hit<kAny>(p, i + k, {lo[k], hi[k]}, id); });
}

/// True if one of the rays from i on does not hit primitive `id` itself where it crosses it.
inline bool filters_some(const Packet& p, int i, unsigned lanes, std::uint32_t id) {
  bool some = false;
  each_bit(lanes, [&](int k) { some |= p.filter->hit_of(i + k, id) != id; });
  return some;
}

/// Notes hits of lanes from i on against one primitive: nearer wins, then the lower id. With kAny a
/// hit ends the ray's search.
template <bool kAny, class Shape>
inline void record(Packet& p,
                   int i,
                   const HitInterval<VFloat>& found,
                   std::uint32_t id,
                   const typename Shape::template Fields<float>& met) {
  const VFloat best = load<VFloat>(p.best + i);
  const Mask<VFloat> candidate = mask_and(found.some, found.lo <= best);
  if (none(candidate))
    return;
  if (p.filter && filters_some(p, i, bits(candidate), id)) [[unlikely]] {
    take_hits<kAny>(p, i, found, bits(candidate), id);
    return;
  }
  const VFloat low = load<VFloat>(p.low + i);
  const Mask<VFloat> closer = mask_and(candidate, found.hi < low);
  const VFloat over(-kInfinity);
  store_selected(p.best + i, closer, kAny ? over : found.hi);
  store_selected(p.low + i, closer, kAny ? over : found.lo);
  store_selected(p.id + i, closer, VFloat(bits_of(id)));
  if constexpr (!kAny && kKeepsFields<Shape>) {
    int row = 0;
    Shape::for_each_field(
        [&](const float& x) __attribute__((always_inline)) {
          store_selected(p.hit_field[row] + i, closer, VFloat(x));
          ++row;
        },
        met);
    store_selected(p.hit_field_id + i, closer, VFloat(bits_of(id)));
  }
  const unsigned other = bits_where(ids_at(p, i) != id);
  if (const unsigned ties = bits(and_not(candidate, closer)) & other; ties != 0)
    take_hits<kAny>(p, i, found, ties, id);
}

/// Tests all live rays against a primitive of a kind and counts that: runs `test(i, g)` for the
/// first lane i of every live group g.
template <class Shape, class Test>
[[gnu::always_inline]] inline void each_tested(const Packet& p, TraceCounts& n, const Test& test) {
  unsigned busy = 0;  // in one pass with the tests: these look at best and t_min as well
  each_live_group(
      p, [&](int i, int g) __attribute__((always_inline)) {
        const unsigned on = bits(load<VFloat>(p.best + i) > load<VFloat>(p.t_min + i));
        busy += static_cast<unsigned>(__builtin_popcount(on));
        test(i, g);
      });
  n.packets.lanes_issued += static_cast<unsigned>(__builtin_popcountll(p.live) * kWidth<VFloat>);
  n.packets.lanes_busy += busy;
  count_tests<Shape>(n, busy);
}

/// All live rays against primitive `index` of many.
template <bool kAny, class Shape>
inline void test_one(Packet& p,
                     const FieldArrays<Shape>& of,
                     std::uint32_t index,
                     std::uint32_t id,
                     TraceCounts& n) {
  const auto one = broadcast<Shape, VFloat>(of, index);
  const auto met = one_of<Shape>(of, index);
  each_tested<Shape>(p, n, [&](int i, int) {
    record<kAny, Shape>(
        p, i, intersect<Shape>(simd_rays(p, i), one, load<VFloat>(p.best + i)), id, met);
  });
}

/// A triangle, as it is and in the frame of a packet, and the packet's rays from i on. They share
/// an axis, or each has its own: one test for both takes 1.05 of the instructions.
template <bool kShareAxis>
struct TriangleSource {
  const Packet& p;
  const Triangle::Fields<float>& as_it_is;
  const float (*corner)[3];
  int i, axis;
  std::uint32_t id;

  RayAndTriangle<VFloat> operator()() const {
    if constexpr (kShareAxis)
      return along_axis();
    else
      return permuted();
  }
  float frame_error() const { return p.frame_error; }
  ExactRay given(int k) const { return p.given.ray(i + k); }
  double shift(int k) const { return p.given.shift_of(i + k); }
  bool leaves_out(int k) const { return p.leaves_out(i + k, id); }
  void take_vertices(int, float (&to)[3][3]) const {
    __builtin_memcpy(to, as_it_is.corner, sizeof to);
  }

 private:
  [[gnu::always_inline]] RayAndTriangle<VFloat> along_axis() const {
    const int k = axis;
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const auto at = [&](int c) {
      const float* const v = corner[c];
      return Vec3<VFloat>{VFloat(v[kx]), VFloat(v[ky]), VFloat(v[k])};
    };
    return {{load<VFloat>(p.org[kx] + i), load<VFloat>(p.org[ky] + i), load<VFloat>(p.org[k] + i)},
            {load<VFloat>(p.dir[kx] + i), load<VFloat>(p.dir[ky] + i), load<VFloat>(p.dir[k] + i)},
            {at(0), at(1), at(2)}};
  }
  [[gnu::always_inline]] RayAndTriangle<VFloat> permuted() const {
    const VFloat axes = load<VFloat>(p.axis + i);
    const auto at = [&](int c) {
      const float* const v = corner[c];
      return permute_axes<VFloat>(axes, {VFloat(v[0]), VFloat(v[1]), VFloat(v[2])});
    };
    return {permute_axes(axes, take_vec<VFloat>(p.org, i)),
            permute_axes(axes, take_vec<VFloat>(p.dir, i)),
            {at(0), at(1), at(2)}};
  }
};

template <bool kAny>
[[gnu::noinline]] void test_triangle(Packet& p,
                                     const Triangle::Fields<float>& triangle,
                                     std::uint32_t id,
                                     TraceCounts& n) {
  Triangle::Fields<float> framed;
  for (int k = 0; p.base && k < 3; ++k)
    for (int a = 0; a < 3; ++a)
      framed.corner[k][a] = triangle.corner[k][a] - p.base[a];
  each_tested<Triangle>(
      p, n, [&](int i, int g) __attribute__((always_inline)) {
        const Shear<VFloat> shear{load<VFloat>(p.shear[0] + i),
                                  load<VFloat>(p.shear[1] + i),
                                  load<VFloat>(p.shear[2] + i),
                                  VFloat(p.frame_error)};
        const VFloat t_min = load<VFloat>(p.t_min + i);
        const VFloat best = load<VFloat>(p.best + i);
        const float(*const corner)[3] = p.base ? framed.corner : triangle.corner;
        const int axis = p.group_axis[g];
        const auto found = [&]<bool kShareAxis>() __attribute__((always_inline)) {
          const TriangleSource<kShareAxis> source{p, triangle, corner, i, axis, id};
          return intersect_triangle(source, shear, t_min, best);
        };
        record<kAny, Triangle>(
            p,
            i,
            axis >= 0 ? found.template operator()<true>() : found.template operator()<false>(),
            id,
            triangle);
      });
}

}  // namespace grelha::GRELHA_ISA
