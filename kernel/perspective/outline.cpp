#include "kernel/perspective/outline.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/perspective/cone_ends.hpp"
#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Widens bounds to a point's place, which has depth > 0.
void add(Bounds& o, const Vector& x) {
  const double inverse = 1 / x.r;
  const double u = x.p * inverse;
  const double v = x.q * inverse;
  o.lo[0] = std::min(o.lo[0], u);
  o.hi[0] = std::max(o.hi[0], u);
  o.lo[1] = std::min(o.lo[1], v);
  o.hi[1] = std::max(o.hi[1], v);
  o.near = std::min(o.near, x.r);
  o.far = std::max(o.far, x.r);
}

void clear(Bounds& o) {
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = 1e300;
    o.hi[j] = -1e300;
  }
  o.near = 1e300;
  o.far = -1e300;
}
void clear_sides(Outline& o) {
  o.solid = false;
  for (HalfPlane& side : o.side)
    side = {};
}
void clear(Outline& o) {
  clear(static_cast<Bounds&>(o));
  clear_sides(o);
}

/// Grows what add() has put together by what rays may miss it by, `aside` and along, and cuts it to
/// the face. False: nothing is left.
bool finish(Bounds& o, double aside, double pad, double least) {
  const double grow = 2 * aside / (least - 2 * pad);
  bool some = true;
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = std::max(o.lo[j] - grow, -1.);
    o.hi[j] = std::min(o.hi[j] + grow, 1.);
    some &= o.lo[j] <= o.hi[j];
  }
  o.near = std::max(o.near - pad, least - pad);
  o.far += pad;
  return some;
}

/// What a side leaves open, over the length of its normal.
double side_margin(double pad, double least) {
  return pad / (least - pad);
}

/// n: across the side, towards what is seen.
HalfPlane half_plane(const Vector& n, double margin) {
  return {
      n.p,
      n.q,
      n.r,
      margin,
  };
}

/// Bounds of what of a triangle is deep enough. False: nothing is.
bool bound(Bounds& o, const Vector (&c)[3], double front) {
  clear(o);
  if (c[0].r >= front && c[1].r >= front && c[2].r >= front) {
    for (const Vector& corner : c)
      add(o, corner);
    return true;
  }
  for (int k = 0; k < 3; ++k) {
    const Vector &a = c[k], &b = c[(k + 1) % 3];
    if (a.r >= front)
      add(o, a);
    if ((a.r < front) != (b.r < front))
      add(o, a - scaled((front - a.r) / (a.r - b.r), b - a));
  }
  return o.far >= front;
}

/// What cross(a, edge) is off by, see kNormalRounding.
double normal_rounding(const Vector& a, const Vector& edge) {
  return kNormalRounding * std::sqrt(dot(a, a) * dot(edge, edge));
}

/// The sides of a triangle, where doubles tell on which side of each it lies.
void set_sides(Outline& o, const Vector (&c)[3], double margin) {
  // What the corners span with the point: each lies on one side of the plane of the others. Seen
  // from the edge, nobody knows on which.
  const Vector first = c[1] - c[0];
  const double volume = dot(cross(c[0], first), c[2]);
  const double unsure = normal_rounding(c[0], first) * length(c[2]);
  if (!(std::abs(volume) > unsure))
    return clear_sides(o);
  o.solid = true;
  for (int k = 0; k < 3; ++k) {
    const Vector& a = c[k];
    const Vector edge = c[k == 2 ? 0 : k + 1] - a;
    const Vector n = cross(a, edge);
    const double open = margin * length(n) + normal_rounding(a, edge);
    o.side[k] = half_plane(volume > 0 ? n : scaled(-1, n), open);
  }
}

bool see(const Primitives& p,
         const Viewpoint& from,
         Triangle,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  const auto t = p.of<Triangle>()[i];
  const FaceAxes axes(face);
  const Vector c[3] = {
      relative(from, t.corner[0], axes),
      relative(from, t.corner[1], axes),
      relative(from, t.corner[2], axes),
  };
  // what rays meet may lie beside the triangle
  if (!bound(o, c, least - 2 * from.pad) || !finish(o, from.aside, from.pad, least))
    return false;
  set_sides(o, c, side_margin(from.aside, least));
  return true;
}

/// Between which u (or v) a ball lies, by its tangents; false: not wholly in front.
bool tangents(double x, double depth, double radius, double& lo, double& hi) {
  const double across = depth * depth - radius * radius;
  if (!(depth > radius) || !(across > 0))
    return false;
  const double root = radius * std::sqrt(std::max(0., x * x + across));
  lo = std::min(lo, (x * depth - root) / across);
  hi = std::max(hi, (x * depth + root) / across);
  return true;
}

/// A ball of what may be met.
void add_ball(Outline& o, const Vector& c, double radius, double front) {
  const double near = std::max(c.r - radius, front);
  const double far = c.r + radius;
  if (!(far >= front))
    return;
  o.near = std::min(o.near, near);
  o.far = std::max(o.far, far);
  const double x[2] = {c.p, c.q};
  for (int j = 0; j < 2; ++j) {
    if (tangents(x[j], c.r, radius, o.lo[j], o.hi[j]))
      continue;
    const double least = x[j] - radius;
    const double most = x[j] + radius;
    o.lo[j] = std::min(o.lo[j], least / (least < 0 ? near : far));
    o.hi[j] = std::max(o.hi[j], most / (most > 0 ? near : far));
  }
}

