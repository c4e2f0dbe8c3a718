// Rays that leave surfaces: none hits what it left, none skips what is close, shadow rays tell a
// light before a wall from one behind it. The renderer's rule for start points (spots.hpp) is what
// is judged, and each tracer's test of it.
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/stability/spots.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;

/// Walls with a lid over each, `gap` away: triangle 2i the wall, 2i + 1 the lid, three times as
/// large.
struct Walls {
  Scene scene = empty_scene();
  std::vector<Float3> middle, normal;
  double gap;

  Walls(Random& random, double size, const Float3& place, double gap_) : gap(gap_) {
    for (int i = 0; i < 40; ++i) {
      const Float3 n = random.direction();
      const oracle::V along = oracle::unit(oracle::cross(n, random.direction())),
                      other = oracle::cross(n, along);
      const Float3 c = at(place, size * 40, random.point(1));
      const auto corner = [&](double k, double a) {
        const double x = k * size * std::cos(a), y = k * size * std::sin(a);
        return Float3{static_cast<float>(c.x + x * static_cast<double>(along.x) +
                                         y * static_cast<double>(other.x)),
                      static_cast<float>(c.y + x * static_cast<double>(along.y) +
                                         y * static_cast<double>(other.y)),
                      static_cast<float>(c.z + x * static_cast<double>(along.z) +
                                         y * static_cast<double>(other.z))};
      };
      const double turn = random.in(0, 6);
      add_triangle(scene, corner(1, turn), corner(1, turn + 2), corner(1, turn + 4));
      add_triangle(scene,
                   at(corner(3, turn), gap, n),
                   at(corner(3, turn + 2), gap, n),
                   at(corner(3, turn + 4), gap, n));
      middle.push_back(c);
      normal.push_back(n);
    }
  }
};

/// Size from 1e-8 to 1e8, offset from 1e-8 to 1e8, but for walls of fewer than 2000 ulp, whose
/// corners alone are off by as much.
bool draw(Random& random, double& size, Float3& place) {
  size = random.log_in(1e-8, 1e8);
  const double offset = random.log_in(1e-8, 1e8);
  place = at({0, 0, 0}, offset, random.direction());
  return size > 2000 * 6e-8 * offset;
}

/// Rays from the walls, up to the lids.
void contacts(Random& random, std::size_t rays, const Sink& sink) {
  const std::size_t each = 1000;
  for (std::size_t done = 0; done < rays;) {
    double size;
    Float3 place;
    if (!draw(random, size, place))
      continue;
    const double coarse =
        6e-8 * (size * 40 + std::abs(place.x) + std::abs(place.y) + std::abs(place.z));
    // Wide enough for both walls' rounding and the start's: 16 (e1 + e2) u + 4 u p
    // (docs/proofs.md), doubled.
    Trial trial;
    const Walls walls(random, size, place, std::max(1e-3 * size, 100 * coarse));
    trial.scene = walls.scene;
    const World world(trial.scene, {.grid = false});
    for (std::size_t i = 0; i < each; ++i) {
      const std::uint32_t k = random.below(40);
      const Float3 to = at(walls.middle[k], .2 * size, random.direction());
      const Float3 eye =
          at(to, size * random.log_in(1, 1e3), at(random.direction(), 1.5, walls.normal[k]));
      const Spot s = spot(world, 2 * k, eye, minus(walls.middle[k], eye));
      Float3 d = random.direction();
      if (dot_in_double(d, walls.normal[k]) < 0)
        d = scaled(d, -1);
      const double cosine = dot_in_double(d, walls.normal[k]);
      if (cosine < .1)
        continue;
      Expected w;
      w.hit = true;
      w.left = 2 * k;
      w.latest = 2 * walls.gap / cosine;
      trial.add(s.start(d), d, w);
    }
    // Another wall may stand nearer: then something is hit all the same, and sooner.
    done += each;
    sink(trial);
  }
}

/// Rays from the walls along them or away from the lids: the wall they left is not hit. Others may
/// be.
void self_hits(Random& random, std::size_t rays, const Sink& sink) {
  const std::size_t each = 1000;
  for (std::size_t done = 0; done < rays;) {
    double size;
    Float3 place;
    if (!draw(random, size, place))
      continue;
    Trial trial;
    trial.occlusion = false;  // whether anything is in the way says nothing about the wall
    const Walls walls(random, size, place, size);
    trial.scene = walls.scene;
    const World world(trial.scene, {.grid = false});
    for (std::size_t i = 0; i < each; ++i) {
      const std::uint32_t k = random.below(80);
      const Float3 eye = at(walls.middle[k / 2], size * random.log_in(1, 1e3), random.direction());
      const Spot s =
          spot(world, k, eye, minus(at(walls.middle[k / 2], .1 * size, random.direction()), eye));
      Float3 d = random.direction();
      if (i % 4 == 0)
        d = flattened(random, d, s.normal);
      if (undecided(d, s.normal))
        continue;
      Expected w;
      w.left = k;
      trial.add(s.start(d), d, w);
    }
    done += each;
    sink(trial);
  }
}

