#include "frontend/default_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grelha {
namespace {

struct Extent {
  double lower = 0, upper = 0;
  double middle() const { return lower + (upper - lower) / 2; }
  double size() const { return upper - lower; }
};

/// Of the vertices that triangles name, along x, y and z; others may lie anywhere.
std::array<Extent, 3> extents(const Triangles& t) {
  if (t.size() == 0) return {Extent{-1, 1}, Extent{-1, 1}, Extent{-1, 1}};
  std::vector<bool> named(t.vertex_count());
  for (const auto* corners : {&t.a, &t.b, &t.c})
    for (const std::uint32_t v : *corners) named[v] = true;
  const std::uint32_t first = t.a[0];
  std::array<Extent, 3> all{Extent{t.x[first], t.x[first]}, Extent{t.y[first], t.y[first]},
                            Extent{t.z[first], t.z[first]}};
  for (std::size_t v = 0; v < t.vertex_count(); ++v) {
    if (!named[v]) continue;
    const double point[] = {t.x[v], t.y[v], t.z[v]};
    for (std::size_t i = 0; i < 3; ++i) all[i] = {std::min(all[i].lower, point[i]), std::max(all[i].upper, point[i])};
  }
  return all;
}

}  // namespace

Material default_mesh_material() {
  Material m;
  m.diffuse = {0.75f, 0.75f, 0.75f};
  m.specular = {0.2f, 0.2f, 0.2f};
  m.shine = 30;
  return m;
}

void add_default_view(SceneFile& file) {
  const auto [x, y, z] = extents(file.scene.geometry.triangles);
  const double radius = std::sqrt(x.size() * x.size() + y.size() * y.size() + z.size() * z.size()) / 2;
  const double farthest = std::max({std::abs(x.lower), std::abs(x.upper), std::abs(y.lower), std::abs(y.upper),
                                    std::abs(z.lower), std::abs(z.upper)});
  // The ball around the mesh fills the angle. A tiny mesh far out must not put the eye on what it looks at in floats.
  constexpr double kAngleDeg = 45, kSineOfHalf = 0.3826834323650898, kFloatSteps = 1e-5, kLeast = 1e-12;
  const double distance = std::max({radius / kSineOfHalf, kFloatSteps * farthest, kLeast});

  // Unit vectors towards the eye, to the right and up in the picture: 30 degrees to the right, 20 degrees above.
  // Sines and cosines are written down, for the library's last bit depends on the machine.
  constexpr double kSin30 = 0.5, kCos30 = 0.8660254037844386, kSin20 = 0.3420201433256687, kCos20 = 0.9396926207859084;
  constexpr double back[] = {kSin30 * kCos20, kSin20, kCos30 * kCos20}, right[] = {kCos30, 0, -kSin30};
  const double middle[] = {x.middle(), y.middle(), z.middle()};
  const auto place = [&](double to_back, double to_right, double up) {
    const auto part = [&](int i) {
      return float(middle[i] + distance * (to_back * back[i] + to_right * right[i] + (i == 1 ? up : 0)));
    };
    return Float3{part(0), part(1), part(2)};
  };
  file.camera = {
      place(1, 0, 0), {float(middle[0]), float(middle[1]), float(middle[2])}, {0, 1, 0}, kAngleDeg, 512, 512};
  file.scene.lights = {{place(1, -0.5, 0.7), {1, 1, 1}, {}, {}}};
  file.scene.background = {0.62f, 0.68f, 0.76f};
  file.default_camera = file.default_light = true;
}

}  // namespace grelha
