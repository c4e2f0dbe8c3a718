// How far rays to a point stray from it where they are looked up: no further than the outlines of
// its grid are grown by.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "grelha/grelha.hpp"
#include "kernel/perspective/tolerances.hpp"
#include "kernel/trace/trace.hpp"
#include "kernel/world/plan.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using Point = scalar::Vec3<double>;

Point point(const float (&x)[3]) {
  return {x[0], x[1], x[2]};
}
double length(const Point& x) {
  return std::sqrt(scalar::dot(x, x));
}
/// Of x from the line through a and b.
double distance(const Point& x, const Point& a, const Point& b) {
  return length(scalar::cross(x - a, b - a)) / length(b - a);
}

/// A scene whose box begins so many of its diagonals from the origin.
class Offset {
 public:
  explicit Offset(double diagonals) {
    Random random(41);
    const double at = diagonals * 3.5;
    const float x = static_cast<float>(at);
    scene_ = placed(random_triangles(41, 200), 1, {x, -x, x});
    world_.emplace(scene_, BuildOptions{});
  }
  const SceneView& view() const { return world_->impl().view; }
  double diagonal() const { return view().reach; }
  /// In the box.
  Point within(Random& random) const {
    double x[3];
    for (int a = 0; a < 3; ++a)
      x[a] = random.in(view().box_lo[a], view().box_hi[a]);
    return {x[0], x[1], x[2]};
  }
  /// Anywhere, so many diagonals from a place.
  Point away(Random& random, const Point& from, double diagonals) const {
    const Float3 d = random.direction();
    const double far = diagonals * diagonal();
    return {from.x + far * d.x, from.y + far * d.y, from.z + far * d.z};
  }
  /// Beyond a place as seen from another, as far as rays are looked up from.
  Point beyond(Random& random, const Point& place, const Point& seen_from) const {
    const Point d = (1 / length(place - seen_from)) * (place - seen_from);
    const double most = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    const double reach = view().point_reach / most;
    return place + (random.chance(.5) ? .999 * reach : random.in(0, reach)) * d;
  }

 private:
  Scene scene_;
  std::optional<World> world_;
};

/// How far a ray from `start` to `to` strays from the line between `to` and where it is looked up,
/// within the scene.
double stray(const SceneView& view, const Point& start, const Point& to) {
  float org[3] = {float(start.x), float(start.y), float(start.z)};
  const float end[3] = {float(to.x), float(to.y), float(to.z)};
  const float dir[3] = {end[0] - org[0], end[1] - org[1], end[2] - org[2]};
  const double moved = scalar::approach(view, org, dir);
  const Point from = point(org);
  const Point way = point(dir);
  double most = 0;
  for (const double diagonals : {1., 2., 3.}) {
    const double t = std::min(diagonals * view.reach / length(way), 1 - moved);
    most = std::max(most, distance(from + t * way, from, point(end)));
  }
  return most;
}

class PointReach : public testing::TestWithParam<double> {};

TEST_P(PointReach, OutlinesAllowForHowFarRaysStray) {
  const Offset scene(GetParam());
  const SceneView& view = scene.view();
  const bool far = view.point_reach > view.reach;
  EXPECT_EQ(far, GetParam() < 5) << "rays from afar are looked up where the origin is near";
  const double aside = (far ? kFarAside : kNearAside) * pad_of(scene.diagonal());
  Random random(42);
  for (int i = 0; i < 20000; ++i) {
    const Point place = scene.within(random);
    const Point light = scene.away(random, place, random.log_in(.01, 1e4));
    const Point start = scene.beyond(random, place, light);
    ASSERT_LE(stray(view, start, light), aside) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, PointReach, testing::Values(0., 2., 4., 8., 100., 1e4));

}  // namespace
}  // namespace grelha::test
