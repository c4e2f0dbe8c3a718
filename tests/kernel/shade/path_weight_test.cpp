// Paths that end because nothing they can still bring would show (RenderOptions::min_weight).
#include <algorithm>
#include <cmath>
#include <utility>

#include "grelha/render.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/scenes.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

Material mirror_of(float share) {
  Material m;
  m.mirror = {share, share, share};
  return m;
}

/// Two mirrors face to face, which send out light of `emission`.
Scene face_to_face(float share, float emission) {
  Scene s;
  s.materials = {mirror_of(share)};
  s.materials[0].emission = {emission, 0, 0};
  s.geometry.planes.add({0, 0, 0}, {0, 1, 0}, 0);
  s.geometry.planes.add({0, 2, 0}, {0, 1, 0}, 0);
  return s;
}

/// Two balls of mirroring glass, one within the other.
Scene glass_in_glass(float mirror, float transmission) {
  Scene s;
  s.materials = {mirror_of(mirror)};
  s.materials[0].diffuse = {.2f, .2f, .2f};
  s.materials[0].transmission = transmission;
  s.materials[0].ior = 1.5f;
  s.geometry.spheres.add({0, 0, 0}, 1, 0);
  s.geometry.spheres.add({0, 0, 0}, .6f, 0);
  s.background = {.1f, .2f, .3f};
  s.lights = {{{5, 5, 5}, {1, 1, 1}, {}, {}}};
  return s;
}

/// Many balls of glass and faint mirrors that pass on no more than they get.
Scene faint_mixture(std::uint64_t seed) {
  Scene s = random_spheres(seed, 60);
  Random random(seed);
  s.materials.clear();
  for (int k = 0; k < 6; ++k) {
    const auto mirror = static_cast<float>(random.log_in(.004, .9));
    Material m = mirror_of(mirror);
    m.transmission = k % 2 == 0 ? static_cast<float>(random.in(0, 1 - mirror)) : 0.f;
    m.ior = 1.4f;
    m.diffuse = {.5f, .7f, .3f};
    m.specular = {.2f, .2f, .2f};
    m.shine = 10;
    s.materials.push_back(m);
  }
  for (std::size_t i = 0; i < s.geometry.spheres.size(); ++i)
    s.geometry.spheres.material[i] = static_cast<std::uint32_t>(i % 6);
  s.background = {.9f, .8f, .7f};
  s.lights = {{{0, 5, 5}, {1, 1, 1}, {}, {}}};
  return s;
}

Camera camera_at(const Float3& eye, const Float3& at, int side) {
  Camera c;
  c.eye = eye;
  c.at = at;
  c.width = c.height = side;
  c.angle_deg = 30;
  if (at.x == eye.x && at.z == eye.z)
    c.up = {0, 0, 1};
  return c;
}

TEST(PathWeight, APathEndsWhenItsWeightTimesTheBrightestLightIsTooLittle) {
  const Camera camera = camera_at({0, 1, 0}, {0, 0, .25f}, 1);
  const auto bounces = [&](float emission, double min_weight) {
    const Scene scene = face_to_face(.5f, emission);
    RenderOptions o;
    o.depth = 100;
    o.min_weight = min_weight;
    RenderStats stats;
    render(World(scene, {}), camera, o, stats);
    return stats.rays.reflection;
  };
  EXPECT_EQ(bounces(1, 0), 99u);
  EXPECT_EQ(bounces(1, 1. / 16384), 14u);
  EXPECT_EQ(bounces(4, 1. / 16384), 16u) << "what is brighter shows longer";
  EXPECT_EQ(bounces(.25f, 1. / 16384), 12u);
  EXPECT_EQ(bounces(1, 1), 0u);
  EXPECT_EQ(RenderOptions{}.min_weight, 1. / 16384);
}

/// At its end a path sees the background, whatever ends it: in a world where all is as bright as
/// the background nothing changes.
TEST(PathWeight, AnEndSeesTheBackground) {
  Scene scene = glass_in_glass(.5f, .5f);
  scene.materials[0].diffuse = {0, 0, 0};
  scene.background = {1, 1, 1};
  RenderOptions o;
  o.depth = 200;
  o.min_weight = .01;
  RenderStats stats;
  const Image image = render(World(scene, {}), camera_at({0, 0, 5}, {0, 0, 0}, 24), o, stats);
  for (const float channel : image.rgb)
    EXPECT_NEAR(channel, 1, 1e-5);
}

