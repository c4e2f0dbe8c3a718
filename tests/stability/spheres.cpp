// Spheres from afar, as floors, far from the origin.
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;

/// A unit sphere at the origin, its eye up to so many radii away; rays within .99 of the radius or
/// beyond 1.01. Twenty more stand beside it, so that there is a grid to walk.
template <int kExponent>
void far_sphere(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = one_sphere({0, 0, 0}, 1);
  for (int i = 0; i < 20; ++i)
    trial.scene.geometry.spheres.add(at({0, 0, 0}, 4, random.direction()), .5f, 0);
  const Size size = size_of(trial.scene);
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3 eye =
        at({0, 0, 0}, std::pow(10., kExponent) * random.in(.3, 1), random.direction());
    const oracle::V out = oracle::unit(oracle::cross(eye, random.direction()));
    const double miss = random.chance(.5) ? .99 * random.unit() : random.in(1.01, 1.1);
    const Float3 aim{static_cast<float>(out.x * miss),
                     static_cast<float>(out.y * miss),
                     static_cast<float>(out.z * miss)},
        dir = minus(aim, eye);
    trial.add(eye, dir, brute_force(trial.scene, size, eye, dir));
  }
  sink(trial);
}

/// Specks in a scene ten thousand times their size, with the eye among them: near enough that no
/// ray is moved nearer first.
void specks(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = empty_scene();
  add_spheres(trial.scene, random, 100, 50, .003, .03);
  Spheres& s = trial.scene.geometry.spheres;
  for (float& r : s.radius)
    r = std::abs(r);
  const Size size = size_of(trial.scene);
  for (std::size_t i = 0; i < rays; ++i) {
    const std::uint32_t k = random.below(100);
    const Float3 eye = random.point(50), center{s.x[k], s.y[k], s.z[k]};
    const oracle::V out = oracle::unit(oracle::cross(minus(center, eye), random.direction()));
    const double miss = s.radius[k] * random.in(0, 1.5);
    const Float3 aim = at(center,
                          miss,
                          {static_cast<float>(out.x),
                           static_cast<float>(out.y),
                           static_cast<float>(out.z)}),
                 dir = minus(aim, eye);
    trial.add(eye, dir, brute_force(trial.scene, size, eye, dir));
  }
  sink(trial);
}

/// Spheres of radius 1 scattered about a point so far from the origin, looked at from among them
/// and from 10 away.
template <int kExponent>
void moved_spheres(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  const Float3 center = scaled({1, -.013f, 1.5f}, std::pow(10., kExponent));
  trial.scene = placed(random_spheres(3, 60), 6, center);
  // only Grelha knows spheres seen from inside alone
  for (float& r : trial.scene.geometry.spheres.radius)
    r = std::abs(r);
  const Size size = size_of(trial.scene);
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3 eye = at(
        center, random.chance(.3) ? 6 * random.unit() : random.log_in(6, 60), random.direction());
    const Float3 dir = minus(at(center, 7 * random.unit(), random.direction()), eye);
    if (dir == Float3{})
      continue;
    trial.add(eye, dir, brute_force(trial.scene, size, eye, dir));
  }
  sink(trial);
}

/// A sphere as a floor below an eye 1/2 to 2 above it; what is hit must lie within a thousandth of
/// the way.
template <int kExponent>
void floor_sphere(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  const double r = std::pow(10., kExponent);
  trial.scene = one_sphere({0, static_cast<float>(-r), 0}, static_cast<float>(r));
  const oracle::Ball ball{{0, static_cast<float>(-r), 0}, static_cast<float>(r)};
  for (std::size_t i = 0; i < rays; ++i) {
    Float3 dir = random.direction();
    dir.y = -std::abs(dir.y);
    if (dir.y > -.1f)
      continue;
    const Float3 eye{static_cast<float>(random.in(-1, 1)),
                     static_cast<float>(random.in(.5, 2)),
                     static_cast<float>(random.in(-1, 1))};
    const double t = static_cast<double>(ball.first({eye, dir}, 0)->t);
    Expected w;
    w.hit = true;
    w.earliest = .999 * t;
    w.latest = 1.001 * t;
    trial.add(eye, dir, w);
  }
  sink(trial);
}

}  // namespace

std::vector<Row> sphere_rows() {
  const char* const truth = "brute force in long double";
  const char* const to_a_thousandth = "within a thousandth of the exact way";
  return {
      {"spheres from 1e2 radii", "within .99 or beyond 1.01 of the radius", truth, far_sphere<2>},
      {"spheres from 1e4 radii", "the same", truth, far_sphere<4>},
      {"spheres from 1e6 radii", "the same", truth, far_sphere<6>},
      {"specks in a large scene", "radii .003 to .03 in a scene of 100", truth, specks},
      {"spheres moved by 1e3", "radii .06 to 1.2", truth, moved_spheres<3>},
      {"spheres moved by 1e5", "the same", truth, moved_spheres<5>},
      {"spheres moved by 1e6", "the same", truth, moved_spheres<6>},
      {"floor sphere of radius 1e3", "eye 1/2 to 2 above", to_a_thousandth, floor_sphere<3>},
      {"floor sphere of radius 1e4", "eye 1/2 to 2 above", to_a_thousandth, floor_sphere<4>},
      {"floor sphere of radius 1e5", "eye 1/2 to 2 above", to_a_thousandth, floor_sphere<5>},
      {"floor sphere of radius 1e6", "eye 1/2 to 2 above", to_a_thousandth, floor_sphere<6>},
  };
}

}  // namespace grelha::stability
