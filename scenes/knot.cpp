// A knot of polished brass beside a ball of glass, a PLY mesh like the boat's but closed and round
// everywhere.
#include "scenes/generators.hpp"
#include "scenes/knot_mesh.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

void write_knot_mesh(std::ostream& out, int size) {
  write_ply(out, knot_mesh(size));
}

void write_knot(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.comment(
      "A knot of polished brass, a mesh with normals, beside a ball of glass and over a dull "
      "mirror.");
  nff.background({0.5, 0.62, 0.8});
  nff.view({.from = {2.4, -3.2, 2.3}, .at = {0.28, -0.1, 0.3}, .angle_deg = 32});
  nff.light({4, -4, 8}, {0.75, 0.73, 0.68});
  nff.light({-6, -3, 5}, {0.35, 0.37, 0.42});
  nff.surface({.color = {0.8, 0.74, 0.68}, .kd = 0.75, .ks = 0.2, .shine = 100, .ior = 1});
  nff.plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  nff.surface({.color = {1, 0.72, 0.3}, .kd = 0.6, .ks = 0.35, .shine = 60, .ior = 1});
  nff.ply(options.mesh_file);
  nff.surface(
      {.color = {1, 1, 1}, .kd = 0.03, .ks = 0.1, .shine = 200, .transmission = 0.9, .ior = 1.5});
  nff.sphere({1.22, -0.5, 0.32}, 0.32);
}

}  // namespace grelha::scenes
