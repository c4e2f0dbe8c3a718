// Mirrors and glass against closed forms in long double.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernel/shade/look.hpp"

namespace grelha::test {
namespace {

using oracle::Real;
using oracle::V;

TEST(Shade, MirrorShowsWhatItFaces) {
  Material m;
  m.mirror = {.5f, .25f, 1};
  Scene s = floor_scene(m);
  s.materials.push_back(glowing({1, 1, 1}));
  s.geometry.spheres.add({-4, 4, 0}, 1, 1);
  const Pixel p = look(s, {4, 4, 0}, {0, 0, 0});
  EXPECT_EQ(p.r, .5f);
  EXPECT_EQ(p.g, .25f);
  EXPECT_EQ(p.b, 1.f);
  EXPECT_EQ(p.stats.rays.reflection, 1u);
  // At the end of the path the background is seen, whatever stands there.
  const Pixel end = look(s, {4, 4, 0}, {0, 0, 0}, 1);
  EXPECT_EQ(end.r, .5f * .1f);
  EXPECT_EQ(end.g, .25f * .2f);
  EXPECT_EQ(end.b, .3f);
  EXPECT_EQ(end.stats.rays.reflection, 0u);
}

TEST(Shade, DepthCountsTheEyeRayAsOne) {
  Material m;
  m.mirror = {.5f, .5f, .5f};
  m.emission = {1, 0, 0};
  Scene s;
  s.materials = {m};
  // two mirrors face to face
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0);
  s.geometry.planes.add({0, 2, 0}, {0, 1, 0}, 0);
  s.background = {0, 1, 0};
  for (int depth = 1; depth <= 40; ++depth) {
    const Pixel p = look(s, {0, 1, 0}, {0, 0, .25f}, depth);
    // Each of `depth` hits sends 1, halved at each bounce; the last one's reflection sees the
    // background. Powers of two: exact.
    EXPECT_FLOAT_EQ(p.r, static_cast<float>(2 - std::ldexp(1., 1 - depth))) << depth;
    EXPECT_NEAR(p.g, std::ldexp(1., -depth), 1e-9) << depth;  // sums count in 2^-32
    EXPECT_EQ(p.stats.rays.reflection, static_cast<std::uint64_t>(depth - 1));
  }
}

TEST(Shade, NoWeightSendsNoRay) {
  Scene s = random_mixture(4, 60);
  s.lights = {{{0, 5, 5}, {1, 1, 1}}};
  const World world(s, {});
  Camera c;
  c.eye = {0, 0, 4};
  c.width = 40;
  c.height = 30;
  RenderStats stats;
  render(world, c, {}, stats);
  EXPECT_EQ(stats.rays.primary, 1200u);
  EXPECT_EQ(stats.rays.reflection, 0u);
  EXPECT_EQ(stats.rays.refraction, 0u);
  EXPECT_GT(stats.rays.shadow, 100u);
}

/// Water below y = 0, a red sky above that is the background, green ground at y = -1.
Scene water(float ior, bool fresnel, float transmission = 1) {
  Material m;
  m.transmission = transmission;
  m.ior = ior;
  m.fresnel = fresnel;
  Scene s = floor_scene(m);
  s.background = {1, 0, 0};
  s.materials.push_back(glowing({0, 1, 0}));
  s.geometry.planes.add({0, -1, 0}, {0, 1, 0}, 1);
  return s;
}

Real schlick(Real ior, Real cosine) {
  const Real r0 = (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1));
  return r0 + (1 - r0) * std::pow(1 - cosine, Real(5));
}

TEST(Shade, SchlickSplitsTheLight) {
  for (const float ior : {1.1f, 1.5f, 2.4f})
    for (int i = 1; i < 20; ++i) {
      const Float3 eye{0, 1, static_cast<float>(std::tan(i * 4 * 3.14159265 / 180))};
      const Pixel p = look(water(ior, true), eye, {0, 0, 0});
      const Real kr = schlick(ior, 1 / length(V(eye)));
      // (1 - cosine)^5 takes the cosine's error five times
      EXPECT_NEAR(p.r, double(kr), 10 * kFew) << ior << ' ' << i;
      EXPECT_NEAR(p.r + p.g, 1, 4e-7) << ior << ' ' << i;  // nothing lost, nothing won
      EXPECT_EQ(p.stats.rays.reflection, 1u);
      EXPECT_EQ(p.stats.rays.refraction, 1u);
    }
}

