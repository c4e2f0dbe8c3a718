// What a beam's tolerances are for: scenes in which each of them decides.
#include "grelha/query.hpp"
#include "tests/support/beams.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

class BeamBounds : public EveryVariant {
 protected:
  Tile look(const Scene& s) const { return doubt(s, variant()); }
};
GRELHA_FOR_EVERY_ISA(BeamBounds);

/// The pixel that scenes here are made for: its beam is 1.0625 wide around (-1.5, 2.5, 0).
constexpr int kX = 2;
constexpr int kY = 1;
constexpr Float3 kMiddle{-1.5f, 2.5f, 0};
constexpr float kHalfBeam = .5f * 1.0625f;

Scene dark_wall() {
  Scene s = wall();
  s.lights.clear();
  return s;
}

/// A ball whose middle lies outside the beam: a ray to it must be aimed near the rim, but not
/// past it.
TEST_P(BeamBounds, MeetsABallByItsRim) {
  for (const float radius : {.1f, .3f, .45f}) {
    Scene s = dark_wall();
    s.geometry.spheres.add({kMiddle.x + kHalfBeam + .85f * radius, kMiddle.y, 0}, radius, 0);
    EXPECT_EQ(at(look(s), kX, kY), 2) << radius;
  }
}

/// A ball beside an edge of the beam: it reaches beyond the two sides that meet there, and yet not
/// to where they do.
TEST_P(BeamBounds, MissesABallBesideItsEdge) {
  for (const float radius : {.1f, .3f, .45f}) {
    Scene s = dark_wall();
    const float beside = kHalfBeam + .8f * radius;
    s.geometry.spheres.add({kMiddle.x + beside, kMiddle.y + beside, 0}, radius, 0);
    EXPECT_EQ(at(look(s), kX, kY), 0) << radius;
  }
}

/// Triangles of which only a tip reaches into the beam. A ray to the very tip may pass it by.
TEST_P(BeamBounds, MeetsTrianglesByTheirTips) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    Scene s = dark_wall();
    const auto in = [&](double lo, double hi) { return static_cast<float>(random.in(lo, hi)); };
    const float edge = kMiddle.x + kHalfBeam;
    const float z = in(.01, 1);
    const float y = kMiddle.y;
    add_triangle(s,
                 {edge - in(.05, .3), y + in(-.2, .2), z},
                 {edge + in(.1, .4), y + in(-.3, 0), z},
                 {edge + in(.1, .4), y + in(.1, .3), z});
    EXPECT_EQ(at(look(s), kX, kY), 2) << i;
  }
}

/// Cones along the beam, beside it, whose narrow end does not reach into it: which place of their
/// axis is nearest to the beam's is a matter of rounding.
TEST_P(BeamBounds, MeetsConesAlongItselfByTheirMiddles) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    Camera camera = over_units();
    const Float3 to_eye = random.direction();
    camera.eye = at({0, 0, 0}, 200, to_eye);
    camera.up = random.direction();
    const FrameView f = make_frame(camera);
    const auto in = [&](double lo, double hi) { return static_cast<float>(random.in(lo, hi)); };
    // the middle of a pixel, and the way there
    const int x = static_cast<int>(random.below(8));
    const int y = static_cast<int>(random.below(8));
    Float3 way, aside;
    for (std::uint32_t a = 0; a < 3; ++a) {
      component(way, a) =
          f.forward[a] + (float(x) - 3.5f) * f.right[a] + (3.5f - float(y)) * f.up[a];
      component(aside, a) = 200 * f.right[a];
    }
    const Float3 base = at(at(camera.eye, in(198, 199), way), kHalfBeam + in(.06, .1), aside);
    const Float3 end = at(base, in(-2, -.5), way);
    const bool tip_near = random.chance(.5);
    Scene s = one_plane({0, 0, 0}, to_eye);
    s.geometry.cones.add(base, tip_near ? .3f : 0.f, end, tip_near ? 0.f : .3f, 0);
    EXPECT_EQ(at(doubt(s, variant(), {}, camera), x, y), 2) << i;
  }
}

/// Whether the ray through a place, from the middle of the pixel, meets something before the wall.
bool sees_thing(const World& world, float x, float y) {
  const Float3 eye = over_units().eye;
  const Hit hit = closest(world, {eye, minus({kMiddle.x + x, kMiddle.y + y, 0}, eye)});
  return hit && primitive_of(world, hit.id).kind != PrimitiveKind::kPlane;
}

