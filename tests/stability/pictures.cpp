#include "tests/stability/pictures.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "grelha/render.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;
using oracle::Real;
using oracle::V;

Image picture(const Scene& scene,
              const Camera& camera,
              const RenderOptions& options,
              float density = 0) {
  const World world(scene, {.density = density});
  RenderStats stats;
  return render(world, camera, options, stats);
}

/// Counts pixels for which `right` does not hold of a value of theirs.
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

Camera camera(int size, const Float3& eye, const Float3& at, double angle = 60) {
  Camera c;
  c.eye = eye;
  c.at = at;
  c.width = c.height = size;
  c.angle_deg = angle;
  c.up = {.1f, 1, .2f};
  return c;
}

/// From within closed bodies of perfect mirrors in a white world: a path that ends at depth 50 sees
/// nothing but mirrors, and one that gets out sees white. At its end the background is seen, so the
/// background is black and a glowing wall stands around the body.
PictureCounts mirror_shaft(int size) {
  PictureCounts c;
  for (const double scale : {1., 1e-6, 1e6})
    for (const int body : {0, 1, 2}) {
      Scene s = body == 0   ? ball_mesh(12, 8, .1)
                : body == 1 ? torus_mesh(24, 12, .4)
                            : ball_mesh(5, 3);
      s = placed(s, scale, {});
      s.materials.resize(2);
      s.materials[0] = {};
      s.materials[0].mirror = {1, 1, 1};
      s.materials[1] = {};
      s.materials[1].emission = {1, 1, 1};
      s.geometry.spheres.add({}, static_cast<float>(4 * scale), 1);
      RenderOptions o;
      o.depth = 50;
      const auto place = [&](float x, float y, float z) { return scaled(Float3{x, y, z}, scale); };
      const Float3 eye = body == 1 ? place(1, .05f, .02f) : place(.1f, .05f, 0),
                   to = body == 1 ? place(1, 0, 1) : place(0, .3f, -1);
      const Camera cam = camera(size, eye, to, 150);
      count(c, picture(s, cam, o), "from inside", [](std::size_t, float x) { return x == 0; });
    }
  return c;
}

/// From within glass balls, towards the rim so that every bounce is total reflection: nothing gets
/// out.
PictureCounts total_reflection(int size) {
  PictureCounts c;
  for (const double scale : {1., 1e-6, 1e6})
    for (const bool fresnel : {false, true}) {
      Scene s = one_sphere({}, static_cast<float>(scale));
      s.materials[0] = {};
      s.materials[0].transmission = 1;
      s.materials[0].ior = 1.5f;
      s.materials[0].fresnel = fresnel;
      s.background = {};
      s.materials.emplace_back().emission = {1, 1, 1};
      s.geometry.spheres.add({}, static_cast<float>(4 * scale), 1);
      RenderOptions o;
      o.depth = 50;
      // At .9 of the radius, across it within 20 degrees: sines of incidence above .9 cos 20 = .84,
      // of the critical angle .67.
      Camera cam = camera(size,
                          {static_cast<float>(.9 * scale), 0, 0},
                          {static_cast<float>(.9 * scale), 0, static_cast<float>(-scale)},
                          25);
      count(c, picture(s, cam, o), "total reflection", [](std::size_t, float x) { return x == 0; });
    }
  return c;
}

