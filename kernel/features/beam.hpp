#pragma once
// A beam of four rays: the pyramid they span, which primitives reach into it, and where. A beam
// walks the grids as a packet does; what it finds is then asked for a point inside, so that the
// answer is a function of beam and scene, not of the grid.

#include "kernel/shapes/surface.hpp"
#include "kernel/features/tolerances.hpp"
#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kCorners = 4, kMostMet = 48;

struct Beam {
  Vec3<float> org[kCorners], dir[kCorners];  ///< around the beam, in order; unit directions
};

/// A beam as a pyramid over a parallelogram: its rays seem to come from the apex, and a point apex
/// + w (axis + x right + y up) lies inside when |x| and |y| are at most 1.
struct BeamFrame {
  Vec3<float> apex, axis, right, up;
  Vec3<float> to_x, to_y;  ///< x = dot(p, to_x) / dot(p, unit), p from the apex; y likewise
  Vec3<float> unit;        ///< the axis without what right and up add to it: w = dot(p, unit)
  float depth;             ///< w from which the whole beam is on its way: of its farthest origin
};

struct Sight {
  std::uint32_t id[kCorners];
  float t[kCorners];
};

inline Vec3<float> middle(const Vec3<float> (&p)[kCorners]) {
  return .25f * ((p[0] + p[1]) + (p[2] + p[3]));
}

/// False when the rays spread too far to be a beam.
inline bool frame_of(const Beam& b, BeamFrame& f) {
  const Vec3<float> org = middle(b.org);
  f.unit = normalize(middle(b.dir));
  if (!(f.unit.x == f.unit.x))
    return false;
  float offset = 0, growth = 0;
  for (int i = 0; i < kCorners; ++i) {
    const float along = dot(b.dir[i], f.unit);
    if (!(along > kNarrow))
      return false;
    const Vec3<float> o = b.org[i] - org, d = (1 / along) * b.dir[i] - f.unit;
    offset += length(o);
    growth += dot(o, d) > 0 || dot(o, o) == 0 ? length(d) : 0 - length(d);
  }
  // Rays that run together or keep apart have no apex behind them: one far away stands for it.
  f.depth = offset == 0  ? 0.f
            : growth > 0 ? lesser(offset / growth, kFarthestApex * offset)
                         : kFarthestApex * offset;
  f.apex = org - f.depth * f.unit;
  Vec3<float> c[kCorners];  // where the corner rays pierce w = 1
  for (int i = 0; i < kCorners; ++i) {
    // any place on a ray from the apex will do
    const Vec3<float> at = b.org[i] + (f.depth > 0 ? 0.f : 1.f) * b.dir[i] - f.apex;
    c[i] = (1 / dot(at, f.unit)) * at;
  }
  f.axis = middle(c);
  f.right = .25f * ((c[1] - c[0]) + (c[2] - c[3]));
  f.up = .25f * ((c[3] - c[0]) + (c[2] - c[1]));
  // along the axis: x = det(p, up, axis) / det(right, up, axis), over w
  const Vec3<float> n = cross(f.right, f.up);
  const float det = dot(n, f.axis);
  if (!(det * det > 0))
    return false;
  f.to_x = (1 / det) * cross(f.up, f.axis);
  f.to_y = (1 / det) * cross(f.axis, f.right);
  if (f.depth == 0)
    return true;
  float first = kInfinity, last = 0;
  for (int i = 0; i < kCorners; ++i) {
    const float w = dot(b.org[i] - f.apex, f.unit);
    first = lesser(w, first);
    last = greater(w, last);
  }
  // a slanting mirror: its corners are nearly its ends
  f.depth = last + kDepthMargin * (last - first);
  return true;
}

/// Place in the beam, see BeamFrame.
struct Place {
  float x, y, w;
};
inline Place place(const BeamFrame& f, const Vec3<float>& p) {
  const Vec3<float> d = p - f.apex;
  const float w = dot(d, f.unit);
  return {dot(d, f.to_x) / w, dot(d, f.to_y) / w, w};
}
/// How far out: at most 1 inside.
inline float outness(float x, float y) { return greater(magnitude(x), magnitude(y)); }

/// Point of least outness of the stretch between two points: least at an end, on a diagonal or
/// where it crosses an axis.
inline Place innermost(const Place& a, const Place& b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float at[6] = {
      0, 1, (a.y - a.x) / (dx - dy), (0 - (a.x + a.y)) / (dx + dy), (0 - a.x) / dx, (0 - a.y) / dy};
  Place best{a.x, a.y, outness(a.x, a.y)};
  for (const float t : at) {
    if (!(t >= 0) || !(t <= 1))
      continue;
    const float x = a.x + t * dx, y = a.y + t * dy, out = outness(x, y);
    if (out < best.w)
      best = {x, y, out};
  }
  return best;  // w: the outness
}

/// Point of a ball nearest to the axis.
inline Vec3<float> ball_point(const BeamFrame& f, const Vec3<float>& c, float r) {
  const Vec3<float> d = c - f.apex, off = d - (dot(d, f.axis) / dot(f.axis, f.axis)) * f.axis;
  const float far = length(off);
  return far <= r ? c - off : c - ((kRimShare * r) / far) * off;
}

/// Innermost point of a triangle; false when a corner lies behind the apex.
inline bool triangle_point(const BeamFrame& f, const Vec3<float> (&c)[3], Vec3<float>& out) {
  Place q[3];
  for (int i = 0; i < 3; ++i) {
    q[i] = place(f, c[i]);
    if (!(q[i].w > 0))
      return false;
  }
  int left = 0, right = 0;
  Place best{0, 0, kInfinity};
  for (int i = 0; i < 3; ++i) {
    const Place &a = q[i], &b = q[(i + 1) % 3];
    const float side = a.x * (b.y - a.y) - a.y * (b.x - a.x);
    left += side >= 0;
    right += side <= 0;
    const Place in = innermost(a, b);
    if (in.w < best.w)
      best = in;
  }
  if (left == 3 || right == 3)
    best = {0, 0, 0};
  const float mx = (1.f / 3) * ((q[0].x + q[1].x) + q[2].x),
              my = (1.f / 3) * ((q[0].y + q[1].y) + q[2].y);
  const float x = best.x + kOffEdge * (mx - best.x),
              y = best.y + kOffEdge * (my - best.y);  // off the edge
  const Vec3<float> n = cross(c[1] - c[0], c[2] - c[0]), dir = f.axis + x * f.right + y * f.up;
  const float t = dot(c[0] - f.apex, n) / dot(dir, n);
  if (!(t > 0) || !(t < kInfinity))
    return false;
  out = f.apex + t * dir;
  return true;
}

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

/// The same of what has a ball_toward() the beam's axis.
template <class Shape>
inline bool find_point_toward_ball(const typename Shape::Arrays& all,
                                   const BeamFrame& f,
                                   std::uint32_t i,
                                   float far,
                                   Vec3<float>& p) {
  const auto one = broadcast<Shape, float>(all.fields, i);
  const Ball<float> ball = ball_toward(one, f.apex, f.unit);
  const Place toward = place(f, ball_point(f, ball.center, ball.radius));
  if (!(toward.w > 0) || !(outness(toward.x, toward.y) <= 1))
    return false;
  const Vec3<float> dir = f.axis + toward.x * f.right + toward.y * f.up;
  const Vec3<float> org = f.apex + f.depth * dir;
  float t = 0;
  const bool hit = meet<float>({org, dir, 1 / dot(dir, dir), 0}, one, t);
  p = org + t * dir;
  return hit && f.depth + t < far;
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
