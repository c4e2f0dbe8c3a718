#include "tests/stability/picture_checks.hpp"

#include <bit>
#include <cmath>
#include <sstream>

#include "tests/support/scenes.hpp"

namespace grelha::stability {

using namespace test;

Image picture(const Scene& scene,
              const Camera& camera,
              const RenderOptions& options,
              float density) {
  const World world(scene, {.density = density});
  RenderStats stats;
  return render(world, camera, options, stats);
}

void count(PictureCounts& c,
           const Image& image,
           const char* what,
           const std::function<bool(std::size_t, float)>& right) {
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    ++c.pixels;
    bool good = true;
    for (std::size_t k = 0; k < 3; ++k)
      good = good && right(i / 3, image.rgb[i + k]);
    if (good)
      continue;
    if (c.wrong++ == 0) {
      std::ostringstream s;
      s << what << ", pixel " << i / 3 << " in rows of " << image.width << ": " << image.rgb[i]
        << ' ' << image.rgb[i + 1] << ' ' << image.rgb[i + 2];
      c.first = s.str();
    }
  }
}

void count_same(PictureCounts& c, const Image& a, const Image& b, const char* what) {
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    ++c.pixels;
    bool good = true;
    for (std::size_t k = i; k < i + 3; ++k)
      good =
          good && std::bit_cast<std::uint32_t>(a.rgb[k]) == std::bit_cast<std::uint32_t>(b.rgb[k]);
    if (!good && c.wrong++ == 0)
      c.first = std::string(what) + ", pixel " + std::to_string(i / 3);
  }
}

void count_close(PictureCounts& c, const Image& a, const Image& b, const char* what, float by) {
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    ++c.pixels;
    bool good = true;
    for (std::size_t k = i; k < i + 3; ++k)
      good = good && std::abs(a.rgb[k] - b.rgb[k]) <= by;
    if (!good && c.wrong++ == 0)
      c.first = std::string(what) + ", pixel " + std::to_string(i / 3);
  }
}

Camera camera(int size, const Float3& eye, const Float3& at, double angle) {
  Camera c;
  c.eye = eye;
  c.at = at;
  c.width = c.height = size;
  c.angle_deg = angle;
  c.up = {.1f, 1, .2f};
  return c;
}

RenderOptions samples(int n) {
  RenderOptions o;
  o.sampling.samples = n;
  return o;
}

Scene stage() {
  Scene s = random_mixture(5, 60);
  s.materials.resize(2);
  s.materials[1].mirror = {.7f, .8f, .9f};
  Random random(4);
  for (std::uint32_t& m : s.geometry.triangles.material)
    m = random.below(2);
  s.lights = {{{3, 4, 5}, {.7f, .7f, .6f}}};
  s.background = {.1f, .2f, .3f};
  return s;
}

}  // namespace grelha::stability
