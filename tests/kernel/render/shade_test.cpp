// Shading against closed forms in long double: one ray, one pixel, one effect at a time.
#include <functional>

#include "kernel/grid/world_impl.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using oracle::Real;
using oracle::V;

struct Pixel {
  float r, g, b;
  RenderStats stats;
};

/// The one pixel a camera sees that looks from eye exactly at `at`.
Pixel look(const Scene& scene, const Float3& eye, const Float3& at, int depth = 5) {
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

Material plain(const Float3& diffuse) {
  Material m;
  m.diffuse = diffuse;
  return m;
}
Material glowing(const Float3& light) {
  Material m;
  m.emission = light;
  return m;
}

/// A floor at y = 0 seen by an eye above; materials[0] is the floor's.
Scene floor_scene(const Material& m) {
  Scene s;
  s.materials = {m};
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0);
  s.background = {.1f, .2f, .3f};
  return s;
}

/// What a handful of float operations may add up to: the direction (12 eps, camera_test) and the
/// hit point move the cosine by that much each, the light's direction, its normalising and the
/// products take about 20 roundings more.
constexpr double kFew = 64 * 6e-8;

TEST(Shade, LambertOnAFloor) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Scene s = floor_scene(plain({.5f, .25f, .125f}));
    const Float3 light{static_cast<float>(random.in(-3, 3)),
                       static_cast<float>(random.log_in(.3, 10)),
                       static_cast<float>(random.in(-3, 3))};
    s.lights = {{light, {.5f, 1, 2}}};
    const Float3 spot{
        static_cast<float>(random.in(-1, 1)), 0, static_cast<float>(random.in(-1, 1))};
    const Pixel p = look(s, {0, 5, 1}, spot);
    const Real cosine = oracle::unit(V(light) - V(spot)).y;
    EXPECT_NEAR(p.r, double(.25L * cosine), 10 * kFew)
        << seed;  // light .3 above: the spot's own error weighs ten times there
    EXPECT_NEAR(p.g, double(.25L * cosine), 10 * kFew) << seed;
    EXPECT_NEAR(p.b, double(.25L * cosine), 10 * kFew) << seed;
    EXPECT_EQ(p.stats.rays.shadow, 1u);
    EXPECT_EQ(p.stats.rays.total(), 2u);
  }
}

TEST(Shade, BlinnHighlight) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Material m;
    m.specular = {.5f, 1, .25f}, m.shine = static_cast<float>(random.log_in(1, 200));
    Scene s = floor_scene(m);
    const Float3 eye{static_cast<float>(random.in(-2, 2)), 3, static_cast<float>(random.in(-2, 2))};
    const Float3 light{
        static_cast<float>(random.in(-3, 3)), 4, static_cast<float>(random.in(-3, 3))};
    s.lights = {{light, {1, 1, 1}}};
    const Pixel p = look(s, eye, {0, 0, 0});
    const Real nh = oracle::unit(oracle::unit(V(light)) + oracle::unit(V(eye))).y,
               wanted = std::pow(nh, Real(m.shine));
    // The cosine's error is multiplied by the exponent; power() itself adds what power_test allows,
    // which is less.
    const double tolerance = kFew * (1 + m.shine);
    EXPECT_NEAR(p.r, double(.5L * wanted), tolerance) << seed;
    EXPECT_NEAR(p.g, double(wanted), tolerance) << seed;
    EXPECT_NEAR(p.b, double(.25L * wanted), tolerance) << seed;
  }
}

TEST(Shade, LightsAdd) {
  Scene s = floor_scene(plain({1, 1, 1}));
  s.materials[0].emission = {0, 0, .5f};
  for (int i = 0; i < 7; ++i)
    s.lights.push_back({{0, 2, 0}, {.125f, 0, 0}});
  s.lights.push_back({{0, 2, 0}, {0, .25f, 0}});
  const Pixel p = look(s, {0, 3, 2}, {0, 0, 0});
  EXPECT_NEAR(p.r, .875, kFew);
  EXPECT_NEAR(p.g, .25, kFew);
  EXPECT_EQ(p.b, .5f);
  EXPECT_EQ(p.stats.rays.shadow, 8u);
}

TEST(Shade, ShadowsAreHardAndWhole) {
  Scene s = floor_scene(plain({1, 1, 1}));
  s.lights = {{{0, 4, 0}, {1, 1, 1}}};
  s.materials.push_back(plain({}));
  s.geometry.spheres.add({0, 2, 0}, .5f, 1);
  // The cone of shadow from height 4 about the ball's rim: sin = 1/4, so its radius on the floor is
  // 4 tan(asin(1/4)) = 1.0328.
  EXPECT_EQ(look(s, {1.5f, 1, 3}, {1.02f, 0, 0}).r, 0);
  EXPECT_GT(look(s, {1.5f, 1, 3}, {1.04f, 0, 0}).r, .9f);
  s.materials[1].transmission = 1;  // any hit blocks, glass too
  EXPECT_EQ(look(s, {1.5f, 1, 3}, {.5f, 0, 0}).r, 0);
}

TEST(Shade, NothingBeyondTheLightBlocks) {
  Scene s = floor_scene(plain({1, 1, 1}));
  s.lights = {{{0, 4, 0}, {1, 1, 1}}};
  s.materials.push_back(plain({}));
  s.geometry.spheres.add({0, 6, 0}, 1.9f, 1);
  s.geometry.planes.add({0, 4.001f, 0}, {0, 1, 0}, 1);
  EXPECT_NEAR(look(s, {1, 1, 3}, {0, 0, 0}).r, 1, kFew);
  s.geometry.planes.y[1] = 3.999f;
  EXPECT_EQ(look(s, {1, 1, 3}, {0, 0, 0}).r, 0);
}

