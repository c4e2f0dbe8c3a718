#pragma once
// Which primitives reach into a beam, and where. A beam walks the grids as a packet does; what it
// finds is then asked for a point inside, so that the answer is a function of beam and scene, not
// of the grid.

#include "kernel/features/beam_clip.hpp"
#include "kernel/shapes/surface.hpp"
#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kMostMet = 48;

struct Corners3 {
  Vec3<float> at[3];
};
inline Corners3 triangle_corners(const Triangle::Arrays& triangles, std::uint32_t i) {
  Corners3 c;
  for (int k = 0; k < 3; ++k)
    c.at[k] = three_at(triangles.vertex, triangles.corner[k][i]);
  return c;
}

/// What of a primitive lies within a beam.
struct PartInBeam {
  Vec3<float> point;  ///< of its surface, one that a ray may be sent to
  BeamBox box;        ///< all of it that is seen
};

/// Of a triangle, nearer than w = `far`; false when there is none.
inline bool find_part(const Triangle::Arrays& triangles,
                      const BeamFrame& f,
                      std::uint32_t i,
                      float far,
                      PartInBeam& part) {
  BeamPolygon polygon(f, triangle_corners(triangles, i).at);
  if (!polygon.keep({f.depth, far}))
    return false;
  part.point = point_of(f, polygon.middle());
  for (int k = 0; k < polygon.size(); ++k)
    part.box.add(polygon[k].x / polygon[k].w, polygon[k].y / polygon[k].w);
  return true;
}

/// Whether the ray of the beam through a place meets one primitive nearer than w = `far`, and
/// where.
template <class Fields>
inline bool meets_through(
    const BeamFrame& f, float x, float y, const Fields& one, float far, Vec3<float>& p) {
  const Vec3<float> dir = f.axis + x * f.right + y * f.up;
  const Vec3<float> org = f.apex + f.depth * dir;
  float t = 0;
  const bool hit = meet<float>({org, dir, 1 / dot(dir, dir), 0}, one, t);
  p = org + t * dir;
  return hit && f.depth + t < far;
}
/// The same of the ray to a point, where that lies within the beam.
template <class Fields>
inline bool meets_toward(
    const BeamFrame& f, const Vec3<float>& at, const Fields& one, float far, Vec3<float>& p) {
  if (!is_inside(f, at))
    return false;
  const Place toward = place(f, at);
  return meets_through(f, toward.x, toward.y, one, far, p);
}
/// The same of the ray through the place nearest to that of a point before the apex.
template <class Fields>
inline bool meets_beside(
    const BeamFrame& f, const BeamPoint& at, const Fields& one, float far, Vec3<float>& p) {
  if (!(at.w > 0))
    return false;
  const auto within = [](float x) {
    return x < -kRimShare ? -kRimShare : x > kRimShare ? kRimShare : x;
  };
  return meets_through(f, within(at.x / at.w), within(at.y / at.w), one, far, p);
}

/// Of what has a ball_toward() the beam's axis.
template <class Fields>
inline bool find_part_toward_ball(const Fields& one,
                                  const BeamFrame& f,
                                  float far,
                                  PartInBeam& part) {
  const Ball<float> ball = ball_toward(one, f.apex, f.unit);
  const BeamPoint center = in_beam(f, ball.center);
  part.box.add_ball(f, center, ball.radius);
  return meets_beside(f, center, one, far, part.point) ||
         meets_toward(f, ball_point(f, ball.center, ball.radius), one, far, part.point);
}

/// Of a kind that lies around a stretch, as far from it as ball_toward() says at most. Rays go to
/// the middle of what of the stretch lies within the beam, to places beside what lies around it,
/// then to places on the surface: where none finds it a corner may still reach in.
template <class Fields>
inline bool find_part_along(const Fields& one, const BeamFrame& f, float far, PartInBeam& part) {
  const Stretch<float> stretch = stretch_of(one);
  BeamPoint a = in_beam(f, stretch.end[0]);
  BeamPoint b = in_beam(f, stretch.end[1]);
  const float widest = stretch.radius * greater(length(f.to_x), length(f.to_y));
  const float from = greater(f.depth, .5f * greater(greater(a.w, b.w), 0.f) * 1e-3f);
  BeamPoint in[2] = {a, b};
  const bool crosses = clip({f.depth, far}, in[0], in[1]);
  // around the beam, as wide as what may reach into it
  if (!clip({from, kInfinity, 1 + widest / greater(lesser(a.w, b.w), from)}, a, b))
    return false;
  part.box.add_ball(f, a, stretch.radius);
  part.box.add_ball(f, b, stretch.radius);
  if (crosses && meets_beside(f, between(in[0], in[1], .5f), one, far, part.point))
    return true;
  for (const float t : {.5f, .25f, .75f, .05f, .95f})
    if (meets_beside(f, between(a, b, t), one, far, part.point))
      return true;
  const auto places = surface_places(one);
  for (int which = 0; which < places.kCount; ++which)
    if (meets_toward(f, places[which], one, far, part.point))
      return true;
  const Ball<float> ball = ball_toward(one, f.apex, f.unit);
  return meets_toward(f, ball_point(f, ball.center, ball.radius), one, far, part.point);
}