/// A clear body changes no light in a white world: one of index below 1, balls in balls, balls that
/// touch, a ball on a pane. Without Fresnel one ray goes on at each surface, and by the symmetry of
/// a ball what enters it leaves it.
PictureCounts white_furnace(int size) {
  PictureCounts c;
  struct ClearBody {
    const char* name;
    std::function<void(Scene&, float)> add;
    float ior;
  };
  const ClearBody bodies[] = {
      {"glass", [](Scene& s, float k) { s.geometry.spheres.add({}, k, 0); }, 1.5f},
      {"index below 1", [](Scene& s, float k) { s.geometry.spheres.add({}, k, 0); }, .7f},
      {"ball in ball",
       [](Scene& s, float k) {
         s.geometry.spheres.add({}, k, 0), s.geometry.spheres.add({}, k / 2, 0);
       },
       1.4f},
      {"equal balls",
       [](Scene& s, float k) {
         s.geometry.spheres.add({}, k, 0), s.geometry.spheres.add({}, k, 0);
       },
       1.f},
      {"touching balls",
       [](Scene& s, float k) {
         s.geometry.spheres.add({-k, 0, 0}, k, 0), s.geometry.spheres.add({k, 0, 0}, k, 0);
       },
       1.5f},
  };
  for (const ClearBody& body : bodies)
    for (const double scale : {1., 1e-6, 1e6}) {
      Scene s;
      s.materials.resize(1);
      s.materials[0].transmission = 1;
      s.materials[0].ior = body.ior;
      s.background = {1, 1, 1};
      body.add(s, static_cast<float>(scale));
      RenderOptions o;
      o.depth = 50;
      const float k = static_cast<float>(scale);
      count(c,
            picture(s, camera(size, {.3f * k, .5f * k, 4 * k}, {}, 60), o),
            body.name,
            [](std::size_t, float x) { return x == 1; });
    }
  return c;
}

/// Through a glass ball at a world whose right half glows: Snell's law twice in long double, up to
/// rays that graze the ball. What comes down within 1e-3 of the border, or passes within 1e-5 of
/// the rim, is open.
PictureCounts glass_ball(int size) {
  PictureCounts c;
  for (const float ior : {1.5f, 1.05f, .8f}) {
    Scene s;
    s.materials.resize(2);
    s.materials[0].transmission = 1;
    s.materials[0].ior = ior;
    s.materials[1].emission = {1, 1, 1};
    s.geometry.spheres.add({}, 1, 0);
    add_triangle(s, {0, -1000, -3}, {2000, 0, -3}, {0, 1000, -3}, 1);
    Camera cam;
    // the ball fills it
    cam.eye = {0, 0, 3};
    cam.at = {};
    cam.up = {0, 1, 0};
    cam.width = cam.height = size;
    cam.angle_deg = 39;
    const Image image = picture(s, cam, {});
    const Real half = std::tan(Real(39) / 2 * 3.14159265358979323846L / 180);
    count(c, image, "glass ball", [&](std::size_t i, float x) {
      const Real px =
          (2 * (static_cast<Real>(i % static_cast<std::size_t>(size)) + .5L) / size - 1) * half;
      const Real py =
          (1 - 2 * (static_cast<Real>(i / static_cast<std::size_t>(size)) + .5L) / size) * half;
      V org{0, 0, 3}, dir = oracle::unit(V{px, py, -1});
      Real eta = 1 / Real(ior);
      for (int k = 0; k < 2; ++k) {
        const Real foot = -dot(org, dir), miss = length(cross(dir, org));
        if (k == 0 && std::abs(miss - 1) < 1e-5L)
          return true;
        if (miss > 1)
          break;
        const Real chord = std::sqrt((1 - miss) * (1 + miss));
        org = org + (k == 0 ? foot - chord : foot + chord) * dir;
        const V n = k == 0 ? oracle::unit(org) : Real(-1) * oracle::unit(org);
        const Real cosine = -dot(dir, n), inside = 1 - eta * eta * (1 - cosine * cosine);
        if (std::abs(inside) < 1e-4L)
          return true;     // at the critical angle
        if (inside < 0) {  // total reflection, outside the ball: done
          dir = dir + 2 * cosine * n;
          break;
        }
        dir = oracle::unit(eta * dir + (eta * cosine - std::sqrt(inside)) * n);
        eta = Real(ior);
      }
      if (dir.z > -1e-3L)
        return dir.z < 0 || x == 0;
      const Real at = org.x + dir.x * (-3 - org.z) / dir.z, slack = 1e-3L / -dir.z;
      if (std::abs(at) < slack ||
          std::abs(org.y + dir.y * (-3 - org.z) / dir.z) + std::abs(at) / 2 > 900)
        return true;
      return x == (at > 0 ? 1.f : 0.f);
    });
  }
  return c;
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

/// Pixels of two pictures that differ in a bit.
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

RenderOptions samples(int n) {
  RenderOptions o;
  o.sampling.samples = n;
  return o;
}

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
  many.sampling.gloss_rays = 3;
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
  // pixels an eighth of a radian wide are too wide to be watched (docs/numerics.md)
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

/// Samples of pixel and light that keep step would leave a bias where both are soft: a penumbra
/// behind a pixel's edge, against its mean over independent samples. Four standard errors.
PictureCounts correlated(int size) {
  PictureCounts c;
  Scene s = empty_scene();
  s.geometry.planes.add({0, 0, 0}, {0, 0, 1}, 0);
  add_triangle(s, {0, -50, 1}, {0, 50, 1}, {-50, 0, 1});
  s.lights = {{{0, 0, 2}, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}}};
  Camera cam;
  cam.eye = {.2f, -.5f, .5f};
  cam.at = {.2f, 0, 0};
  cam.up = {0, 0, 1};
  cam.width = cam.height = 1;
  cam.angle_deg = 60;
  // One pixel a picture, all of the penumbra in it.
  const auto means = [&](Sampler sampler, int n, int runs, double& spread) {
    double sum = 0, square = 0;
    const World world(s, {});
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
    spread = std::sqrt(std::max(0., square / runs - sum * sum) / (runs - 1));
    return sum;
  };
  double unsure;
  const double truth = means(Sampler::kRandom, 4096, size, unsure);
  for (const Sampler sampler : {Sampler::kSobol, Sampler::kJitter, Sampler::kRandom}) {
    double spread;
    const double mean = means(sampler, 16, 8 * size, spread);
    ++c.pixels;
    if (std::abs(mean - truth) <= 4 * std::hypot(spread, unsure))
      continue;
    if (c.wrong++ > 0)
      continue;
    c.first = "sampler " + std::to_string(static_cast<int>(sampler)) + ": " + std::to_string(mean) +
              " against " + std::to_string(truth);
  }
  return c;
}

