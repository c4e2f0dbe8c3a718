#include "kernel/marks/mesh_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/query/variants.hpp"

namespace grelha {
namespace {

constexpr std::size_t kRaysOfTurn = 256;
/// Times the greatest coordinate: hits so near are those of the triangle itself, by rounding.
constexpr double kRounding = 0x1p-20;
/// Ways that are enough, as floats, are no less than that.
constexpr double kEnough = 1 + 0x1p-20;

/// Both rays of some triangles.
struct BothWays {
  float org[3][kRaysOfTurn], dir[3][kRaysOfTurn], t_min[kRaysOfTurn], t_max[kRaysOfTurn];
};

void set_rays(
    const TriangleSpans& t, std::uint32_t i, double enough, std::size_t at, BothWays& rays) {
  const std::uint32_t vertex[3] = {t.a[i], t.b[i], t.c[i]};
  double p[3][3];
  for (int k = 0; k < 3; ++k) {
    p[k][0] = t.x[vertex[k]];
    p[k][1] = t.y[vertex[k]];
    p[k][2] = t.z[vertex[k]];
  }
  double normal[3];
  double square = 0;
  double farthest = 0;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const int c = (a + 2) % 3;
    normal[a] =
        (p[1][b] - p[0][b]) * (p[2][c] - p[0][c]) - (p[1][c] - p[0][c]) * (p[2][b] - p[0][b]);
    square += normal[a] * normal[a];
    farthest = std::max({farthest, std::abs(p[0][a]), std::abs(p[1][a]), std::abs(p[2][a])});
  }
  const double of_one = 1 / std::sqrt(square);
  for (std::size_t way = 0; way < 2; ++way) {
    for (int a = 0; a < 3; ++a) {
      rays.org[a][at + way] = static_cast<float>((p[0][a] + p[1][a] + p[2][a]) / 3);
      rays.dir[a][at + way] = static_cast<float>((way == 0 ? of_one : -of_one) * normal[a]);
    }
    rays.t_min[at + way] = static_cast<float>(kRounding * farthest);
    rays.t_max[at + way] = static_cast<float>(kEnough * enough);
  }
}

}  // namespace

void MeshThickness::measure(std::span<const std::uint32_t> triangles,
                            double enough,
                            std::span<float> thickness,
                            TraceCounts& counts) const {
  BothWays both;
  float t[kRaysOfTurn];
  const TriangleSpans& spans = world_.primitives.geometry.triangles;
  for (std::size_t first = 0; first < triangles.size(); first += kRaysOfTurn / 2) {
    const std::size_t count = std::min(kRaysOfTurn / 2, triangles.size() - first);
    for (std::size_t k = 0; k < count; ++k)
      set_rays(spans, triangles[first + k], enough, 2 * k, both);
    const Rays rays{.org = {both.org[0], both.org[1], both.org[2]},
                    .dir = {both.dir[0], both.dir[1], both.dir[2]},
                    .t_min = both.t_min,
                    .t_max = both.t_max,
                    .count = 2 * count};
    setup_.variant.loops.closest(world_.view, rays, {.t = t}, {}, counts);
    for (std::size_t k = 0; k < count; ++k) {
      const bool flat = !std::isfinite(both.dir[0][2 * k]);
      thickness[first + k] = flat ? 0 : std::min(t[2 * k], t[2 * k + 1]);
    }
  }
}

}  // namespace grelha
