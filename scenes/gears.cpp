// A cube of meshing gears. Geometry as SPD writes it; the colours are our own, their rule is not
// published.
#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

constexpr int kTeeth = 36;
constexpr double kStep = 360.0 / kTeeth;  // degrees
constexpr double kOuter = 0.995, kInner = 0.9, kBetweenCentres = 1.9, kThickness = 0.1;

struct Gear {
  Vec center;  ///< of the top face
  double radius, turned_deg;
};

/// The rim from below: four points a tooth, outer, outer, inner, inner.
std::vector<Vec> rim(const Gear& gear) {
  struct Point {
    double step, radius;
  };
  constexpr Point kTooth[] = {{-0.19, kOuter}, {0.19, kOuter}, {0.30, kInner}, {0.70, kInner}};
  std::vector<Vec> points;
  for (int tooth = 0; tooth < kTeeth; ++tooth)
    for (const Point& p : kTooth) {
      const double angle = degrees(gear.turned_deg + kStep * (tooth + p.step)),
                   r = gear.radius * p.radius;
      points.push_back(gear.center + Vec{r * std::cos(angle), r * std::sin(angle), 0});
    }
  return points;
}

void write_gear(NffWriter& nff, const Gear& gear) {
  const std::vector<Vec> top = rim(gear);
  std::vector<Vec> bottom;
  for (const Vec& p : top)
    bottom.push_back(p - Vec{0, 0, kThickness});
  nff.polygon(top);
  for (std::size_t i = 0; i < top.size(); ++i) {
    const std::size_t next = (i + 1) % top.size();
    nff.polygon({top[i], bottom[i], bottom[next], top[next]});
  }
  std::reverse(bottom.begin(), bottom.end());
  // begins on a tooth: a polygon's second corner must be convex
  std::rotate(bottom.begin(), bottom.end() - 2, bottom.end());
  nff.polygon(bottom);
}

/// Bright, never grey, and different for neighbours.
Vec color(int x, int y, int z) {
  const auto part = [&](int i) {
    return 0.1 + 0.9 * double((i * (3 * x + 5 * y + 7 * z) + i) % 8) / 7;
  };
  Vec result{part(1), part(3), part(5)};
  ((x + y + z) % 3 == 0 ? result.x : (x + y + z) % 3 == 1 ? result.y : result.z) = 1;
  return result;
}

}  // namespace

void write_gears(std::ostream& out, const SceneOptions& options) {
  const int n = options.size;
  const double radius = 2 / (2 + kBetweenCentres * (n - 1));  // the outermost teeth reach -1 and 1
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {-1.1, -2.1, 2.6}, .at = {0, 0, 0}, .hither = 1});
  for (const Vec& light :
       {Vec{2, 4, 4}, Vec{-2, 4, 3}, Vec{2, -2.5, 2.5}, Vec{-1, -4, 2}, Vec{-1.111, -2.121, 2.626}})
    nff.light(light);
  nff.surface({.color = {1, 0.85, 0.7}, .kd = 0.3, .ks = 0.6, .shine = 3.0827});
  nff.polygon({{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}});
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        if ((4 * x + 2 * y + z) % 5 == 0)
          nff.surface({.color = color(x, y, z),
                       .kd = 0.2,
                       .shine = 100000,
                       .transmission = 0.8,
                       .ior = 1.1});
        else
          nff.surface({.color = color(x, y, z), .kd = 1, .shine = 100000});
        const double pitch = kBetweenCentres * radius;
        write_gear(nff,
                   {{radius - 1 + x * pitch, radius - 1 + y * pitch, 1 - double(z) / n},
                    radius,
                    (x + y + z) % 2 ? kStep / 2 : 0});
      }
}

}  // namespace grelha::scenes
