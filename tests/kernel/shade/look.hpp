#pragma once
// One ray, one pixel: what a camera sees of a scene in one place.

#include "grelha/render.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {

struct Pixel {
  float r, g, b;
  RenderStats stats;
};

/// The one pixel a camera sees that looks from eye exactly at `at`.
inline Pixel look(const Scene& scene, const Float3& eye, const Float3& at, int depth = 5) {
  const World world(scene, {});
  Camera c;
  c.eye = eye;
  c.at = at;
  c.width = c.height = 1;
  c.angle_deg = 10;
  const Float3 d = minus(at, eye);
  if (d.x == 0 && d.z == 0)
    c.up = {0, 0, 1};
  RenderOptions o;
  o.depth = depth;
  o.threads = 1;
  o.min_weight = 0;  // closed forms have all terms
  Pixel p;
  const Image image = render(world, c, o, p.stats);
  p.r = image.rgb[0];
  p.g = image.rgb[1];
  p.b = image.rgb[2];
  return p;
}

inline Material plain(const Float3& diffuse) {
  Material m;
  m.diffuse = diffuse;
  return m;
}

inline Material glowing(const Float3& light) {
  Material m;
  m.emission = light;
  return m;
}

/// A floor at y = 0 seen by an eye above; materials[0] is the floor's.
inline Scene floor_scene(const Material& m) {
  Scene s;
  s.materials = {m};
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0);
  s.background = {.1f, .2f, .3f};
  return s;
}

/// Bound of the error of a shaded value: the direction (12 eps, camera_test) and the hit point each
/// move the cosine by that much; the light's direction, its normalisation and the products add
/// about 20 roundings.
inline constexpr double kFew = 64 * 6e-8;

}  // namespace grelha::test