/// From within, the angle that counts is the one on the thinner side.
TEST(Shade, SchlickFromWithin) {
  const float ior = 1.5f;
  for (int i = 0; i < 20; ++i) {
    // up to 38 degrees, below the critical 41.8
    const Real angle = i * 2 * 3.14159265358979L / 180;
    const Float3 eye{0, -.5f, static_cast<float>(.5L * std::tan(angle))};
    const Pixel p = look(water(ior, true), eye, {0, 0, 0});
    const Real sine = ior * length(V{eye.x, 0, eye.z}) / length(V(eye));
    const Real kr = schlick(ior, std::sqrt(1 - sine * sine));
    // cos = sqrt(1 - sin^2) steepens towards the critical angle: d cos / d sin = tan of the angle
    // outside, below 3 here.
    EXPECT_NEAR(p.g, double(kr), 50 * kFew) << i;
    EXPECT_NEAR(p.r, double(1 - kr), 50 * kFew) << i;
  }
}

TEST(Shade, TotalReflectionTakesAll) {
  for (const bool fresnel : {false, true})
    for (const double degrees : {43., 60., 85.}) {  // critical: 41.8
      const Float3 eye{0, -.5f, static_cast<float>(.5 * std::tan(degrees * 3.14159265 / 180))};
      const Pixel p = look(water(1.5f, fresnel), eye, {0, 0, 0});
      EXPECT_EQ(p.r, 0) << degrees;
      EXPECT_EQ(p.g, 1) << degrees;
      EXPECT_EQ(p.stats.rays.refraction, 0u);
      EXPECT_EQ(p.stats.rays.reflection, 1u);
    }
}

TEST(Shade, WithoutFresnelWeightsStandAsWritten) {
  Scene s = water(1.3f, false, .25f);
  s.materials[0].mirror = {.5f, .5f, .5f};
  const Pixel p = look(s, {0, 1, .5f}, {0, 0, 0});
  EXPECT_EQ(p.r, .5f);
  EXPECT_EQ(p.g, .25f);
}

/// A pane shifts a slanting ray sideways by what Snell's law says: told from the light on the floor
/// where it comes out.
TEST(Shade, PaneShiftsByWhatSnellSays) {
  Material glass;
  glass.transmission = 1;
  glass.ior = 1.5f;
  Scene s;
  s.materials = {glass, plain({1, 1, 1})};
  const Float3 light{1.5f, -2.5f, 0};
  s.lights = {{light, {1, 1, 1}}};
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0);
  s.geometry.planes.add({0, -1, 0}, {0, -1, 0}, 0);
  s.geometry.planes.add({0, -3, 0}, {0, 1, 0}, 1);
  for (int i = 0; i < 18; ++i) {
    const Real outside = i * 4.5L * 3.14159265358979L / 180;
    const Float3 eye{static_cast<float>(-std::tan(outside)), 1, 0};
    const Real sine = length(V{eye.x, 0, 0}) / length(V(eye)), inner = sine / 1.5L;
    const Real x =
        // through the pane, then 2 down to the floor
        inner / std::sqrt(1 - inner * inner) + 2 * std::abs(Real(eye.x));
    const Real cosine = oracle::unit(V(light) - V{x, -3, 0}).y;
    const Pixel p = look(s, eye, {0, 0, 0});
    // The floor's point is off by a few eps of the path times 1 / cos^2 of its slant, up to 80
    // there; the light hangs .5 above.
    const Real slant = 1 - sine * sine;
    EXPECT_NEAR(p.r, double(cosine), double(16 * 6e-8L * (1 + x) / slant / .5L))
        << i << ", at x " << double(x);
    EXPECT_EQ(p.stats.rays.refraction, 2u) << i;
  }
}

/// The same at a ball of index 1: nothing is bent and nothing lost.
TEST(Shade, GlassOfIndexOneIsNotThere) {
  Material air;
  air.transmission = 1;
  air.ior = 1;
  Scene s;
  s.materials = {air, plain({1, 1, 1})};
  s.geometry.spheres.add({0, 2, 0}, 1, 0);
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 1);
  s.lights = {{{5, 1, 0}, {1, 1, 1}}};
  Scene bare = s;
  bare.geometry.spheres = {};
  for (const float x : {0.f, .3f, -.5f, .8f}) {
    const Float3 eye{x, 5, .1f}, at{x / 2, 0, 0};
    EXPECT_NEAR(look(s, eye, at).r, look(bare, eye, at).r, 10 * kFew) << x;
  }
}

}  // namespace
}  // namespace grelha::test
