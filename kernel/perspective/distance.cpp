#include "kernel/perspective/distance.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/perspective/cone_ends.hpp"

namespace grelha {
namespace {

/// Times its box's sides, all three: from there on a primitive is as far away as the box.
constexpr double kFarInBoxes = 4;

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

unsigned faces_of(const Box& box, const Viewpoint& from) {
  double lo[3], hi[3], away[3];  // along each axis, from the point
  for (int a = 0; a < 3; ++a) {
    lo[a] = box.lo[a] - from.at[a];
    hi[a] = box.hi[a] - from.at[a];
    away[a] = std::max(lo[a], -hi[a]);
  }
  unsigned faces = 0;
  for (int a = 0; a < 3; ++a) {
    const double beside = std::max(away[(a + 1) % 3], away[(a + 2) % 3]);
    const double least = std::max(beside, 0.) - 4 * from.pad;
    faces |= (hi[a] >= least ? 1u : 0u) << (2 * a);
    faces |= (-lo[a] >= least ? 1u : 0u) << (2 * a + 1);
  }
  return faces;
}

}  // namespace grelha
