#pragma once
// A world with the arrays that it refers to.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "c/errors.hpp"
#include "c/points.hpp"
#include "grelha/query.hpp"
#include "grelha/world.hpp"

namespace grelha::c {

/// Coordinates of vertices or of centers, each axis by itself.
struct Coordinates {
  std::vector<float> x, y, z;
};

/// The points less an offset.
template <class Number>
Coordinates coordinates_of(const Points<Number>& points, const std::array<double, 3>& offset) {
  Coordinates found;
  std::vector<float>* const axes[3] = {&found.x, &found.y, &found.z};
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a]->resize(points.count());
    for (std::size_t i = 0; i < points.count(); ++i)
      (*axes[a])[i] = static_cast<float>(points.at(i, a) - offset[a]);
  }
  return found;
}

}  // namespace grelha::c

struct grelha_world {
  std::array<double, 3> offset{};
  grelha::c::Coordinates at;           ///< of vertices, or of centers
  std::vector<std::uint32_t> a, b, c;  ///< [triangles]
  std::vector<float> radius;           ///< [spheres]
  std::vector<std::uint8_t> masks;     ///< [primitives], or empty
  /// refers to the arrays above
  std::unique_ptr<grelha::World> built;

  bool is_of_triangles() const { return radius.empty(); }
  /// The scene with these coordinates.
  grelha::SceneSpans scene(const grelha::c::Coordinates& coordinates) const;
};

namespace grelha::c {

/// The world to ask. Throws std::invalid_argument for null.
inline const World& world_of(const grelha_world* world) {
  expect_there(world, "world");
  return *world->built;
}
/// How its rays are traced.
inline QueryOptions options_of(const grelha_world* world, int threads) {
  return {.threads = expect_threads(threads), .mask = world->masks};
}

}  // namespace grelha::c
