// Compares pictures of effects with known results.
#include <cmath>
#include <numbers>

#include "frontend/input/effects.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

Image picture(const Scene& scene, const Camera& camera, const RenderOptions& options) {
  const World world(scene, {});
  RenderStats stats;
  return render(world, camera, options, stats);
}

RenderOptions samples(int n, Sampler sampler = Sampler::kSobol) {
  RenderOptions o;
  o.sampling.samples = n;
  o.sampling.sampler = sampler;
  return o;
}

Material glowing() {
  Material m;
  m.emission = {1, 1, 1};
  return m;
}

/// At 1024 samples an Owen-scrambled edge is known to .0022 RMSE (sampling_test); five of these.
constexpr double kEdge1024 = .011;

TEST(Coverage, OfAHalfPlane) {
  Scene s;
  s.materials = {glowing()};
  // Everything below the line through (-.5, -.2) and (.5, .3) of a pixel one unit across: covered
  // .5 (.3 + .8) = .55.
  add_triangle(s, {-10, -4.95f, 0}, {10, -20, 0}, {10, 5.05f, 0});
  add_triangle(s, {-10, -4.95f, 0}, {-10, -20, 0}, {10, -20, 0});
  const Camera c = straight_down(1, 1, 1);
  EXPECT_NEAR(picture(s, c, samples(1024)).rgb[0], .55, kEdge1024);
  EXPECT_NEAR(picture(s, c, samples(1024, Sampler::kJitter)).rgb[0], .55, kEdge1024 * 1.3);
}

TEST(Coverage, OfADisc) {
  Scene s;
  s.materials = {glowing()};
  // far: seen as a disc of radius 30 / sqrt(101^2 - 30^2)
  s.geometry.spheres.add({.1f, -.05f, -100}, 30, 0);
  const double radius = 30 / std::sqrt(101. * 101 - 30 * 30);
  const double covered = std::numbers::pi * radius * radius;
  EXPECT_NEAR(picture(s, straight_down(1, 1, 1), samples(1024)).rgb[0], covered, kEdge1024);
}

/// Lambert term of a floor point at the origin under a square light at height 2, whose lower
/// half-space x < edge is cut off by an occluder at height 1: by midpoints in double.
double penumbra(double at_x, double side, double edge) {
  constexpr int n = 1000;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = ((i + .5) / n - .5) * side, y = ((j + .5) / n - .5) * side;
      if ((at_x + x) / 2 < edge)
        continue;  // where the shadow ray passes height 1
      sum += 2 / std::sqrt((x - at_x) * (x - at_x) + y * y + 4);
    }
  return sum / n / n;
}

TEST(AreaLight, CastsThePenumbraOfASquare) {
  Scene s;
  s.materials.emplace_back().diffuse = {1, 1, 1};
  s.geometry.planes.add({0, 0, 0}, {0, 0, 1}, 0);
  add_triangle(s, {0, -50, 1}, {0, 50, 1}, {-50, 0, 1});  // covers x < 0 around the middle
  s.lights = {{{0, 0, 2}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}};
  // The eye looks from below the occluder's edge, so that it does not stand in the way.
  for (const float x : {-.6f, -.3f, 0.f, .2f, .45f, .8f}) {
    Camera c;
    c.eye = {x, -.5f, .5f};
    c.at = {x, 0, 0};
    c.up = {0, 0, 1};
    c.width = c.height = 1;
    c.angle_deg = .01;
    const double wanted = penumbra(x, 1, 0);
    EXPECT_NEAR(picture(s, c, samples(1024)).rgb[0], wanted, kEdge1024) << "x " << x;
    RenderOptions many = samples(4);
    many.sampling.light_rays = 256;
    EXPECT_NEAR(picture(s, c, many).rgb[0], wanted, kEdge1024) << "x " << x << ", 256 rays a hit";
  }
}

