// A teapot in a stadium: a fine mesh in a ground a thousand times its size, the case that one uniform grid cannot fit.
#include <cmath>

#include "scenes/generators.hpp"
#include "scenes/mesh.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr double kObject = 2, kGround = 1000 * kObject;  // widths, scene units
constexpr double kTube = 0.14;

/// A trefoil knot of that width, standing above z = 0.
Vec knot(double t) {
  const double a = 2 * kPi * t, reach = 0.57 + 0.29 * std::cos(3 * a);
  return {reach * std::cos(2 * a), reach * std::sin(2 * a), 0.44 + 0.29 * std::sin(3 * a)};
}

Vec tube(double u, double v) {
  constexpr double kStep = 1e-5;
  const Vec along = normalise(knot(u + kStep) - knot(u - kStep));
  const Vec side = normalise(cross({0, 0, 1}, along));
  return knot(u) + kTube * turn(side, along, -2 * kPi * v);
}

}  // namespace

void write_stadium(std::ostream& out, const SceneOptions& options) {
  Mesh mesh;
  add_surface(mesh, 36 * options.size, 4 * options.size, tube);
  NffWriter nff(out);
  nff.comment("A fine mesh in a ground a thousand times its size.");
  nff.background({0.45, 0.65, 0.9});
  nff.view({.from = {1.6, -2.2, 1.5}, .at = {0, 0, 0.4}});
  nff.light({-300, -500, 700}, {0.9, 0.9, 0.85});
  nff.light({4, -1, 3}, {0.3, 0.3, 0.35});
  nff.surface({.color = {0.3, 0.55, 0.25}, .kd = 0.9, .shine = 100000, .ior = 1});
  const double h = kGround / 2;
  nff.polygon({{h, h, 0}, {-h, h, 0}, {-h, -h, 0}, {h, -h, 0}});
  nff.surface({.color = {1, 0.75, 0.3}, .kd = 0.6, .ks = 0.3, .shine = 40, .ior = 1});
  for (const auto& [a, b, c] : mesh.faces) {
    const Vec vertices[] = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    const Vec normals[] = {mesh.normals[a], mesh.normals[b], mesh.normals[c]};
    nff.patch(vertices, normals);
  }
}

}  // namespace grelha::scenes
