#pragma once
// Targets on closed meshes, and origins of rays to them. Random rays do not find leaks.

#include "tests/support/scenes.hpp"

namespace grelha::test {

inline constexpr double kTube = .4;  ///< of the tori: their tube's radius against 1 of their ring's

/// The targets: every vertex, the middle of every edge, a random point of every edge, rounded to
/// floats.
struct Aims {
  std::vector<Float3> vertices, middles, along;
};

inline Aims aims_at(const Scene& s, Random& random) {
  Aims out;
  for (std::uint32_t i = 0; i < s.geometry.triangles.vertex_count(); ++i)
    out.vertices.push_back(vertex(s, i));
  const Triangles& t = s.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::uint32_t v[3] = {t.a[i], t.b[i], t.c[i]};
    for (int k = 0; k < 3; ++k) {
      if (v[k] > v[(k + 1) % 3])
        continue;  // the neighbour's turn
      const Float3 a = vertex(s, v[k]), edge = minus(vertex(s, v[(k + 1) % 3]), a);
      out.middles.push_back(at(a, .5, edge));
      out.along.push_back(at(a, random.unit(), edge));
    }
  }
  return out;
}

/// Somewhere well inside the body: the inner quarter of the ball; the core of the torus' tube not
/// far from the aim, lest the ray first grazes the tube's inner side, which is concave from within.
inline Float3 inside(Random& random, const Float3& aim, bool torus) {
  if (!torus)
    return random.point(.12);
  const double a = std::atan2(aim.z, aim.x) + random.in(-.15, .15);
  return at({static_cast<float>(std::cos(a)), 0, static_cast<float>(std::sin(a))},
            .3 * kTube * random.unit(),
            random.direction());
}

/// Three tube's sizes out along the normal of the unscaled body over an aim, steep within 60
/// degrees of it: a ray from there to the aim comes through the far side of the first wall before t
/// = 1.2, bumps and facets and all.
inline Float3 outside(Random& random, const Float3& aim, bool torus) {
  Float3 core{};  // a ball has its normal from the centre, a torus from its core
  if (torus) {
    const double l = std::hypot(aim.x, aim.z);
    core = {static_cast<float>(aim.x / l), 0, static_cast<float>(aim.z / l)};
  }
  const Float3 normal = minus(aim, core);
  const double n = std::sqrt(double(normal.x) * normal.x + double(normal.y) * normal.y +
                             double(normal.z) * normal.z);
  return at(at(aim, 3 / n, normal), 1.5, random.direction());
}

}  // namespace grelha::test