/// What of a primitive lies within the beam, nearer than w = `far`; false when that finds nothing.
/// Its point lies in a cell that lists the primitive and that the beam walks through, whatever the
/// grid.
[[gnu::noinline]] inline bool meets(
    const SceneView& scene, const BeamFrame& f, std::uint32_t id, float far, PartInBeam& part) {
  const GeometryView& g = scene.geometry;
  const auto find = [&]<class Shape>(std::uint32_t i) __attribute__((always_inline)) {
    if constexpr (!Shape::kFinite) {
      return false;  // it ends nowhere inside a beam: the corners see it
    } else if constexpr (Shape::kInBlocks) {
      return find_part(g.of<Shape>(), f, i, far, part);
    } else {
      const auto one = broadcast<Shape, float>(g.of<Shape>().fields, i);
      if constexpr (requires { stretch_of(one); })
        return find_part_along(one, f, far, part);
      else
        return find_part_toward_ball(one, f, far, part);
    }
  };
  return visit_shape(Shapes{}, g.ids, id, find);
}

/// Whether two finite primitives are the same but for id and material, bit for bit. Grids list the
/// first of such alone where cells are crowded, which is for nobody to see.
inline bool are_copies(const GeometryView& g, std::uint32_t a, std::uint32_t b) {
  const auto compare = [&]<class Shape>(std::uint32_t i) __attribute__((always_inline)) {
    if (!g.ids.has(Shape::kKind, b))
      return false;
    const std::uint32_t k = b - g.ids.begin(Shape::kKind);
    const auto equal = [](const auto& x, const auto& y) {
      return __builtin_memcmp(&x, &y, sizeof x) == 0;
    };
    if constexpr (Shape::kInBlocks)
      return equal(triangle_corners(g.of<Shape>(), i), triangle_corners(g.of<Shape>(), k));
    else
      return equal(broadcast<Shape, float>(g.of<Shape>().fields, i),
                   broadcast<Shape, float>(g.of<Shape>().fields, k));
  };
  return visit_shape(FiniteShapes{}, g.ids, a, compare);
}

/// The primitives, other than those of `known`, that meet() a beam; each once, copies none.
struct Met {
  std::uint32_t id[kMostMet];
  PartInBeam part[kMostMet];
  int size = 0;
  bool full = false;  ///< there were more

  /// By their ids: grids find them in orders of their own.
  void sort() {
    for (int i = 1; i < size; ++i) {
      const std::uint32_t new_id = id[i];
      const PartInBeam new_part = part[i];
      int to = i;
      for (; to > 0 && new_id < id[to - 1]; --to) {
        id[to] = id[to - 1];
        part[to] = part[to - 1];
      }
      id[to] = new_id;
      part[to] = new_part;
    }
  }
};

/// A beam in a grid: tells see(id) of the primitives that reach into its frustum, some more than
/// once.
template <class See>
class BeamVisit {
 public:
  BeamVisit(const GridView& g, const Frustum& f, const See& see)
      : lists_(g.lists), f_(f), see_(see) {
    held_.clear();
  }
  bool enter(int, const CellRect&) const { return true; }
  bool leave(int) const { return true; }

  void look(std::size_t cell) {
    CellShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
      const typename Shape::CellList& list = lists_.of<Shape>();
      if (list.first)
        look_into(list, cell);
    });
  }

 private:
  void look_into(const Triangle::CellList& list, std::size_t cell) {
    const auto [first, end] = list.blocks_of(cell);
    for (std::uint32_t b = first; b < end; ++b)
      each_inside_block(f_, list.blocks[b], [&](int i) { once(list.blocks[b].id[i]); });
  }
  template <class Fields>
  void look_into(const CellArrays<Fields>& list, std::size_t cell) {
    each_inside(f_, list, cell, [&](std::uint32_t i) { once(list.id[i]); });
  }

  void once(std::uint32_t id) {
    if (!held_.seen(id))
      see_(id);
  }

  const CellLists& lists_;
  const Frustum& f_;
  const See& see_;
  Mailbox held_;
};

/// Calls see(id) for every primitive whose bounds the beam meets in this grid, some more than once.
/// One frustum holds its edges along the axis where it goes farthest: they lie within kNarrow of
/// it, 3.6 degrees, and 20 would do for kLeastProgress.
template <class See>
inline void walk_beam(
    const GridView& g, const WalkingRays& p, int axis, const See& see, Counters& n) {
  Frustum f;
  if (bound_rays(g, p, f, axis) == Coherence::kMisses)
    return;
  BeamVisit<See> visit(g, f, see);
  walk_frustum(g, f, n, visit);
}

template <class See>
inline void see_all(const Triangle::CellList& list, const See& see) {
  for (std::uint32_t b = 0; b < list.first[1]; ++b) {
    const TriangleBlock& block = list.blocks[b];
    for (int i = 0; i < kBlock && block.a[0][i] == block.a[0][i]; ++i)
      see(block.id[i]);
  }
}
template <class Fields, class See>
inline void see_all(const CellArrays<Fields>& list, const See& see) {
  for (std::uint32_t i = 0; i < list.first[1]; ++i)
    see(list.id[i]);
}

/// Every primitive of the list without a grid.
template <class See>
inline void see_outside(const CellLists& lists, const See& see) {
  CellShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    if (list.first)
      see_all(list, see);
  });
}

}  // namespace grelha::GRELHA_ISA
