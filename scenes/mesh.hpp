#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <vector>

#include "scenes/vec.hpp"

namespace grelha::scenes {

/// Triangles over shared vertices, each vertex with a normal.
struct Mesh {
  std::vector<Vec> vertices, normals;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// Adds the surface (u, v) -> point over the unit square as a net of nu by nv cells, two triangles
/// each, smooth within itself and not to its neighbours. Seen from where u to v turns
/// counter-clockwise. The formula must be defined a little beyond the square and nowhere shrink to
/// a point.
template <class Surface>
void add_surface(Mesh& mesh, int nu, int nv, const Surface& surface) {
  constexpr double kStep = 1e-5;
  const auto first = std::uint32_t(mesh.vertices.size()), row = std::uint32_t(nu + 1);
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const double u = double(i) / nu, v = double(j) / nv;
      const Vec along_u = surface(u + kStep, v) - surface(u - kStep, v);
      const Vec along_v = surface(u, v + kStep) - surface(u, v - kStep);
      mesh.vertices.push_back(surface(u, v));
      mesh.normals.push_back(normalise(cross(along_u, along_v)));
    }
  }
  for (std::uint32_t j = 0; j < std::uint32_t(nv); ++j) {
    for (std::uint32_t i = 0; i < std::uint32_t(nu); ++i) {
      const std::uint32_t a = first + j * row + i, b = a + 1, c = b + row, d = a + row;
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({c, d, a});
    }
  }
}

/// ASCII PLY: x y z nx ny nz and index triples.
void write_ply(std::ostream& out, const Mesh& mesh);

}  // namespace grelha::scenes
