#include "frontend/default_view.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {
namespace {

struct Extent {
  double lower = 0, upper = 0;
  double middle() const { return lower + (upper - lower) / 2; }
  double size() const { return upper - lower; }
};

/// Of the vertices that triangles name; others may lie anywhere.
Extent extent(const Triangles& t, const std::vector<float>& along) {
  if (t.size() == 0) return {-1, 1};
  Extent e{double(along[t.a[0]]), double(along[t.a[0]])};
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double a = along[t.a[i]], b = along[t.b[i]], c = along[t.c[i]];
    e.lower = std::min({e.lower, a, b, c});
    e.upper = std::max({e.upper, a, b, c});
  }
  return e;
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
  const Triangles& t = file.scene.geometry.triangles;
  const Extent x = extent(t, t.x), y = extent(t, t.y), z = extent(t, t.z);
  const double radius = std::hypot(x.size(), y.size(), z.size()) / 2;
  const double farthest = std::max({std::abs(x.lower), std::abs(x.upper), std::abs(y.lower), std::abs(y.upper),
                                    std::abs(z.lower), std::abs(z.upper)});
  // The ball around the mesh fills the angle. A tiny mesh far out must not put the eye on what it looks at in floats.
  constexpr double kAngleDeg = 45, kDegree = 3.14159265358979323846 / 180, kFloatSteps = 1e-5, kLeast = 1e-12;
  const double distance = std::max({radius / std::sin(kAngleDeg / 2 * kDegree), kFloatSteps * farthest, kLeast});

  // Unit vectors towards the eye, to the right and up in the picture: 30 degrees to the right, 20 degrees above.
  const double turn = 30 * kDegree, rise = 20 * kDegree;
  const double back[] = {std::sin(turn) * std::cos(rise), std::sin(rise), std::cos(turn) * std::cos(rise)};
  const double right[] = {std::cos(turn), 0, -std::sin(turn)};
  const double middle[] = {x.middle(), y.middle(), z.middle()};
  const auto place = [&](double to_back, double to_right, double up) {
    const auto part = [&](int i) {
      return float(middle[i] + distance * (to_back * back[i] + to_right * right[i] + (i == 1 ? up : 0)));
    };
    return Float3{part(0), part(1), part(2)};
  };
  file.camera = {place(1, 0, 0), {float(middle[0]), float(middle[1]), float(middle[2])}, {0, 1, 0}, kAngleDeg, 512, 512};
  file.scene.lights = {{place(1, -0.5, 0.7), {1, 1, 1}}};
  file.scene.background = {0.62f, 0.68f, 0.76f};
  file.default_camera = file.default_light = true;
}

}  // namespace grelha
