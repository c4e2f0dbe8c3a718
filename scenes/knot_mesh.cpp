#include "scenes/knot_mesh.hpp"

#include <cmath>

namespace grelha::scenes {

namespace {

constexpr double kTube = 0.14;

Vec knot(double t) {
  const double a = 2 * kPi * t, reach = 0.57 + 0.29 * std::cos(3 * a);
  return {reach * std::cos(2 * a), reach * std::sin(2 * a), 0.44 + 0.29 * std::sin(3 * a)};
}

Vec tube(double u, double v) {
  constexpr double kDifference = 1e-5;
  const Vec along = normalise(knot(u + kDifference) - knot(u - kDifference));
  const Vec side = normalise(cross({0, 0, 1}, along));
  return knot(u) + kTube * turn(side, along, -2 * kPi * v);
}

}  // namespace

Mesh knot_mesh(int n) {
  Mesh mesh;
  add_surface(mesh, 36 * n, 4 * n, tube);
  return mesh;
}

}  // namespace grelha::scenes
