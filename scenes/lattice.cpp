// A cube of balls joined by rods that begin and end inside the balls. The material changes before
// every primitive.
#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

void write_rod(NffWriter& nff, Vec from, Vec axis, int n) {
  const double reach = 0.495 / (4.0 * n);  // not quite half a ball's radius
  nff.surface({.color = 0.8 * axis + Vec{0.1, 0.1, 0.1}, .kd = 0.99, .shine = 100000});
  nff.cone(from + reach * axis, 1.0 / (16 * n), from + (1.0 / n - reach) * axis, 1.0 / (16 * n));
}

}  // namespace

void write_lattice(std::ostream& out, const SceneOptions& options) {
  const int n = options.size;
  const double half = 0.5 / n;
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  // Between two layers of rods. SPD has 1/2 + half at every size, which for odd ones is inside a
  // rod: a black picture.
  const double middle = n % 2 == 0 ? 0.5 + half : 0.5;
  nff.view({.from = {middle, 1, 1 - half},
            .at = {middle, -1, -1 - half},
            .up = {0.2, 1, 0},
            .angle_deg = 60,
            .hither = 0});
  for (const Vec& light : {Vec{2, 0.5, 0.5},
                           Vec{-1, 0.5, 0.5},
                           Vec{0.5, 2, 0.5},
                           Vec{0.5, -1, 0.5},
                           Vec{0.5, 0.5, 2},
                           Vec{0.5, 0.5, -1}})
    nff.light(light);
  for (int x = 0; x <= n; ++x)
    for (int y = 0; y <= n; ++y)
      for (int z = 0; z <= n; ++z) {
        const Vec at{double(x) / n, double(y) / n, double(z) / n};
        nff.surface({.color = {0.9, 0.9, 0.9}, .kd = 0.5, .ks = 0.5, .shine = 3.0827});
        nff.sphere(at, 1.0 / (4 * n));
        if (x < n)
          write_rod(nff, at, {1, 0, 0}, n);
        if (y < n)
          write_rod(nff, at, {0, 1, 0}, n);
        if (z < n)
          write_rod(nff, at, {0, 0, 1}, n);
      }
}

}  // namespace grelha::scenes
