// Lenses, lights and lobes of no size and of any; samples that agree with each other.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "tests/stability/picture_checks.hpp"
#include "tests/stability/picture_kinds.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {

using namespace test;

/// A lens of no size is a pinhole; one as large as the scene, focused near or far, gives finite
/// light no brighter than what there is.
PictureCounts lenses(int size) {
  PictureCounts c;
  const Scene s = stage();
  Camera pin = camera(size, {.3f, .5f, 3.5f}, {}, 45), lens = pin;
  lens.aperture = 0;
  lens.focus = 1e-3;
  count_same(c, picture(s, lens, samples(4)), picture(s, pin, samples(4)), "no aperture");
  Scene white;
  white.materials.resize(1);
  white.materials[0].emission = {1, 1, 1};
  white.geometry.spheres.add({}, 100, 0);
  for (const double aperture : {1e-30, 1e-6, 10., 150.})
    for (const double focus : {1e-6, 1., 1e6, 1e30}) {
      lens.aperture = aperture;
      lens.focus = focus;
      std::ostringstream what;
      what << "in a white ball, aperture " << aperture << ", focus " << focus;
      count(c, picture(white, lens, samples(4)), what.str().c_str(), [&](std::size_t, float x) {
        return x == 1;
      });
    }
  for (const double focus : {0., -1., double{kInf}, double{kNaN}}) {
    lens.aperture = .1;
    lens.focus = focus;
    ++c.pixels;
    try {
      const Image image = picture(s, lens, samples(4));
      count(c, image, "focus 0 or infinite", [](std::size_t, float x) { return std::isfinite(x); });
    } catch (const std::invalid_argument&) {  // refused: as good an answer
    }
  }
  return c;
}

/// An area light of no or next to no size is a point light; edges of rounding's size must not lose
/// its light.
PictureCounts light_of_no_size(int size) {
  PictureCounts c;
  Scene s = stage(), area = s;
  const Camera cam = camera(size, {.3f, .5f, 3.5f}, {}, 45);
  const Image wanted = picture(s, cam, samples(4));
  area.lights[0].edge1 = {1e-30f, 0, 0};
  area.lights[0].edge2 = {0, 1e-30f, 0};
  count_close(c, picture(area, cam, samples(4)), wanted, "1e-30", 1e-5f);
  area.lights[0].edge1 = {};
  area.lights[0].edge2 = {1e-38f, 0, 0};
  count_close(c, picture(area, cam, samples(4)), wanted, "a line of 1e-38", 1e-5f);
  area.lights[0].edge2 = {};
  count_same(c, picture(area, cam, samples(4)), wanted, "none");
  return c;
}

/// A mirror of roughness 0 is a mirror; one of next to none nearly is.
PictureCounts roughness_of_nothing(int size) {
  PictureCounts c;
  Scene s = stage();
  const Camera cam = camera(size, {.3f, .5f, 3.5f}, {}, 45);
  const Image wanted = picture(s, cam, samples(4));
  RenderOptions many = samples(4);
  many.sampling.glossy_rays = 3;
  count_same(c, picture(s, cam, many), wanted, "roughness 0 and rays around");
  // A lobe of 1e-20 is narrower than a rounding: what it changes is the rounding of directions.
  s.materials[1].roughness = 1e-20f;
  const Image rough = picture(s, cam, samples(4));
  PictureCounts close;
  count_close(close, rough, wanted, "roughness 1e-20", .02f);
  // where rounding moves a mirrored outline
  close.wrong = close.wrong > close.pixels / 100 ? close.wrong : 0;
  c.pixels += close.pixels;
  c.wrong += close.wrong;
  if (c.first.empty() && close.wrong > 0)
    c.first = close.first;
  return c;
}

/// Discs of a tenth of a pixel, one in every fourth pixel each way. Four corners that agree miss
/// them; `--error` must show each, as it doubts every pixel in which something may hide.
PictureCounts small_discs(int size) {
  // pixels an eighth of a radian wide are too wide to be watched (docs/proofs.md)
  size = std::max(size, 16);
  PictureCounts c;
  Scene s;
  s.materials.resize(1);
  s.materials[0].emission = {1, 1, 1};
  Random random(11);
  const int n = size / 4;
  const double pixel = 1. / size;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double right = (4 * x + random.in(.2, .8)) * pixel,
                   down = (4 * y + random.in(.2, .8)) * pixel;
      s.geometry.spheres.add({static_cast<float>(right - .5), static_cast<float>(.5 - down), 0},
                             static_cast<float>(.1 * pixel),
                             0);
    }
  Camera cam = straight_down(size, size, 1);
  RenderOptions o;
  o.refine.error = .002;
  const Image image = picture(s, cam, o);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      ++c.pixels;
      if (image.row(4 * y)[12 * x] > 0)
        continue;
      if (c.wrong++ == 0)
        c.first = "disc in pixel " + std::to_string(4 * x) + ", " + std::to_string(4 * y);
    }
  return c;
}

namespace {

/// Of pictures of one pixel with other seeds.
struct Mean {
  double value, spread;
};

Mean mean_of(const World& world, const Camera& cam, Sampler sampler, int n, int runs) {
  double sum = 0, square = 0;
  for (int k = 0; k < runs; ++k) {
    RenderOptions o = samples(n);
    o.sampling.sampler = sampler;
    o.sampling.seed = static_cast<std::uint32_t>(k + 1);
    o.threads = 1;
    RenderStats stats;
    const double x = render(world, cam, o, stats).rgb[0];
    sum += x;
    square += x * x;
  }
  sum /= runs;
  return {sum, std::sqrt(std::max(0., square / runs - sum * sum) / (runs - 1))};
}

Scene penumbra() {
  Scene s = empty_scene();
  s.geometry.planes.add({0, 0, 0}, {0, 0, 1}, 0);
  add_triangle(s, {0, -50, 1}, {0, 50, 1}, {-50, 0, 1});
  s.lights = {{{0, 0, 2}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}};
  return s;
}

}  // namespace

/// Samples of pixel and light that keep step would leave a bias where both are soft: a penumbra
/// behind a pixel's edge, against its mean over independent samples. Four standard errors.
PictureCounts correlated(int size) {
  const Scene s = penumbra();
  const World world(s, {});
  Camera cam;  // one pixel, all of the penumbra in it
  cam.eye = {.2f, -.5f, .5f};
  cam.at = {.2f, 0, 0};
  cam.up = {0, 0, 1};
  cam.width = cam.height = 1;
  cam.angle_deg = 60;
  PictureCounts c;
  const Mean truth = mean_of(world, cam, Sampler::kRandom, 4096, size);
  for (const Sampler sampler : {Sampler::kSobol, Sampler::kJitter, Sampler::kRandom}) {
    const Mean mean = mean_of(world, cam, sampler, 16, 8 * size);
    ++c.pixels;
    if (std::abs(mean.value - truth.value) <= 4 * std::hypot(mean.spread, truth.spread))
      continue;
    if (c.wrong++ > 0)
      continue;
    c.first = "sampler " + std::to_string(static_cast<int>(sampler)) + ": " +
              std::to_string(mean.value) + " against " + std::to_string(truth.value);
  }
  return c;
}

}  // namespace grelha::stability
