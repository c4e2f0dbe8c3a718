// Shadow rays to point lights: among things, on them, far away, and before what spans all that a
// light sees. Grelha answers them by the light's own grid too (kernel/perspective/).
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;

struct LitScene {
  Scene scene;
  Float3 light;
};

/// Returns the origin of a shadow ray: a random point; a point beyond a corner or an edge as seen
/// from the light; or a point whose offset from the light has two or three equal coordinates.
Float3 start_of(Random& random, const LitScene& lit) {
  const Triangles& t = lit.scene.geometry.triangles;
  const std::uint32_t kind = random.below(3);
  if (kind == 0)
    return random.point(random.chance(.2) ? random.log_in(3, 300) : 1.5);
  if (kind == 1) {
    const std::uint32_t i = random.below(static_cast<std::uint32_t>(t.size()));
    const Float3 a = vertex(lit.scene, t.a[i]), b = vertex(lit.scene, t.b[i]);
    const Float3 on = random.chance(.3) ? a : at(a, random.unit(), minus(b, a));
    return at(lit.light,
              random.chance(.5) ? random.in(.9, 3) : random.log_in(3, 100),
              minus(on, lit.light));
  }
  const float far = static_cast<float>(random.log_in(.1, 10));
  Float3 away{far * static_cast<float>(random.sign()),
              far * static_cast<float>(random.sign()),
              far * static_cast<float>(random.chance(.3) ? random.sign() : random.in(-1, 1))};
  std::swap(component(away, 2), component(away, random.below(3)));
  return at(lit.light, 1, away);
}

/// Rays to lights of scenes that `make` draws, 2000 each.
template <LitScene (*make)(Random&)>
void to_lights(Random& random, std::size_t rays, const Sink& sink) {
  constexpr std::size_t each = 2000;
  for (std::size_t done = 0; done < rays; done += each) {
    const LitScene lit = make(random);
    Trial trial;
    trial.scene = lit.scene;
    const Size size = size_of(trial.scene);
    for (std::size_t i = 0; i < std::min(each, rays); ++i) {
      const Float3 org = start_of(random, lit);
      const Float3 dir = minus(lit.light, org);
      if (!(dir == Float3{}))
        trial.add(org, dir, brute_force(trial.scene, size, org, dir, 1), 1);
    }
    sink(trial);
  }
}

LitScene among(Random& random) {
  Scene s = balls_and_triangles(random.next(), 100);
  return {std::move(s), random.point(1)};
}

/// At a corner, on an edge, within a face, at a ball's middle or on it.
LitScene on_surfaces(Random& random) {
  LitScene lit{balls_and_triangles(random.next(), 60), {}};
  const Scene& s = lit.scene;
  const Float3 a = vertex(s, 0), b = vertex(s, 1), c = vertex(s, 2);
  const Spheres& balls = s.geometry.spheres;
  const Float3 middle{balls.x[0], balls.y[0], balls.z[0]};
  const std::uint32_t kind = random.below(5);
  lit.light = kind == 0   ? a
              : kind == 1 ? at(a, .5, minus(b, a))
              : kind == 2 ? at(at(a, .3, minus(b, a)), .3, minus(c, a))
              : kind == 3 ? middle
                          : at(middle, balls.radius[0], random.direction());
  return lit;
}

LitScene far_away(Random& random) {
  Scene s = balls_and_triangles(random.next(), 100);
  return {std::move(s), scaled(random.direction(), random.log_in(10, 1e6))};
}

/// Needles that pass the light, each seen through several faces; specks behind them; a wall that
/// the light nearly touches.
LitScene needles_and_specks(Random& random) {
  LitScene lit{empty_scene(), random.point(.3)};
  for (int i = 0; i < 40; ++i) {
    const Float3 by = at(lit.light, random.log_in(1e-4, .5), random.direction());
    const Float3 along = random.direction();
    const Float3 end = at(by, random.in(.2, 2), along);
    add_triangle(lit.scene,
                 at(by, -random.in(.2, 2), along),
                 end,
                 at(end, random.log_in(1e-4, .02), random.direction()));
    lit.scene.geometry.spheres.add(
        random.point(1.5), static_cast<float>(random.log_in(1e-4, .02)), 0);
  }
  const Float3 wall = at(lit.light, random.log_in(1e-4, .1), random.direction());
  add_triangle(lit.scene, wall, at(wall, 30, random.direction()), at(wall, 30, random.direction()));
  return lit;
}

}  // namespace

std::vector<Row> point_light_rows() {
  const char* const truth = "brute force in long double";
  return {
      {"lights among things",
       "50 balls and 50 triangles around; along edges and the diagonals of a cube",
       truth,
       to_lights<among>},
      {"lights on things",
       "at a corner, on an edge, in a face, in a ball, on it",
       truth,
       to_lights<on_surfaces>},
      {"lights far away", "10 to 1e6 sizes", truth, to_lights<far_away>},
      {"lights behind needles and specks",
       "needles that pass the light at 1e-4 to .5, a wall at 1e-4 to .1",
       truth,
       to_lights<needles_and_specks>},
  };
}

}  // namespace grelha::stability
