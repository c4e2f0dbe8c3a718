#include "kernel/perspective/outline.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Times its box's sides, all three: from there on a primitive is as far away as the box.
constexpr double kFarInBoxes = 4;

using Vector = FacePoint;

Vector operator-(const Vector& a, const Vector& b) {
  return {
      a.p - b.p,
      a.q - b.q,
      a.r - b.r,
  };
}
double dot(const Vector& a, const Vector& b) {
  return a.p * b.p + a.q * b.q + a.r * b.r;
}
double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}
Vector cross(const Vector& a, const Vector& b) {
  return {
      a.q * b.r - a.r * b.q,
      a.r * b.p - a.p * b.r,
      a.p * b.q - a.q * b.p,
  };
}
Vector scaled(double s, const Vector& a) {
  return {
      s * a.p,
      s * a.q,
      s * a.r,
  };
}

template <class T>
Vector relative(const Viewpoint& from, const T (&x)[3]) {
  return {
      x[0] - from.at[0],
      x[1] - from.at[1],
      x[2] - from.at[2],
  };
}

/// Turned to the axes of a face.
Vector turned(const Vector& x, int face) {
  const double c[3] = {
      x.p,
      x.q,
      x.r,
  };
  const int a = face / 2;
  return {
      c[(a + 1) % 3],
      c[(a + 2) % 3],
      face % 2 == 0 ? c[a] : -c[a],
  };
}

double box_distance(const Box& box, const Viewpoint& from) {
  double far = 0;
  for (int a = 0; a < 3; ++a)
    far = std::max(far, std::max(box.lo[a] - from.at[a], from.at[a] - box.hi[a]));
  return far;
}

/// What a length is at least as the largest of three coordinates.
double as_largest(double length) {
  return length * .57735;
}

double distance(const Primitives& p, const Viewpoint& from, Triangle, std::uint32_t i) {
  const auto t = p.of<Triangle>()[i];
  const Vector a = relative(from, t.corner[0]);
  const Vector n = cross(relative(from, t.corner[1]) - a, relative(from, t.corner[2]) - a);
  const double size = length(n);
  return size > 0 ? as_largest(std::abs(dot(a, n)) / size) : 0;
}
double distance(const Primitives& p, const Viewpoint& from, Sphere, std::uint32_t i) {
  const auto s = p.of<Sphere>()[i];
  return as_largest(length(relative(from, s.center)) - std::abs(double{s.radius}));
}

/// The balls at the ends of a cone; it lies in their hull.
struct Ends {
  Vector center[2];
  double radius[2];
};
Ends ends_of(const Cone::Fields<float>& c, const Viewpoint& from) {
  Ends e;
  e.center[0] = relative(from, c.base);
  e.radius[0] = c.radius;
  const Vector axis{
      c.axis[0],
      c.axis[1],
      c.axis[2],
  };
  const double h = c.height;
  e.center[1] = e.center[0] - scaled(-h, axis);
  e.radius[1] = c.radius + static_cast<double>(c.slope) * h;
  return e;
}
double distance(const Primitives& p, const Viewpoint& from, Cone, std::uint32_t i) {
  const Ends e = ends_of(p.of<Cone>()[i], from);
  const Vector along = e.center[1] - e.center[0];
  const double size = dot(along, along);
  const double at = size > 0 ? std::clamp(-dot(e.center[0], along) / size, 0., 1.) : 0;
  const double axis = length(e.center[0] - scaled(-at, along));
  return as_largest(axis - std::max(e.radius[0], e.radius[1]));
}

/// Of other kinds that of their box has to do.
template <class Shape>
double distance(const Primitives&, const Viewpoint&, Shape, std::uint32_t) {
  return 0;
}

/// Widens the outline to a point's place, which has depth > 0.
void add(Outline& o, const Vector& x) {
  const double u = x.p / x.r;
  const double v = x.q / x.r;
  o.lo[0] = std::min(o.lo[0], u);
  o.hi[0] = std::max(o.hi[0], u);
  o.lo[1] = std::min(o.lo[1], v);
  o.hi[1] = std::max(o.hi[1], v);
  o.near = std::min(o.near, x.r);
  o.far = std::max(o.far, x.r);
}

void clear(Outline& o) {
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = 1e300;
    o.hi[j] = -1e300;
  }
  o.near = 1e300;
  o.far = -1e300;
  o.solid = false;
  for (HalfPlane& side : o.side)
    side = {};
}