bool see(const Primitives& p,
         const Viewpoint& from,
         Sphere,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  const auto s = p.of<Sphere>()[i];
  const double front = least - 2 * from.pad;
  clear(o);
  add_ball(o, relative(from, s.center, FaceAxes(face)), std::abs(double{s.radius}), front);
  return o.far >= front && finish(o, from.pad, from.pad, least);
}

/// Between which numbers something lies along each axis of a face.
struct FaceBox {
  double lo[3], hi[3];
};

/// What of a box may be met.
void add_box(Bounds& o, const FaceBox& box, double front) {
  const double far = box.hi[2];
  if (!(far >= front))
    return;
  o.near = std::max(box.lo[2], front);
  o.far = far;
  const double at_near = 1 / o.near;
  const double at_far = 1 / far;
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = box.lo[j] * (box.lo[j] < 0 ? at_near : at_far);
    o.hi[j] = box.hi[j] * (box.hi[j] > 0 ? at_near : at_far);
  }
}

FaceBox around(const Vector (&c)[2], const double (&radius)[2]) {
  FaceBox box;
  const double at[2][3] = {
      {c[0].p, c[0].q, c[0].r},
      {c[1].p, c[1].q, c[1].r},
  };
  for (int a = 0; a < 3; ++a) {
    box.lo[a] = std::min(at[0][a] - radius[0], at[1][a] - radius[1]);
    box.hi[a] = std::max(at[0][a] + radius[0], at[1][a] + radius[1]);
  }
  return box;
}

/// What of a box may be met.
bool see_box(const Box& box, const Viewpoint& from, int face, double least, Bounds& o) {
  const FaceAxes axes(face);
  const Vector a = relative(from, box.lo, axes);
  const Vector b = relative(from, box.hi, axes);
  const double front = least - 2 * from.pad;
  clear(o);
  add_box(o, {{a.p, a.q, std::min(a.r, b.r)}, {b.p, b.q, std::max(a.r, b.r)}}, front);
  return o.far >= front && finish(o, from.pad, from.pad, least);
}

/// A kind that has no outline of its own: its box.
template <class Shape>
bool see(const Primitives& p,
         const Viewpoint& from,
         Shape,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  clear(o);
  return see_box(Shape::box(p.of<Shape>(), i), from, face, least, o);
}

/// Whether all of a kind's outline lies within that of its box.
template <class Shape>
constexpr bool kWithinItsBox = true;
template <>
constexpr bool kWithinItsBox<Cone> = false;  // its ends are balls

/// The planes through the point that touch both balls.
void add_sides(
    Outline& o, const Vector (&c)[2], const double (&radius)[2], double pad, double least) {
  // n = x c0 + y c1 +- z (c0 x c1), |n| = 1, n . c = radius at both ends
  const Vector across = cross(c[0], c[1] - c[0]);
  const double g00 = dot(c[0], c[0]);
  const double g01 = dot(c[0], c[1]);
  const double g11 = dot(c[1], c[1]);
  const double det = dot(across, across);
  if (!(det > kNarrowestCone * g00 * g11))
    return;
  const double r0 = radius[0] + pad;
  const double r1 = radius[1] + pad;
  const double x = (r0 * g11 - r1 * g01) / det;
  const double y = (r1 * g00 - r0 * g01) / det;
  const Vector in = scaled(x, c[0]) - scaled(-y, c[1]);
  const double rest = 1 - dot(in, in);
  if (!(rest > 0))
    return;
  const double z = std::sqrt(rest / det);
  o.side[0] = half_plane(in - scaled(-z, across), side_margin(pad, least));
  o.side[1] = half_plane(in - scaled(z, across), side_margin(pad, least));
}

bool see(const Primitives& p,
         const Viewpoint& from,
         Cone,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  const Ends e = ends_of(p.of<Cone>()[i], from);
  const double front = least - 2 * from.pad;
  const Vector c[2] = {
      turned(e.center[0], face),
      turned(e.center[1], face),
  };
  clear(o);
  const bool whole = c[0].r - e.radius[0] >= front && c[1].r - e.radius[1] >= front;
  if (whole) {
    add_ball(o, c[0], e.radius[0], front);
    add_ball(o, c[1], e.radius[1], front);
  } else {
    add_box(o, around(c, e.radius), front);
  }
  if (!(o.far >= front) || !finish(o, from.pad, from.pad, least))
    return false;
  add_sides(o, c, e.radius, from.pad, least);
  return true;
}

}  // namespace

bool see(const Primitives& p,
         const Viewpoint& from,
         std::uint32_t id,
         int face,
         double distance,
         Outline& outline) {
  return p.visit(id, [&]<class Shape>(std::uint32_t i) {
    return see(p, from, Shape{}, i, face, distance, outline);
  });
}

bool see_about(const Primitives& p,
               const Viewpoint& from,
               std::uint32_t id,
               const Box& box,
               int face,
               double distance,
               Bounds& bounds) {
  return p.visit(id, [&]<class Shape>(std::uint32_t i) {
    if constexpr (kWithinItsBox<Shape>)
      return see_box(box, from, face, distance, bounds);
    Outline outline;
    const bool some = see(p, from, Shape{}, i, face, distance, outline);
    bounds = outline;
    return some;
  });
}

}  // namespace grelha