TEST(Lens, BlursAPointIntoAnEvenDisc) {
  // A glowing ball at distance 4, focus at 2, aperture a: seen in the focal plane as a disc of
  // radius a/2 * (4 - 2) / 4.
  Scene s;
  s.materials = {glowing()};
  s.geometry.spheres.add({0, 0, -3}, .01f, 0);
  Camera c = straight_down(64, 64, .64);  // at distance 1; at the focal plane a pixel is .02 across
  c.aperture = .8;
  c.focus = 2;
  const Image image = picture(s, c, samples(1024));
  // 10 pixels, and the ball's own 0.25
  const double radius = .8 / 2 * (4. - 2) / 4 / .02, ball = .01 / 4 * 2 / .02;
  double inner = 0, outer = 0, beyond = 0;
  int inner_count = 0, outer_count = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double r = std::hypot(x + .5 - 32, y + .5 - 32), light = image.row(y)[3 * x];
      if (r > radius + ball + 1)
        beyond += light;
      if (r < radius / std::numbers::sqrt2 - 1) {
        inner += light;
        ++inner_count;
      } else if (r < radius - 1.5 && r > radius / std::numbers::sqrt2) {
        outer += light;
        ++outer_count;
      }
    }
  EXPECT_EQ(beyond, 0);
  EXPECT_GT(inner, 0);
  // About 80,000 and 50,000 rays' worth of pixels see the ball with chance (ball / radius)^2 =
  // 1/1600: 50 and 30 hits a ring at the least, each known to 20 %; the ratio to 25 %.
  EXPECT_NEAR(inner / inner_count / (outer / outer_count), 1, .25);
}

TEST(Lens, LeavesTheFocalPlaneSharp) {
  Scene s;
  s.materials = {glowing()};
  add_triangle(s, {-10, -4.95f, 0}, {10, -20, 0}, {10, 5.05f, 0});
  add_triangle(s, {-10, -4.95f, 0}, {-10, -20, 0}, {10, -20, 0});
  Camera c = straight_down(8, 8, 1), pinhole = c;
  c.aperture = .3;
  c.focus = 1;
  const Image a = picture(s, c, samples(64)), b = picture(s, pinhole, samples(64));
  // The same pixel positions hit the same points of the plane; only rounding tells them apart.
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    EXPECT_NEAR(a.rgb[i], b.rgb[i], 1. / 64 + 1e-6) << i;
}

TEST(Gloss, SeesItsShareOfAHalfWhiteWorld) {
  // A mirror seen straight down reflects straight up, into a lobe of tan(radius) = roughness. Above
  // it, at height 10, the world glows where x > edge: the lobe's share of it is a segment of a
  // disc.
  Scene s;
  s.materials.resize(2);
  s.materials[0].mirror = {1, 1, 1};
  s.materials[0].roughness = .2f;
  s.materials[1] = glowing();
  s.geometry.planes.add({0, 0, 0}, {0, 0, 1}, 0);
  for (const double offset : {-1.2, 0., .7, 1.5}) {
    Scene t = s;
    const auto e = static_cast<float>(offset);
    add_triangle(t, {e, -1000, 10}, {e, 1000, 10}, {2000, 0, 10}, 1);
    const double h = offset / (10 * .2),
                 share = (std::acos(h) - h * std::sqrt(1 - h * h)) / std::numbers::pi;
    Camera c = straight_down(1, 1, 1e-4);
    EXPECT_NEAR(picture(t, c, samples(1024)).rgb[0], share, kEdge1024) << offset;
    RenderOptions o = samples(4);
    o.sampling.glossy_rays = 255;  // and the mirror direction itself
    EXPECT_NEAR(picture(t, c, o).rgb[0], (255 * share + (offset < 0)) / 256, kEdge1024)
        << offset << ", rays around";
  }
}