/// One picture for threads, packets, instruction sets, densities, mailboxes and rows by pieces.
PictureCounts one_picture(int size) {
  PictureCounts c;
  Scene s = everything();
  Camera cam = camera(size, {.3f, .5f, 3.5f}, {}, 45);
  cam.aperture = .1;
  cam.focus = 3;
  RenderOptions o = samples(4);
  o.depth = 4;
  o.threads = 1;
  o.isa = "scalar";
  o.packet = 1;
  o.mailbox = false;
  const Image wanted = picture(s, cam, o);
  for (const Isa& isa : isas()) {
    if (!isa.runs_here)
      continue;
    for (const int packet : {1, 16, 64, 256})
      for (const int threads : {1, 3}) {
        o.isa = isa.name;
        o.packet = packet;
        o.threads = threads;
        o.mailbox = packet != 16;
        count_same(c, picture(s, cam, o, packet == 64 ? 2.f : 0.f), wanted, "one picture");
      }
  }
  return c;
}

}  // namespace

std::vector<PictureRow> picture_rows() {
  return {
      {"mirror shafts",
       "closed bodies of mirrors from inside, depth 50, sizes 1e-6 to 1e6",
       "no light gets in",
       mirror_shaft},
      {"total reflection",
       "inside glass balls beyond the critical angle, depth 50",
       "no light gets in",
       total_reflection},
      {"clear bodies",
       "nested, equal and touching balls, index below 1, in a white world",
       "white",
       white_furnace},
      {"glass ball",
       "rays up to the rim, index .8, 1.05, 1.5",
       "Snell's law in long double",
       glass_ball},
      {"lenses",
       "aperture 0 to larger than the scene, focus 1e-6 to 1e30; 0, infinite, NaN",
       "the pinhole's bits; white; refused or finite",
       lenses},
      {"light of size 0",
       "edges of 0, 1e-30, 1e-38",
       "the point light's picture",
       light_of_no_size},
      {"roughness 0", "0 and 1e-20", "the mirror's picture", roughness_of_nothing},
      {"discs of a tenth of a pixel",
       "--error, one disc in each sixteenth pixel",
       "each is seen",
       small_discs},
      {"correlated samples",
       "a penumbra across one pixel, 16 samples",
       "the mean over independent samples, 4 standard errors",
       correlated},
      {"one picture",
       "threads, packets, instruction sets, densities, mailboxes",
       "the same bits",
       one_picture},
  };
}

}  // namespace grelha::stability