/// Grows what add() has put together by what rays may miss it by, `aside` and along, and cuts it to
/// the face. False: nothing is left.
bool finish(Outline& o, double aside, double pad, double least) {
  const double grow = 2 * aside / (least - 2 * pad) * kRoom;
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = std::max(o.lo[j] - grow, -1 - kOverlap);
    o.hi[j] = std::min(o.hi[j] + grow, 1 + kOverlap);
    if (!(o.lo[j] <= o.hi[j]))
      return false;
  }
  o.near = std::max(o.near - pad, least - pad);
  o.far += pad;
  return true;
}

/// n: across the side, towards what is seen.
HalfPlane half_plane(const Vector& n, double size, double pad, double least) {
  return {
      n.p,
      n.q,
      n.r,
      pad * size / (least - pad) * kRoom,
  };
}

bool see(const Primitives& p,
         const Viewpoint& from,
         Triangle,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  const auto t = p.of<Triangle>()[i];
  Vector c[3];
  for (int k = 0; k < 3; ++k)
    c[k] = turned(relative(from, t.corner[k]), face);
  // Of the triangle what is deep enough; what rays meet may lie beside it.
  const double front = least - 2 * from.pad;
  const double aside = from.aside;
  if (c[0].r < front && c[1].r < front && c[2].r < front)
    return false;
  clear(o);
  for (int k = 0; k < 3; ++k) {
    const Vector &a = c[k], &b = c[(k + 1) % 3];
    if (a.r >= front)
      add(o, a);
    if ((a.r < front) != (b.r < front))
      add(o, a - scaled((front - a.r) / (a.r - b.r), b - a));
  }
  if (!(o.far >= front) || !finish(o, aside, from.pad, least))
    return false;
  o.solid = true;
  for (int k = 0; k < 3; ++k) {
    const Vector &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
    const Vector edge = b - a;
    const Vector n = cross(a, edge);
    const double square = dot(n, n);
    const double height = dot(n, c[k]);
    const double size = std::sqrt(square);
    // else seen from the edge, and no side of it is for sure
    o.solid &= std::abs(height) > kSolid * aside * size;
    if (!(square > kNarrowest * kNarrowest * dot(a, a) * dot(edge, edge)) || height == 0) {
      o.solid = false;
      continue;
    }
    o.side[k] = half_plane(height > 0 ? n : scaled(-1, n), size, aside, least);
  }
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
  add_ball(o, turned(relative(from, s.center), face), std::abs(double{s.radius}), front);
  return o.far >= front && finish(o, from.pad, from.pad, least);
}

/// Between which numbers something lies along each axis of a face.
struct FaceBox {
  double lo[3], hi[3];
};

/// What of a box may be met.
void add_box(Outline& o, const FaceBox& box, double front) {
  const double far = box.hi[2];
  if (!(far >= front))
    return;
  o.near = std::max(box.lo[2], front);
  o.far = far;
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = box.lo[j] / (box.lo[j] < 0 ? o.near : far);
    o.hi[j] = box.hi[j] / (box.hi[j] > 0 ? o.near : far);
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

/// A kind that has no outline of its own: its box.
template <class Shape>
bool see(const Primitives& p,
         const Viewpoint& from,
         Shape,
         std::uint32_t i,
         int face,
         double least,
         Outline& o) {
  const Box box = Shape::box(p.of<Shape>(), i);
  const Vector a = turned(relative(from, box.lo), face);
  const Vector b = turned(relative(from, box.hi), face);
  const double front = least - 2 * from.pad;
  clear(o);
  add_box(o, around({a, b}, {0, 0}), front);
  return o.far >= front && finish(o, from.pad, from.pad, least);
}

/// The planes through the point that touch both balls.
void add_sides(
    Outline& o, const Vector (&c)[2], const double (&radius)[2], double pad, double least) {
  // n = x c0 + y c1 +- z (c0 x c1), |n| = 1, n . c = radius at both ends
  const Vector across = cross(c[0], c[1] - c[0]);
  const double g00 = dot(c[0], c[0]);
  const double g01 = dot(c[0], c[1]);
  const double g11 = dot(c[1], c[1]);
  const double det = dot(across, across);
  if (!(det > kNarrowest * g00 * g11))
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
  o.side[0] = half_plane(in - scaled(-z, across), 1, pad, least);
  o.side[1] = half_plane(in - scaled(z, across), 1, pad, least);
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

double distance_of(const Primitives& p, const Viewpoint& from, std::uint32_t id, const Box& box) {
  const double by_box = box_distance(box, from);
  const double sides = (box.hi[0] - box.lo[0]) + (box.hi[1] - box.lo[1]) + (box.hi[2] - box.lo[2]);
  if (by_box > kFarInBoxes * sides)
    return by_box;
  return std::max(by_box, p.visit(id, [&]<class Shape>(std::uint32_t i) {
    return distance(p, from, Shape{}, i);
  }));
}

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

}  // namespace grelha
