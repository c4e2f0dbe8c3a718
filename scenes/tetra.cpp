// The tetrahedral pyramid (Sierpinski's): every tetrahedron is four of half its size at its
// corners.
#include <array>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

/// Corners of a cube whose coordinates multiply to +1.
constexpr std::array<Vec, 4> kCubeCorners{
    Vec{-1, -1, 1}, Vec{-1, 1, -1}, Vec{1, -1, -1}, Vec{1, 1, 1}};

void write_part(NffWriter& nff, Vec center, double half, int depth) {
  std::array<Vec, 4> v;
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = center + half * kCubeCorners[i];
  if (depth > 1) {
    for (const Vec& corner : kCubeCorners)
      write_part(nff, center + half / 2 * corner, half / 2, depth - 1);
    return;
  }
  nff.polygon({v[0], v[1], v[2]});
  nff.polygon({v[3], v[2], v[1]});
  nff.polygon({v[2], v[3], v[0]});
  nff.polygon({v[1], v[0], v[3]});
}

}  // namespace

void write_tetra(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {1.02285, -3.17715, -2.17451},
            .at = {-0.004103, -0.004103, 0.216539},
            .up = {-0.816497, -0.816497, 0.816497},
            .hither = 1});
  nff.light({2, -18, -5});
  nff.surface({.color = {1, 0.2, 0.2}, .kd = 1, .shine = 100000});
  write_part(nff, {0, 0, 0}, 1, options.size);
}

}  // namespace grelha::scenes