/// The weights of a sample's rays never sum to more than 1, so at most 1 / W rays of weight W or
/// more are in flight at a time. Here at least a tenth of the light leaves the scene at each
/// surface of the glass, or its rays end because of their weight.
TEST(PathWeight, AnyDepthEnds) {
  constexpr int kSide = 4;
  for (const auto& [mirror, transmission] :
       {std::pair{.5f, .5f}, std::pair{.1f, .9f}, std::pair{.9f, .9f}, std::pair{1.f, 1.f}}) {
    const Scene scene = glass_in_glass(mirror, transmission);
    RenderOptions o;
    o.depth = kMostDepth;
    RenderStats stats;
    render(World(scene, {}), camera_at({0, 0, 5}, {0, 0, 0}, kSide), o, stats);
    EXPECT_LT(stats.rays.reflection + stats.rays.refraction,
              std::uint64_t{kSide * kSide} * 10 * 16384)
        << mirror << ' ' << transmission;
    EXPECT_GT(stats.rays.reflection + stats.rays.refraction, 100u);
  }
}

/// Rays that fan out in lobes end as well: between rough mirrors, where all rays come back.
TEST(PathWeight, FansEnd) {
  Scene scene = face_to_face(.7f, 1);
  scene.materials[0].roughness = .2f;
  RenderOptions o;
  o.depth = kMostDepth;
  o.sampling.glossy_rays = 16;
  RenderStats stats;
  const Image image = render(World(scene, {}), camera_at({0, 1, 0}, {0, 0, .25f}, 1), o, stats);
  EXPECT_LT(stats.rays.reflection, 3'000'000u);
  // The sum of .7^k, without what 30 halvings leave; as many of 17 rays each as are worth it change
  // no mean.
  EXPECT_NEAR(image.rgb[0], 1 / .3, .001);
}

/// 16 branches at most of a path of 5 rays, of 1/16384 each (docs/sampling.md).
TEST(PathWeight, NoChannelMovesByAThousandthAtTheUsualDepth) {
  double most = 0, most_of_large = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Scene scene = faint_mixture(seed);
    const World world(scene, {});
    const auto picture = [&](double min_weight) {
      RenderOptions o;
      o.min_weight = min_weight;
      RenderStats stats;
      return render(world, camera_at({0, 0, 6}, {0, 0, 0}, 64), o, stats);
    };
    const Image all = picture(0), usual = picture(RenderOptions{}.min_weight), large = picture(.01);
    for (std::size_t i = 0; i < all.rgb.size(); ++i) {
      most = std::max(most, std::abs(double(all.rgb[i]) - double(usual.rgb[i])));
      most_of_large = std::max(most_of_large, std::abs(double(all.rgb[i]) - double(large.rgb[i])));
    }
  }
  EXPECT_LE(most, 1. / 1024);
  EXPECT_GT(most, 0) << "something must have ended";
  EXPECT_GT(most_of_large, 1. / 1024) << "and more would show";
}

TEST(PathWeight, EndsAreTheSameForAllLanesPacketsAndThreads) {
  Scene rough = faint_mixture(3);
  for (Material& m : rough.materials)
    m.roughness = .1f;
  for (const Scene& scene : {glass_in_glass(.9f, .8f), faint_mixture(2), rough}) {
    const World world(scene, {});
    const Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 40);
    RenderOptions o;
    o.depth = 12;
    o.min_weight = .001;
    o.sampling.glossy_rays = 3;
    o.sampling.samples = 2;
    o.threads = 1;
    o.packet = 1;
    o.isa = "scalar";
    o.mailbox = false;
    RenderStats stats;
    const Image expected = render(world, camera, o, stats);
    for (const Isa& isa : isas())
      for (const int packet : {1, 16, 64, 256}) {
        if (!isa.is_supported)
          continue;
        o.threads = 2;
        o.packet = packet;
        o.isa = isa.name;
        o.mailbox = true;
        EXPECT_EQ(render(world, camera, o, stats).rgb, expected.rgb) << isa.name << ' ' << packet;
      }
  }
}

}  // namespace
}  // namespace grelha::test
