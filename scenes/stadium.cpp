// A teapot in a stadium: a fine mesh in a ground a thousand times its size, the case that one
// uniform grid cannot fit.
#include "scenes/generators.hpp"
#include "scenes/knot_mesh.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr double kObject = 2, kGround = 1000 * kObject;  // widths, scene units

}  // namespace

void write_stadium(std::ostream& out, const SceneOptions& options) {
  const Mesh mesh = knot_mesh(options.size);
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