TEST(Effects, SeedsGiveIndependentPictures) {
  const Scene s = everything();
  Camera c;
  c.eye = {.3f, .5f, 3.5f};
  c.at = {0, 0, 0};
  c.width = c.height = 48;
  RenderOptions o = samples(4), reference = samples(1024);
  reference.sampling.seed = 99;
  const Image truth = picture(s, c, reference), a = picture(s, c, o);
  o.sampling.seed = 1;
  const Image b = picture(s, c, o);
  double ab = 0, abab = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    const double x = a.rgb[i] - truth.rgb[i], y = b.rgb[i] - truth.rgb[i];
    ab += x * y;
    abab += x * x * y * y;
  }
  EXPECT_GT(abab, 0);
  EXPECT_LT(std::abs(ab), 4 * std::sqrt(abab))
      << "errors of the two must be uncorrelated: four standard errors of their product";
}

TEST(Effects, OfMaterialsThatNothingHasAreNotSampled) {
  SceneFile f;
  f.scene.materials.resize(2);
  f.scene.materials[1].mirror = {1, 1, 1};
  f.scene.materials[1].roughness = .1f;
  f.scene.geometry.spheres.add({0, 0, 0}, 1, 0);
  RenderOptions o;
  apply_effects({}, f, o);
  EXPECT_EQ(o.sampling.samples, 1);
  f.scene.geometry.planes.add({0, -1, 0}, {0, 1, 0}, 1);
  apply_effects({}, f, o);
  EXPECT_EQ(o.sampling.samples, 16);
}

TEST(Effects, AreTakenFromTheCommandLine) {
  SceneFile f;
  f.scene.materials.resize(2);
  f.scene.materials[1].mirror = {1, 1, 1};
  f.scene.lights = {{{0, 0, 5}, {1, 1, 1}}, {{5, 0, 0}, {1, 1, 1}, {0, 1, 0}, {0, 0, 1}}};
  f.camera.eye = {0, 0, 2};
  RenderOptions o;
  Effects e;
  apply_effects(e, f, o);
  EXPECT_EQ(o.sampling.samples, 16) << "an area light in the scene wants sampling";
  e.jitter = 3;
  e.lens = Effects::Lens{20, 1.5, 4};
  e.glossy = Effects::Glossy{.3f, 2};
  e.shadows = Effects::Shadows{false, .5f, 12};
  apply_effects(e, f, o);
  EXPECT_EQ(o.sampling.samples, 36);
  EXPECT_EQ(o.sampling.sampler, Sampler::kJitter);
  EXPECT_EQ(o.sampling.light_rays, 4) << "144 positions by 36 samples";
  EXPECT_EQ(o.sampling.glossy_rays, 2);
  EXPECT_EQ(f.scene.materials[0].roughness, 0);
  EXPECT_EQ(f.scene.materials[1].roughness, .3f);
  EXPECT_NEAR(
      std::hypot(f.scene.lights[0].edge1.x, f.scene.lights[0].edge1.y, f.scene.lights[0].edge1.z),
      .5,
      1e-6);
  EXPECT_EQ(f.scene.lights[1].edge1, (Float3{0, 1, 0})) << "the scene's own area light stays";
  EXPECT_EQ(f.camera.focus, 1.5);
  // 20 pixels of a plane 2 away, 45 degrees and 512 rows high.
  EXPECT_NEAR(f.camera.aperture, 20 * 2 * 2 * std::tan(std::numbers::pi / 8) / 512, 1e-12);
  e.jitter = 0;
  e.adaptive = {true, .1f, 3};
  apply_effects(e, f, o);
  EXPECT_TRUE(o.subdivision.on);
  EXPECT_EQ(o.sampling.samples, 4) << "lens points through each point";
  e.lens.reset();
  apply_effects(e, f, o);
  EXPECT_EQ(o.sampling.samples, 1);
  EXPECT_EQ(o.sampling.light_rays, 144);
  e.shadows = Effects::Shadows{true, 0, 1};
  apply_effects(e, f, o);
  for (const Light& l : f.scene.lights)
    EXPECT_FALSE(l.is_area());
}

}  // namespace
}  // namespace grelha::test
