#pragma once
// t of hits, rounded once: in double, side by side, and exactly where doubles cannot decide which
// float is nearest.

#include "kernel/traverse/packet_tests.hpp"

namespace grelha::GRELHA_ISA {

/// Fields of the primitives i as tests read them.
template <class Shape>
[[gnu::always_inline]] inline typename Shape::template Fields<VFloat> fields_at(
    const typename Shape::Arrays& all, const VUint& i) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    Triangle::Fields<VFloat> to;
    for (int k = 0; k < 3; ++k) {
      const VUint vertex = words_at(all.corner[k], i);
      for (int a = 0; a < 3; ++a)
        to.corner[k][a] = floats_at(all.vertex[a], vertex);
    }
    return to;
  } else {
    return gathered<Shape, VFloat>(all.fields, i);
  }
}

/// The same of the rays from i on: what their packet kept, where it kept all.
template <class Shape>
[[gnu::always_inline]] inline typename Shape::template Fields<VFloat> hit_fields(
    const Packet& p, int i, unsigned lanes, const typename Shape::Arrays& all, const VUint& index) {
  if constexpr (kKeepsFields<Shape>) {
    const VUint met =
        load_words<VFloat>(reinterpret_cast<const std::uint32_t*>(p.hit_field_id + i));
    if ((lanes & ~bits_where(met == ids_at(p, i))) == 0) [[likely]] {
      typename Shape::template Fields<VFloat> to;
      int row = 0;
      Shape::for_each_field([&](VFloat& x) { x = load<VFloat>(p.hit_field[row++] + i); }, to);
      return to;
    }
  }
  return fields_at<Shape>(all, index);
}

/// Spans of t, part after part; NaN where double does not tell.
template <class Shape, int k = 0>
[[gnu::always_inline]] inline void hit_spans(const Packet& p,
                                             int i,
                                             const SimdRays<VFloat>& rays,
                                             const typename Shape::template Fields<VFloat>& met,
                                             VDouble (&lo)[kWideParts<VFloat>],
                                             VDouble (&hi)[kWideParts<VFloat>]) {
  using W = VDouble;
  const W unknown(__builtin_nan(""));
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    const auto& c = met.corner;
    const TriangleVertices<W> corner{
        to_double<k>(vec(c[0])), to_double<k>(vec(c[1])), to_double<k>(vec(c[2]))};
    const PlaneSpan<W> span = plane_span<W>(to_double<k>(rays.org), to_double<k>(rays.dir), corner);
    lo[k] = select(span.known, span.lo, unknown);
    hi[k] = span.hi;
  } else {
    const HitInterval<W> found = [&]() __attribute__((always_inline)) {
      const auto wide = given_in_double<k>(rays);
      const auto primitive = fields_to_double<Shape, k, VFloat>(met);
      if constexpr (Shape::kKind == PrimitiveKind::kSphere) {
        const int at = i + k * kWidth<W>;
        return narrowed(wide, primitive, take<W>(p.low + at), take<W>(p.best + at));
      } else {
        return bound(wide, primitive, W(static_cast<double>(kInfinity)));
      }
    }
    ();
    lo[k] = select(found.sure, found.lo, unknown);
    hi[k] = found.hi;
  }
  if constexpr (k + 1 < kWideParts<VFloat>)
    hit_spans<Shape, k + 1>(p, i, rays, met, lo, hi);
}

/// A ray of a packet, with t counted as the caller does.
inline ExactRay given_ray(const Packet& p, int i) {
  const ExactRay ray = p.given.ray(i);
  return p.has_units ? ray.in_units_of(1 / static_cast<double>(p.unit[i])) : ray;
}

/// t of the rays of a packet from i on that hit primitives of the kinds of a set, to t[0] and on;
/// that of others stays.
template <class Set>
inline void round_hits(const Packet& p, int i, float* t) {
  const GeometryView& g = *p.geometry;
  const VUint id = ids_at(p, i);
  Set::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const std::uint32_t first = g.ids.begin(Shape::kKind);
    const auto here = id - first < g.ids.count(Shape::kKind);
    const unsigned lanes = bits_where(here);
    if (lanes == 0)
      return;
    const VUint index(here ? id - first : VUint{});
    VDouble lo[kWideParts<VFloat>], hi[kWideParts<VFloat>];
    hit_spans<Shape>(
        p, i, simd_rays(p, i), hit_fields<Shape>(p, i, lanes, g.of<Shape>(), index), lo, hi);
    if (p.has_units) [[unlikely]]
      for (int k = 0; k < kWideParts<VFloat>; ++k) {
        const auto unit = take<VDouble>(p.unit + i + k * kWidth<VDouble>);
        lo[k] = lo[k] / unit;
        hi[k] = hi[k] / unit;
      }
    const VFloat least = narrow<VFloat>(lo) + VFloat(0);  // no zero is -0
    const unsigned known = bits(least == narrow<VFloat>(hi));
    store(t, select(mask_of(VUint(here)), least, load<VFloat>(t)));
    each_bit(lanes & ~known,
             [&](int k) { t[k] = rounded_t(g, given_ray(p, i + k), id_of(p.id[i + k])); });
  });
}

}  // namespace grelha::GRELHA_ISA
