#pragma once
// Eight primitives at a time, as a point sees them.

#include <type_traits>

#include "kernel/perspective/in_tiles.hpp"
#include "kernel/perspective/look_loops.hpp"

namespace grelha::GRELHA_ISA {

/// Spheres are listed with boxes around what they look like, all other kinds with three sides.
template <class Shape>
inline constexpr bool kHasSides = !std::is_same_v<Shape, Sphere>;
/// Whether all of a kind's outline lies within that of its box.
template <class Shape>
inline constexpr bool kWithinItsBox = !std::is_same_v<Shape, Cone>;  // its ends are balls

/// What tests see of some primitives of a kind, in rows.
template <class Shape>
class FewFields {
 public:
  template <class Real>
  using Fields = typename Shape::template Fields<Real>;

  FewFields(const Primitives& p, const Few& few)
      : all_(p.of<Shape>()), few_(few), first_(p.ids.begin(Shape::kKind)) {
    for (int k = 0; k < kOutlines; ++k) {
      const Fields<float> one = all_[few.at(k) - first_];
      int row = 0;
      Shape::for_each_field([&](const float& x) { rows_[row++][k] = x; }, one);
    }
  }
  template <class Real>
  Fields<Real> from(int i) const {
    Fields<Real> fields;
    int row = 0;
    Shape::for_each_field([&](Real& x) { x = take<Real>(rows_[row++] + i); }, fields);
    return fields;
  }
  template <class Real>
  BoxAround<Real> box(const Viewpoint& from, const Fields<Real>& fields, int i) const {
    if constexpr (requires { box_around(from, fields); })
      return box_around(from, fields);
    else
      return box_of_source<Real>(from, i);
  }

 private:
  template <class Real>
  BoxAround<Real> box_of_source(const Viewpoint& from, int i) const {
    double at[6][kWidth<Real>];
    for (int k = 0; k < kWidth<Real>; ++k) {
      const Box b = Shape::box(all_, few_.at(i + k) - first_);
      for (int a = 0; a < 3; ++a) {
        at[a][k] = b.lo[a];
        at[a + 3][k] = b.hi[a];
      }
    }
    const Real lo[3] = {
        load<Real>(at[0]),
        load<Real>(at[1]),
        load<Real>(at[2]),
    };
    const Real hi[3] = {
        load<Real>(at[3]),
        load<Real>(at[4]),
        load<Real>(at[5]),
    };
    return {relative(from, lo), relative(from, hi)};
  }

  const typename Shape::Source& all_;
  const Few& few_;
  std::uint32_t first_;
  alignas(64) float rows_[sizeof(Fields<float>) / sizeof(float)][kOutlines];
};

/// Lanes from i on with a bit in `chosen`.
template <class Real>
inline Mask<Real> lanes_of(unsigned chosen, int i) {
  double flags[kWidth<Real>];
  for (int k = 0; k < kWidth<Real>; ++k)
    flags[k] = chosen >> (i + k) & 1;
  return load<Real>(flags) > Real(0);
}

/// Adds what of lanes from i on is seen through a face to its window.
template <class Real>
inline void add(WindowRows& w, const Bounds<Real>& o, const Mask<Real>& to, int i) {
  const auto change = [&](double* row, const Real& with) {
    const Real held = load<Real>(row + i);
    store(row + i, select(to, with, held));
  };
  Real size[2];
  for (int j = 0; j < 2; ++j) {
    size[j] = o.hi[j] - o.lo[j];
    change(w.lo[j], lesser(load<Real>(w.lo[j] + i), o.lo[j]));
    change(w.hi[j], greater(load<Real>(w.hi[j] + i), o.hi[j]));
    change(w.across[j], load<Real>(w.across[j] + i) + size[j]);
  }
  change(w.area, load<Real>(w.area + i) + size[0] * size[1]);
  w.seen += static_cast<unsigned>(__builtin_popcount(bits(to)));
}
template <class Real>
inline void add_depth(WindowRows& w, const Bounds<Real>& o, const Mask<Real>& to, int i) {
  const Real held = load<Real>(w.near + i);
  store(w.near + i, select(to, lesser(held, o.near), held));
}

/// Some primitives at a first look.
template <class Shape>
class Survey {
 public:
  Survey(const Primitives& p, const Viewpoint& from, const Few& few, unsigned large)
      : from_(from), fields_(p, few), count_(few.count), large_(large) {}

  void run(WindowRows (&window)[kFaces], Glance* glances) const {
    for (int i = 0; i < count_; i += kWidth<DoubleLanes>)
      look<DoubleLanes>(i, window, glances);
  }