/// Whether two of 24 x 24 rays through the pixel meet something before the wall, and none through
/// its beam's corners.
bool hides_thing(const Scene& s) {
  constexpr int kRays = 24;
  const World world(s, {});
  for (const float x : {-kHalfBeam, kHalfBeam})
    for (const float y : {-kHalfBeam, kHalfBeam})
      if (sees_thing(world, x, y))
        return false;
  int rays = 0;
  for (int i = 0; i < kRays * kRays; ++i) {
    const auto place = [](int k) { return .96f * ((float(k) + .5f) / kRays - .5f); };
    rays += sees_thing(world, place(i % kRays), place(i / kRays));
  }
  return rays > 1;
}

/// Short and long, flat and pointed, along the beam and across. Where the place of its axis that is
/// nearest to the beam's is an end, the ball there lies half beyond the cone.
TEST_P(BeamBounds, MeetsConesHoweverTheyLie) {
  Random random(5);
  int hidden = 0;
  int missed = 0;
  for (int i = 0; i < 2000; ++i) {
    Scene s = dark_wall();
    const double size = random.log_in(.02, 1);
    const Float3 base = at({kMiddle.x, kMiddle.y, 2}, random.in(0, .6), random.direction());
    const Float3 end = at(base, size, random.direction());
    const auto radius = [&] {
      return static_cast<float>(random.chance(.3) ? 0 : size * random.log_in(.05, 2));
    };
    const float at_end = radius();
    s.geometry.cones.add(base, at_end > 0 ? radius() : .3f * float(size), end, at_end, 0);
    if (!hides_thing(s))
      continue;
    ++hidden;
    missed += at(look(s), kX, kY) == 0;
  }
  EXPECT_GT(hidden, 1000);
  EXPECT_EQ(missed, 0);
}

/// Primitives of any size, to a thousand pixels, that reach into the pixel and far beyond, past the
/// eye as well.
TEST_P(BeamBounds, MeetsWhatReachesFarBeyondIt) {
  Random random(7);
  int hidden[3] = {};
  int missed[3] = {};
  for (std::size_t i = 0; i < 3000; ++i) {
    const std::size_t kind = i % 3;
    Scene s = dark_wall();
    const Float3 in =
        at({kMiddle.x, kMiddle.y, float(random.in(2, 150))}, random.in(0, .7), random.direction());
    const auto away = [&] { return at(in, random.log_in(.02, 1000), random.direction()); };
    const float thin = static_cast<float>(random.log_in(.005, .5));
    if (kind == 0) {
      const Float3 end = away();
      add_triangle(s, in, end, random.chance(.5) ? away() : at(end, thin, random.direction()));
    } else if (kind == 1) {
      s.geometry.cones.add(away(), thin, away(), random.chance(.5) ? thin : 0, 0);
    } else {
      const double radius = random.log_in(.01, 100);
      s.geometry.spheres.add(at(in, radius, random.direction()), static_cast<float>(radius), 0);
    }
    if (!hides_thing(s))
      continue;
    ++hidden[kind];
    missed[kind] += at(look(s), kX, kY) == 0;
  }
  for (std::size_t kind = 0; kind < 3; ++kind) {
    EXPECT_GT(hidden[kind], 50) << kind;
    EXPECT_EQ(missed[kind], 0) << kind;
  }
}

/// A wall across the beam, of triangles smaller than the pixel: all lie as far along the beam as
/// what its corners meet, but for rounding. Those left out would leave holes in the wall.
TEST_P(BeamBounds, MissesNoTriangleOfAWallAcrossIt) {
  Random random(3);
  const Float3 normal = minus(over_units().eye, kMiddle);
  for (int i = 0; i < 50; ++i) {
    const double turn = random.in(0, 3);
    const double c = std::cos(turn);
    const double d = std::sin(turn);
    // two directions across the beam
    const Float3 a{1, 0, -normal.x / normal.z};
    const Float3 b{0, 1, -normal.y / normal.z};
    const auto corner = [&](int x, int y) {
      return at(at(kMiddle, .4 * (c * x - d * y), a), .4 * (d * x + c * y), b);
    };
    Scene s = empty_scene();
    for (int y = -4; y < 4; ++y)
      for (int x = -4; x < 4; ++x) {
        add_triangle(s, corner(x, y), corner(x + 1, y), corner(x + 1, y + 1));
        add_triangle(s, corner(x, y), corner(x + 1, y + 1), corner(x, y + 1));
      }
    EXPECT_EQ(at(look(s), kX, kY), 0) << i;
  }
}

}  // namespace
}  // namespace grelha::test