/// Outwards from a sphere, nothing else in the scene.
void sphere_self_hits(Random& random, std::size_t rays, const Sink& sink) {
  for (std::size_t done = 0; done < rays; done += 1000) {
    double size = random.log_in(1e-8, 1e8);
    const Float3 place = random.point(size * random.log_in(1e-2, 1e4));
    Trial trial;
    trial.scene = one_sphere(place, static_cast<float>(size));
    const World world(trial.scene, {.grid = false});
    for (int i = 0; i < 1000; ++i) {
      const Float3 on = at(place, size, random.direction());
      const Spot s = spot(world, 0, on, {0, 0, 1});
      Float3 d = random.direction();
      if (i % 4 == 0)
        d = flattened(random, d, s.normal);
      if (undecided(d, s.normal))
        continue;
      if (dot_in_double(d, s.normal) < 0)
        d = scaled(d, -1);
      Expected w;
      w.miss = true;
      w.left = 0;
      trial.add(s.start(d), d, w);
    }
    sink(trial);
  }
}

/// Shadow rays from a wall to lights above it: before its lid, behind it, and in it, where both
/// answers are right. The distances that decide are 8 ulp of the coordinates and more.
void lights(Random& random, std::size_t rays, const Sink& sink) {
  const std::size_t each = 1000;
  for (std::size_t done = 0; done < rays;) {
    double size;
    Float3 place;
    if (!draw(random, size, place))
      continue;
    Trial trial;
    const Walls walls(random, size, place, size);
    // One pair of walls alone: no other may stand in the way.
    trial.scene = empty_scene();
    const auto corner = [&](std::uint32_t i) { return vertex(walls.scene, i); };
    for (std::uint32_t i = 0; i < 6; i += 3)
      add_triangle(trial.scene, corner(i), corner(i + 1), corner(i + 2));
    const World world(trial.scene, {.grid = false});
    const Size extent = size_of(trial.scene);
    const oracle::Facet lid{vertex(trial.scene, 3), vertex(trial.scene, 4), vertex(trial.scene, 5)};
    const oracle::V across = oracle::unit(lid.normal());
    for (std::size_t i = 0; i < each; ++i) {
      const Float3 eye = at(walls.middle[0],
                            size * random.log_in(1, 1e3),
                            at(random.direction(), 1.5, walls.normal[0]));
      const Spot s =
          spot(world, 0, eye, minus(at(walls.middle[0], .2 * size, random.direction()), eye));
      // At a point of the lid, off it by nothing or by anything from an ulp to the size.
      const double off = random.chance(.2) ? 0 : random.sign() * size * random.log_in(1e-8, .5);
      const Float3 on =
          at(at(walls.middle[0], size, walls.normal[0]), .3 * size, random.direction());
      const oracle::V p = oracle::V(on) - dot(oracle::V(on) - lid.a, across) * across;
      const double side = static_cast<double>(dot(across, walls.normal[0])) > 0 ? 1 : -1;
      const oracle::V q = p + oracle::Real(off * side) * across;
      const Float3 light{static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
      const Float3 up = minus(light, s.point);
      const Float3 start = s.start(up), dir = minus(light, start);
      // Signed distance of the float light: beyond the lid (positive) or before it.
      const oracle::Real beyond =
          oracle::Real(side) * dot(oracle::V(start) + oracle::V(dir) - lid.a, across);
      const oracle::Real open = allowed(extent.diagonal, extent.diagonal, extent.largest);
      Expected w;
      w.hit = beyond > open;
      w.miss = beyond < -open;
      w.latest = 1;
      trial.add(start, dir, w, 1);
    }
    done += each;
    sink(trial);
  }
}

}  // namespace

std::vector<Row> contact_rows() {
  return {
      {"lost contacts",
       "a lid .001 of the size over a wall; size and offset 1e-8 to 1e8",
       "the lid, or something nearer",
       contacts},
      {"self-hits of triangles",
       "in all directions and along the surface; the same sizes",
       "not the triangle left",
       self_hits},
      {"self-hits of spheres", "outwards and along the surface", "nothing", sphere_self_hits},
      {"shadow rays to a light at a wall",
       "before, in and behind it; the same sizes",
       "the side the light is on",
       lights},
  };
}

}  // namespace grelha::stability
