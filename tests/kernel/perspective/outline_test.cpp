// Outlines against long doubles: no place of a primitive lies outside of its own, however far away
// and however much from the edge it is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/perspective/look.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

struct Exact {
  long double x[3];
};

Exact exact(const Float3& p) {
  return {p.x, p.y, p.z};
}
Exact between(const Exact& a, const Exact& b, long double share) {
  Exact r;
  for (int k = 0; k < 3; ++k)
    r.x[k] = a.x[k] + share * (b.x[k] - a.x[k]);
  return r;
}
Exact between(const Float3& a, const Float3& b, double share) {
  return between(exact(a), exact(b), share);
}

/// The face that a place is seen through from `at`, and where.
struct Place {
  int face;
  long double u, v;
};
Place place_of(const Exact& x, const double (&at)[3]) {
  long double d[3];
  for (int k = 0; k < 3; ++k)
    d[k] = x.x[k] - at[k];
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::abs(d[k]) > std::abs(d[axis]))
      axis = k;
  const long double depth = std::abs(d[axis]);
  return {2 * axis + (d[axis] < 0), d[(axis + 1) % 3] / depth, d[(axis + 2) % 3] / depth};
}

using Outline = scalar::Outline<double>;

/// What the worst side lacks of letting a place in; 0: nothing.
long double lacking(const Outline& o, const Place& p) {
  long double most = 0;
  for (const scalar::HalfPlane<double>& s : o.side)
    most = std::max(most, -s.margin - (s.a * p.u + s.b * p.v + s.c));
  return most;
}

/// Expects places of primitive 0 within its outline.
template <class Shape>
void expect_held(const Scene& scene, const Viewpoint& from, const std::vector<Exact>& places) {
  const Primitives p(scene.geometry);
  const Few one{{0}, 1};
  const scalar::FewFields<Shape> fields(p, one);
  const auto shape = fields.template from<double>(0);
  const double distance = scalar::distance_of(from, shape, fields.box(from, shape, 0));
  if (distance <= kNearest * from.pad)
    return;  // it has none
  for (const Exact& x : places) {
    const Place place = place_of(x, from.at);
    Outline seen;
    ASSERT_TRUE(scalar::see({from, FaceAxes(place.face), distance}, shape, seen));
    ASSERT_EQ(lacking(seen, place), 0);
  }
}

/// A float near `far` times a direction.
Float3 along(const Float3& way, double far) {
  return {static_cast<float>(way.x * far),
          static_cast<float>(way.y * far),
          static_cast<float>(way.z * far)};
}
Float3 sum(const Float3& a, const Float3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

class Outlines : public testing::TestWithParam<double> {};

/// Edges that nearly point at the viewer, with nothing allowed for but the rounding of doubles.
TEST_P(Outlines, HoldTrianglesByTheirSides) {
  const double far = GetParam();
  Random random(51);
  for (int i = 0; i < 3000; ++i) {
    const Float3 way = random.direction();
    const Float3 at = along(way, far);
    const Float3 a = random.point(1);
    const Float3 b =
        sum(a, sum(along(way, random.in(.1, 1)), random.point(random.log_in(1e-7, 1))));
    const Float3 c = sum(a, random.point(random.log_in(1e-3, 1)));
    std::vector<Exact> places;
    for (const double share : {0., .3, 1.})
      places.insert(places.end(), {between(a, b, share), between(b, c, share)});
    expect_held<Triangle>(one_triangle(a, b, c), {{at.x, at.y, at.z}, 1e-7, 0}, places);
    if (HasFatalFailure())
      FAIL() << i;
  }
}

Float3 moved_towards(const Float3& p, const Float3& to, double by) {
  const double x = double{to.x} - p.x;
  const double y = double{to.y} - p.y;
  const double z = double{to.z} - p.z;
  const double share = by / std::sqrt(x * x + y * y + z * z);
  return {static_cast<float>(p.x + share * x),
          static_cast<float>(p.y + share * y),
          static_cast<float>(p.z + share * z)};
}

/// Places on a cone: on the circle at `share` of its axis.
std::vector<Exact> around_cone(
    Random& random, const Float3& a, const Float3& b, double r0, double r1) {
  const long double axis[3] = {static_cast<long double>(b.x) - a.x,
                               static_cast<long double>(b.y) - a.y,
                               static_cast<long double>(b.z) - a.z};
  std::vector<Exact> places;
  for (int i = 0; i < 20; ++i) {
    const Float3 d = random.direction();
    const long double t[3] = {axis[1] * d.z - axis[2] * d.y,
                              axis[2] * d.x - axis[0] * d.z,
                              axis[0] * d.y - axis[1] * d.x};
    const long double size = std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
    const double share = random.unit();
    const long double radius = r0 + share * (r1 - r0);
    Exact x = between(a, b, share);
    for (int k = 0; k < 3; ++k)
      x.x[k] += radius * t[k] / size;
    places.push_back(x);
  }
  return places;
}

TEST_P(Outlines, HoldCones) {
  const double far = GetParam();
  const double pad = 0x1p-16;  // of a scene one unit wide, as rays that start in it need
  Random random(52);
  for (int i = 0; i < 1000; ++i) {
    const Float3 at = along(random.direction(), far);
    const double size = random.chance(.5) ? 1 : random.log_in(1e-4, 1);
    const Float3 a = random.point(1);
    const bool aimed = random.chance(.3);  // at the viewer, as wide all along
    const Float3 b = aimed ? moved_towards(a, at, size * random.in(.1, .9)) : a;
    const Float3 end = sum(b, random.point(aimed ? .03 * size : size));
    const double r0 = size * random.in(.01, .3);
    const double r1 = aimed ? r0 * random.in(.95, 1) : size * random.in(.01, .3);
    const Scene scene = one_cone(a, static_cast<float>(r0), end, static_cast<float>(r1));
    expect_held<Cone>(
        scene, {{at.x, at.y, at.z}, pad, pad / 16}, around_cone(random, a, end, r0, r1));
    if (HasFatalFailure())
      FAIL() << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Distances, Outlines, testing::Values(1., 4., 1e2, 1e4, 1e6));

}  // namespace
}  // namespace grelha::test