TEST(Shade, LightBehindTheSurfaceGivesNothing) {
  Scene s = floor_scene(plain({1, 1, 1}));
  s.lights = {{{0, -4, 0}, {1, 1, 1}}};
  const Pixel p = look(s, {1, 1, 3}, {0, 0, 0});
  EXPECT_EQ(p.r, 0);
  EXPECT_EQ(p.stats.rays.shadow, 0u);
  EXPECT_NEAR(look(s, {1, -1, 3}, {0, 0, 0}).r, 1, kFew);  // from below the lower side shows
}

TEST(Shade, BackgroundWhereNothingIs) {
  const Scene s = floor_scene(plain({1, 1, 1}));
  const Pixel p = look(s, {0, 5, 0}, {0, 6, 0});
  EXPECT_EQ(p.r, .1f);
  EXPECT_EQ(p.g, .2f);
  EXPECT_EQ(p.b, .3f);
}

// ---- reflection
// ------------------------------------------------------------------------------------------

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
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0),
      s.geometry.planes.add({0, 2, 0}, {0, 1, 0}, 0);  // two mirrors face to face
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

// ---- refraction
// ------------------------------------------------------------------------------------------

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
    const Real sine = ior * length(V{eye.x, 0, eye.z}) / length(V(eye)),
               kr = schlick(ior, std::sqrt(1 - sine * sine));
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
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0), s.geometry.planes.add({0, -1, 0}, {0, -1, 0}, 0);
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

// ---- normals
// ------------------------------------------------------------------------------------------

TEST(Shade, SmoothNormalsAreMixed) {
  Scene s;
  s.materials = {plain({1, 1, 1})};
  add_triangle(s, {-1, 0, -1}, {-1, 0, 3}, {3, 0, -1});
  s.geometry.triangles.nx = {0, 1, 0};
  s.geometry.triangles.ny = {2, 1, 3};
  s.geometry.triangles.nz = {0, 0, 3};  // any length
  s.lights = {{{0, 4, 0}, {1, 1, 1}}};
  const Pixel p = look(s, {0, 3, 1}, {0, 0, 0});
  // At the origin the corners weigh 1/2, 1/4, 1/4.
  const V n = oracle::unit(.5L * V{0, 1, 0} + .25L * oracle::unit(V{1, 1, 0}) +
                           .25L * oracle::unit(V{0, 1, 1}));
  EXPECT_NEAR(p.r, double(n.y), kFew);
  // one corner without: flat
  s.geometry.triangles.nx[1] = s.geometry.triangles.ny[1] = s.geometry.triangles.nz[1] = 0;
  EXPECT_NEAR(look(s, {0, 3, 1}, {0, 0, 0}).r, 1, kFew);
}

TEST(Shade, EveryKindHasItsNormal) {
  // Head on: the normal faces the eye, the light hangs at the eye, so the cosine is 1.
  const auto head_on =
      [](const std::function<void(Scene&)>& add, const Float3& eye, const Float3& at) {
        Scene s;
        s.materials = {plain({1, 1, 1})};
        add(s);
        s.lights = {{eye, {1, 1, 1}}};
        return look(s, eye, at).r;
      };
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    s.geometry.spheres.add({1, 2, 3}, 1, 0);
                  },
                  {1, 2, 9},
                  {1, 2, 3}),
              1,
              kFew);
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    s.geometry.spheres.add({1, 2, 3}, 4, 0);
                  },
                  {1, 2, 4},
                  {1, 2, 9}),
              1,
              kFew);  // from within
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    s.geometry.cones.add({0, 0, 0}, 1, {0, 4, 0}, 1, 0);
                  },
                  {5, 2, 0},
                  {0, 2, 0}),
              1,
              kFew);
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    s.geometry.cones.add({0, 0, 0}, 2, {0, 2, 0}, 0, 0);
                  },
                  {3, 3, 0},
                  {1, 1, 0}),
              1,
              kFew);
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    s.geometry.planes.add({0, 1, 0}, {3, 3, 0}, 0);
                  },
                  {4, 5, 0},
                  {0, 1, 0}),
              1,
              kFew);
  EXPECT_NEAR(head_on(
                  [](Scene& s) {
                    add_triangle(s, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
                  },
                  {0, 0, -4},
                  {0, 0, 0}),
              1,
              kFew);
}

TEST(Shade, IsSelectedByTheMaterialsThatPrimitivesHave) {
  Scene s;
  Material all = plain({1, 1, 1});
  all.mirror = all.specular = all.emission = {1, 1, 1};
  all.transmission = all.roughness = .5f;
  all.fresnel = true;
  s.materials = {plain({1, 1, 1}), all};
  const auto selected = [&s] {
    const World world(s, {});
    const ShadingView& v = world.impl().shading;
    return std::vector<bool>{v.reflects, v.refracts, v.fresnel, v.emits, v.highlights, v.gloss};
  };
  s.geometry.spheres.add({0, 0, 0}, 1, 0);
  EXPECT_EQ(selected(), std::vector<bool>(6, false));
  const std::function<void()> add[] = {[&] {
                                         s.geometry.spheres.add({3, 0, 0}, 1, 1);
                                       },
                                       [&] {
                                         s.geometry.planes.add({0, -3, 0}, {0, 1, 0}, 1);
                                       },
                                       [&] {
                                         s.geometry.cones.add({0, 3, 0}, 1, {0, 4, 0}, 0, 1);
                                       }};
  for (const auto& a : add) {
    const Scene before = s;
    a();
    EXPECT_EQ(selected(), std::vector<bool>(6, true));
    s = before;
  }
}

}  // namespace
}  // namespace grelha::test
