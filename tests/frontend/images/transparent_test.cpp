// Pictures without their background.
#include "frontend/commands/layers.hpp"

#include "frontend/images/hdr_file.hpp"
#include "frontend/images/image_file.hpp"
#include "tests/support/file_error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <cmath>

namespace grelha {
namespace {

using test::error_of;
constexpr int kSide = 40;
const Float3 kBackgrounds[] = {{.5f, .25f, 1}, {0, 3, .125f}};

/// A ball that glows, mirrors and is lit from an area, before a lens.
struct Balls {
  Balls() {
    scene.geometry.spheres.add({0, 0, 0}, 1, 0);
    scene.geometry.spheres.add({1, .5f, -1}, .75f, 1);
    Material glass;
    glass.mirror = {.25f, .25f, .25f};
    glass.transmission = .5f;
    glass.ior = 1.5f;
    Material plain;
    plain.diffuse = {.5f, .5f, .25f};
    plain.emission = {.125f, 0, .25f};
    scene.materials = {plain, glass};
    scene.lights = {{{2, 4, 5}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}};
    camera.eye = {0, 0, 5};
    camera.angle_deg = 40;
    camera.aperture = 1;
    camera.width = camera.height = kSide;
  }
  RenderOptions options(int samples, Sampler sampler, const Float3& background) const {
    RenderOptions o;
    o.sampling.samples = samples;
    o.sampling.sampler = sampler;
    o.lighting = Lighting{scene.lights, background};
    return o;
  }
  Scene scene;
  Camera camera;
};

struct Pictures {
  Image opaque, cut;
  Alpha alpha;
};

Pictures pictures_of(const Balls& balls, const RenderOptions& options) {
  const World world(balls.scene, {});
  RenderStats stats;
  Pictures p;
  p.opaque = render(world, balls.camera, options, stats);
  p.cut = render_transparent(world, balls.camera, options, stats, p.alpha);
  return p;
}

/// Returns how many channels neither cover the background nor show it whole.
int expect_lies_over(const Pictures& p, const Float3& background) {
  const float channels[] = {background.x, background.y, background.z};
  int edges = 0;
  for (std::size_t i = 0; i < p.cut.rgb.size(); ++i) {
    const float a = p.alpha[i / 3];
    edges += a > 0 && a < 1;
    EXPECT_NEAR(p.cut.rgb[i] + (1 - a) * channels[i % 3], p.opaque.rgb[i], 2e-6);
    if (a == 0 || a == 1) {
      EXPECT_EQ(p.cut.rgb[i], a * p.opaque.rgb[i]) << "nothing remains, and nothing is added";
    }
  }
  return edges;
}

/// Over any background the picture is what a render of that background is. Without mirrors and
/// glass it is the same picture.
TEST(Transparent, LiesOverAnyBackground) {
  for (const std::uint32_t second : {0u, 1u})
    for (const Sampler sampler : {Sampler::kSobol, Sampler::kBlue, Sampler::kJitter})
      for (const int samples : {1, 9}) {
        Balls balls;
        balls.scene.geometry.spheres.material[1] = second;
        Pictures p[2];
        for (const int k : {0, 1}) {
          p[k] = pictures_of(balls, balls.options(samples, sampler, kBackgrounds[k]));
          EXPECT_EQ(expect_lies_over(p[k], kBackgrounds[k]) > 0, samples > 1);
        }
        EXPECT_EQ(p[0].alpha, p[1].alpha) << "of the camera's rays alone";
        for (std::size_t i = 0; second == 0 && i < p[0].cut.rgb.size(); ++i)
          EXPECT_NEAR(p[0].cut.rgb[i], p[1].cut.rgb[i], 2e-6);
      }
}

TEST(Transparent, StopsWhenToldTo) {
  const Balls balls;
  const World world(balls.scene, {});
  RenderOptions o = balls.options(4, Sampler::kSobol, {});
  double most = 0;
  o.progress = [&](double share) { return (most = std::max(most, share)) < .95; };
  RenderStats stats;
  Alpha alpha;
  render_transparent(world, balls.camera, o, stats, alpha);
  EXPECT_GE(most, .95);
  EXPECT_LE(most, 1);
}

const Image kFour = [] {
  Image image(2, 2);
  image.rgb = {.25f, .125f, 0, .5f, 1, .75f, 0, 0, 0, .002f, .004f, .001f};
  return image;
}();
const Alpha kAlpha{.5f, 1, 0, .004f};

/// PNG is unassociated: https://www.w3.org/TR/png-3/#6AlphaRepresentation
TEST(Transparent, PngHoldsColoursThatAlphaDoesNotMultiply) {
  for (const Tone tone : {Tone::authored, Tone::srgb}) {
    const std::string bytes = encode_png(kFour, tone, {}, kAlpha);
    int w = 0, h = 0, channels = 0;
    stbi_uc* const pixels = stbi_load_from_memory(
        reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()), &w, &h, &channels, 0);
    ASSERT_NE(pixels, nullptr);
    ASSERT_EQ(channels, 4);
    const std::vector<int> found(pixels, pixels + 16);
    stbi_image_free(pixels);
    const std::vector<int> authored{
        128, 64, 0, 128, 128, 255, 191, 255, 0, 0, 0, 0, 128, 255, 64, 1};
    const std::vector<int> srgb{188, 137, 0, 128, 188, 255, 225, 255, 0, 0, 0, 0, 188, 255, 137, 1};
    EXPECT_EQ(found, tone == Tone::srgb ? srgb : authored) << "alpha is no colour";
  }
}

/// OpenEXR is associated, with a channel before the colours.
TEST(Transparent, ExrHoldsColoursTimesAlpha) {
  const std::string bytes = encode_exr(kFour, {}, {}, kAlpha);
  const std::size_t a = bytes.find(std::string("A\0", 2)), b = bytes.find(std::string("B\0", 2));
  EXPECT_LT(a, b);
  EXPECT_EQ(b - a, 18u) << "a description of a channel: name, type, samples";
}

TEST(Transparent, IsNotReadUnlessItIsOpaque) {
  TemporaryFolder folder;
  for (const char* name : {"a.png", "a.exr"}) {
    const std::string path = folder.file(name);
    write_image(path, kFour, {.alpha = kAlpha});
    const std::string message = error_of([&] { read_image(path); });
    EXPECT_NE(message.find("expected an opaque picture, found alpha below 1"), message.npos);
    write_image(path, kFour, {.alpha = Alpha(4, 1)});
    const Image back = read_image(path);
    for (std::size_t i = 0; i < back.rgb.size(); ++i)
      EXPECT_NEAR(back.rgb[i], kFour.rgb[i], .5 / 255 + 1e-6);
  }
}

}  // namespace
}  // namespace grelha
