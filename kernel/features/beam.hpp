#pragma once
// Which primitives reach into a beam, and where. A beam walks the grids as a packet does; what it
// finds is then asked for a point inside, so that the answer is a function of beam and scene, not
// of the grid.

#include "kernel/features/beam_frame.hpp"
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

/// A point of a triangle inside the beam, nearer than w = `far`; false when it has none.
inline bool find_point(const Triangle::Arrays& triangles,
                       const BeamFrame& f,
                       std::uint32_t i,
                       float far,
                       Vec3<float>& p) {
  if (!triangle_point(f, triangle_corners(triangles, i).at, p))
    return false;
  const Place at = place(f, p);
  return at.w > f.depth && at.w < far && outness(at.x, at.y) <= 1;
}

/// Whether a ray of the beam to a place meets one primitive nearer than w = `far`, and where.
template <class Fields>
inline bool meets_toward(
    const BeamFrame& f, const Vec3<float>& at, const Fields& one, float far, Vec3<float>& p) {
  if (!is_inside(f, at))
    return false;
  const Place toward = place(f, at);
  const Vec3<float> dir = f.axis + toward.x * f.right + toward.y * f.up;
  const Vec3<float> org = f.apex + f.depth * dir;
  float t = 0;
  const bool hit = meet<float>({org, dir, 1 / dot(dir, dir), 0}, one, t);
  p = org + t * dir;
  return hit && f.depth + t < far;
}

/// The same of what has a ball_toward() the beam's axis. Of what is not all in such a ball, places
/// on its surface are tried first: where the ball is an end of it, a ray that just meets that may
/// miss it when it is sent again.
template <class Shape>
inline bool find_point_toward_ball(const typename Shape::Arrays& all,
                                   const BeamFrame& f,
                                   std::uint32_t i,
                                   float far,
                                   Vec3<float>& p) {
  const auto one = broadcast<Shape, float>(all.fields, i);
  if constexpr (requires { surface_places(one); }) {
    const auto places = surface_places(one);
    for (int which = 0; which < places.kCount; ++which)
      if (meets_toward(f, places[which], one, far, p))
        return true;
  }
  const Ball<float> ball = ball_toward(one, f.apex, f.unit);
  return meets_toward(f, ball_point(f, ball.center, ball.radius), one, far, p);
}

/// A point of a primitive's surface inside the beam, nearer than w = `far`; false when it has none
/// that this finds. The point lies in a cell that lists the primitive and that the beam walks
/// through, whatever the grid.
[[gnu::noinline]] inline bool meets(
    const SceneView& scene, const BeamFrame& f, std::uint32_t id, float far, Vec3<float>& p) {
  const GeometryView& g = scene.geometry;
  const auto find = [&]<class Shape>(std::uint32_t i) __attribute__((always_inline)) {
    if constexpr (!Shape::kFinite)
      return false;  // it ends nowhere inside a beam: the corners see it
    else if constexpr (Shape::kInBlocks)
      return find_point(g.of<Shape>(), f, i, far, p);
    else
      return find_point_toward_ball<Shape>(g.of<Shape>(), f, i, far, p);
  };
  return visit_shape(Shapes{}, g.ids, id, find);
}

/// The primitives, other than those of `known`, that meet() a beam; each once.
struct Met {
  std::uint32_t id[kMostMet];
  Vec3<float> point[kMostMet];
  int size = 0;
  bool full = false;  ///< there were more
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
    for (std::uint32_t b = list.first[cell]; b < list.first[cell + 1]; ++b)
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
/// False when no frustum holds the beam's edges.
template <class See>
inline bool walk_beam(
    const GridView& g, const WalkingRays& p, int axis, const See& see, Counters& n) {
  Frustum f;
  const Coherence edges = bound_rays(g, p, f, axis);
  if (edges != Coherence::kTogether)
    return edges == Coherence::kMisses;
  BeamVisit<See> visit(g, f, see);
  walk_frustum(g, f, n, visit);
  return true;
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