 private:
  template <class Real>
  void look(int i, WindowRows (&window)[kFaces], Glance* glances) const {
    const auto fields = fields_.template from<Real>(i);
    const BoxAround<Real> box = fields_.box(from_, fields, i);
    float distance[kWidth<Real>];
    store_not_above(distance, distance_of(from_, fields, box));
    for (int k = 0; k < kWidth<Real> && i + k < count_; ++k)
      glances[i + k] = {distance[k], 0};
    Mask<Real> towards[kFaces];
    faces_of(from_, box, towards);
    const Real least = take<Real>(distance);
    const Mask<Real> has_outline =
        both(least > Real(kNearest * from_.pad), lanes_of<Real>((1u << count_) - 1, i));
    for (int f = 0; f < kFaces; ++f) {
      const Mask<Real> asked = both(has_outline, towards[f]);
      if (none(asked))
        continue;
      const Look<Real> through{from_, FaceAxes(f), least};
      const unsigned seen = add_seen(through, fields, box, asked, i, window[f]);
      each_bit(seen, [&](int k) { glances[i + k].faces |= 1u << f; });
    }
  }

  /// Returns bits of the lanes of which something is seen through a face.
  template <class Real, class Fields>
  unsigned add_seen(const Look<Real>& through,
                    const Fields& fields,
                    const BoxAround<Real>& box,
                    const Mask<Real>& asked,
                    int i,
                    WindowRows& window) const {
    Outline<Real> o;
    Mask<Real> seen = asked;
    if constexpr (kWithinItsBox<Shape>)
      seen = both(asked, see_box(through, box, o));
    else
      seen = both(asked, see(through, fields, o));
    add_depth(window, o, seen, i);
    add(window, o, large_ == 0 ? seen : but_not(seen, lanes_of<Real>(large_, i)), i);
    window.large += static_cast<unsigned>(__builtin_popcount(bits(seen) & large_ >> i));
    return bits(seen);
  }

  const Viewpoint& from_;
  FewFields<Shape> fields_;
  int count_;
  unsigned large_;
};

inline void survey(const Primitives& p,
                   const Viewpoint& from,
                   const Few& few,
                   unsigned large,
                   WindowRows (&window)[kFaces],
                   Glance* glances) {
  p.visit(few.id[0], [&]<class Shape>(std::uint32_t) {
    Survey<Shape>(p, from, few, large).run(window, glances);
  });
}

/// Outlines of lanes from i on through a face, or boxes around these. Returns bits of those seen.
template <class Shape, class Real>
inline unsigned see_lanes(const FewFields<Shape>& few,
                          const Look<Real>& look,
                          const PointFace& tiles,
                          int i,
                          SeenFew& to) {
  const auto fields = few.template from<Real>(i);
  std::conditional_t<kHasSides<Shape>, Outline<Real>, Bounds<Real>> o;
  Mask<Real> seen = no_lane<Real>();
  if constexpr (requires { see(look, fields, o); }) {
    seen = see(look, fields, o);
  } else {  // a kind that has no outline of its own
    seen = see_box(look, few.box(look.from, fields, i), o);
    o.solid = no_lane<Real>();
  }
  to_tiles(tiles, o);
  keep(tiles, o, i, to);
  return bits(seen);
}

inline void see(const Primitives& p,
                const Viewpoint& from,
                const Few& few,
                const float (&distance)[kOutlines],
                int face,
                const PointFace& tiles,
                SeenFew& to) {
  to.seen = 0;
  to.on_tiles = 0;
  p.visit(few.id[0], [&]<class Shape>(std::uint32_t) {
    const FewFields<Shape> fields(p, few);
    to.sided = kHasSides<Shape>;
    for (int i = 0; i < few.count; i += kWidth<DoubleLanes>) {
      const Look<DoubleLanes> look{from, FaceAxes(face), take<DoubleLanes>(distance + i)};
      to.seen |= see_lanes<Shape>(fields, look, tiles, i, to) << i;
    }
  });
  to.seen &= (1u << few.count) - 1;
}

inline void rank(const std::uint32_t* depths,
                 const std::uint32_t* ids,
                 std::uint32_t count,
                 std::uint32_t* ranks) {
  const LaneWords none = {};
  const LaneWords one = none + 1u;
  for (std::uint32_t i = 0; i < count; i += kLanes) {
    const LaneWords depth = load_words<Lanes>(depths + i);
    const LaneWords id = load_words<Lanes>(ids + i);
    LaneWords before = none;
    for (std::uint32_t j = 0; j < count; ++j) {
      const LaneWords other = none + depths[j];
      const LaneWords first = none + ids[j] < id ? one : none;
      before = before + (other < depth ? one : other == depth ? first : none);
    }
    store_words(ranks + i, before);
  }
}

}  // namespace grelha::GRELHA_ISA
