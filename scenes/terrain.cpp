// Rolling land of as many triangles as memory is to be tried with: a height field as a binary PLY
// file, written row by row.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ostream>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr int kCells = 16;  ///< along a side, for each unit of size

/// -1 to 1, of a place of the lattice.
double lattice(int x, int y, int octave) {
  std::uint32_t v = std::uint32_t(x) * 0x9E3779B1u ^ std::uint32_t(y) * 0x85EBCA77u ^
                    std::uint32_t(octave) * 0xC2B2AE3Du;
  v = (v ^ v >> 15) * 0x2C1B3C6Du;
  v = (v ^ v >> 12) * 0x297A2D39u;
  return double(v ^ v >> 15) / 2147483648.0 - 1;
}

/// Perlin's sum of noise, of values on lattices each twice as fine as the last and half as high; x
/// and y from 0 to 1.
double height(double x, double y) {
  constexpr int kOctaves = 11;
  double sum = 0, high = .16, n = 4;
  for (int octave = 0; octave < kOctaves; ++octave, high /= 2, n *= 2) {
    const double fx = std::floor(x * n), fy = std::floor(y * n), u = x * n - fx, v = y * n - fy;
    const int i = int(fx), j = int(fy);
    const double s = u * u * (3 - 2 * u), t = v * v * (3 - 2 * v);
    const double low = (1 - s) * lattice(i, j, octave) + s * lattice(i + 1, j, octave);
    const double up = (1 - s) * lattice(i, j + 1, octave) + s * lattice(i + 1, j + 1, octave);
    sum += high * ((1 - t) * low + t * up);
  }
  return sum;
}

/// Its bytes, the least first on every machine.
void put(std::string& row, std::uint32_t v) {
  for (int shift = 0; shift < 32; shift += 8)
    row += char(v >> shift & 255);
}

void put(std::string& row, double v) {
  const auto single = float(v);
  std::uint32_t bits;
  std::memcpy(&bits, &single, sizeof bits);
  put(row, bits);
}

}  // namespace

void write_terrain_mesh(std::ostream& out, int size) {
  const auto n = std::uint32_t(kCells * size), columns = n + 1;
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << columns * columns
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << 2 * n * n
      << "\nproperty list uchar uint vertex_indices\nend_header\n";
  std::string row;
  const auto flush = [&] {
    out.write(row.data(), std::streamsize(row.size()));
    row.clear();
  };
  for (std::uint32_t j = 0; j <= n; ++j, flush())
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double x = double(i) / n, y = double(j) / n;
      put(row, 2 * x - 1);
      put(row, 2 * y - 1);
      put(row, height(x, y));
    }
  const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    row += char(3);
    put(row, a);
    put(row, b);
    put(row, c);
  };
  for (std::uint32_t j = 0; j < n; ++j, flush())
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * columns + i, b = a + 1, c = b + columns, d = a + columns;
      face(a, b, c);
      face(c, d, a);
    }
}

void write_terrain(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.comment(
      "Rolling land, a height field of as many triangles as wanted, with a ball of glass and one "
      "of steel above it.");
  nff.background({0.55, 0.68, 0.85});
  nff.view({.from = {-1.7, -1.3, 1}, .at = {0, 0, -0.1}, .angle_deg = 38});
  nff.light({-3, 2, 4}, {1, 0.96, 0.88});
  nff.surface({.color = {0.45, 0.5, 0.3}, .kd = 1, .ior = 1});
  nff.ply(options.mesh_file);
  nff.surface(
      {.color = {1, 1, 1}, .kd = 0.05, .ks = 0.1, .shine = 200, .transmission = 0.85, .ior = 1.4});
  nff.sphere({-0.45, -0.5, 0.4}, 0.14);
  nff.surface({.color = {0.8, 0.8, 0.85}, .kd = 0.2, .ks = 0.7, .shine = 100, .ior = 1});
  nff.sphere({0.15, -0.15, 0.35}, 0.16);
}

}  // namespace grelha::scenes
