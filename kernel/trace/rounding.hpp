#pragma once
// t of hits, rounded once: in double, side by side, and exactly where doubles cannot decide which
// float is nearest.

#include "kernel/walk/packet.hpp"

namespace grelha::GRELHA_ISA {

/// Fields of the primitives i as tests read them.
template <class Shape>
[[gnu::always_inline]] inline typename Shape::template Fields<Lanes> fields_at(
    const typename Shape::Arrays& all, const LaneWords& i) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    Triangle::Fields<Lanes> to;
    for (int k = 0; k < 3; ++k) {
      const LaneWords vertex = words_at(all.corner[k], i);
      for (int a = 0; a < 3; ++a)
        to.corner[k][a] = floats_at(all.vertex[a], vertex);
    }
    return to;
  } else {
    return gathered<Shape, Lanes>(all.fields, i);
  }
}

/// Spans of t, part after part; NaN where double does not tell.
template <class Shape, int k = 0>
[[gnu::always_inline]] inline void met_spans(const Packet& p,
                                             int i,
                                             const RayLanes<Lanes>& rays,
                                             const typename Shape::template Fields<Lanes>& met,
                                             DoubleLanes (&lo)[kWideParts<Lanes>],
                                             DoubleLanes (&hi)[kWideParts<Lanes>]) {
  using W = DoubleLanes;
  const W unknown(__builtin_nan(""));
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    const auto& c = met.corner;
    const Corners<W> corner{widen<k>(vec(c[0])), widen<k>(vec(c[1])), widen<k>(vec(c[2]))};
    const PlaneSpan<W> span = plane_span<W>(widen<k>(rays.org), widen<k>(rays.dir), corner);
    lo[k] = select(span.known, span.lo, unknown);
    hi[k] = span.hi;
  } else {
    const Found<W> found = [&]() __attribute__((always_inline)) {
      const auto wide = given_in_double<k>(rays);
      const auto primitive = widened<Shape, k, Lanes>(met);
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
  if constexpr (k + 1 < kWideParts<Lanes>)
    met_spans<Shape, k + 1>(p, i, rays, met, lo, hi);
}

/// A ray of a packet, with t counted as the caller does.
inline ExactRay as_it_came(const Packet& p, int i) {
  const ExactRay ray = p.given.ray(i);
  return p.has_units ? ray.in_units_of(1 / static_cast<double>(p.unit[i])) : ray;
}

/// t of the rays of a packet from i on that met primitives of the kinds of a set, to t[0] and on;
/// that of others stays.
template <class Set>
inline void round_hits(const Packet& p, int i, float* t) {
  const GeometryView& g = *p.geometry;
  const LaneWords id = ids_at(p, i);
  Set::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const std::uint32_t first = g.ids.begin(Shape::kKind);
    const auto here = id - first < g.ids.count(Shape::kKind);
    const unsigned lanes = lanes_where(here);
    if (lanes == 0)
      return;
    const LaneWords index(here ? id - first : LaneWords{});
    DoubleLanes lo[kWideParts<Lanes>], hi[kWideParts<Lanes>];
    met_spans<Shape>(p, i, ray_lanes(p, i), fields_at<Shape>(g.of<Shape>(), index), lo, hi);
    if (p.has_units) [[unlikely]]
      for (int k = 0; k < kWideParts<Lanes>; ++k) {
        const auto unit = take<DoubleLanes>(p.unit + i + k * kWidth<DoubleLanes>);
        lo[k] = lo[k] / unit;
        hi[k] = hi[k] / unit;
      }
    const Lanes least = narrow<Lanes>(lo) + Lanes(0);  // no zero is -0
    const unsigned known = bits(least == narrow<Lanes>(hi));
    store(t, select(mask_of(LaneWords(here)), least, load<Lanes>(t)));
    each_bit(lanes & ~known,
             [&](int k) { t[k] = rounded_t(g, as_it_came(p, i + k), id_of(p.id[i + k])); });
  });
}

}  // namespace grelha::GRELHA_ISA
