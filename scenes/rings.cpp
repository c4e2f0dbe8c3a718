// A pyramid of clusters; a cluster is six interlocked pentagons of rods and balls, one across each
// axis of an icosahedron.
#include <array>
#include <cmath>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr int kCorners = 5, kRings = 6;
constexpr double kReach = 0.9309948, kRod = 0.07412;  // what SPD's files have, to their last digit

struct Ring {
  Vec axis, start, color;
};

std::array<Ring, kRings> rings() {
  constexpr std::array<Vec, kRings> kColors{
      Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}, Vec{0, 1, 1}, Vec{1, 0, 1}, Vec{1, 1, 0}};
  std::array<Ring, kRings> result;
  result[0] = {{0, 0, 1}, {1, 0, 0}, kColors[0]};
  for (std::size_t i = 1; i < result.size(); ++i) {
    const double around = degrees(72.0 * double(i - 1) - 54), s = 1 / std::sqrt(5.0);
    result[i] = {{2 * s * std::cos(around), 2 * s * std::sin(around), s},
                 {-std::sin(around), std::cos(around), 0},
                 kColors[i]};
  }
  return result;
}

void write_ring(NffWriter& nff, Vec center, const Ring& ring) {
  const auto corner = [&](int i) {
    return center + kReach * turn(ring.start, ring.axis, degrees(72.0 * i));
  };
  nff.surface({.color = ring.color, .kd = 0.5, .ks = 0.2, .shine = 3.0827});
  for (int i = 0; i < kCorners; ++i) {
    nff.cone(corner(i), kRod, corner(i - 1), kRod);
    nff.sphere(corner(i), kRod);
  }
}

}  // namespace

void write_rings(std::ostream& out, const SceneOptions& options) {
  const int n = options.size;
  const double layer = 1 / std::sin(degrees(22.5)), far = (n + 1) * layer;
  // fills the view from behind the last layer
  const double wall = 1.01 * (far + layer) * std::tan(degrees(22.5));
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {-1, -layer, 0.5}, .at = {-1, 1 - layer, 0.5}, .hither = 1});
  for (const Vec& light : {Vec{3, -layer, 3}, Vec{-4, -layer, 1}, Vec{2, -layer, -4}})
    nff.light(light);
  nff.surface({.color = {1, 1, 1}, .kd = 1, .shine = 100000});
  const double left = -1 - wall, right = -1 + wall, low = 0.5 - wall, high = 0.5 + wall;
  nff.polygon({{right, far, high}, {left, far, high}, {left, far, low}, {right, far, low}});
  for (int k = 0; k < n; ++k)
    for (int z = -k; z <= k; z += 2)
      for (int x = -k; x <= k; x += 2)
        for (const Ring& ring : rings())
          write_ring(nff, {double(x), (k + 1) * layer, double(z)}, ring);
}

}  // namespace grelha::scenes
