// Tests bodies of mirrors and of glass: rays into and out of the bodies.
#include <cmath>
#include <functional>

#include "tests/stability/picture_checks.hpp"
#include "tests/stability/picture_kinds.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {

using namespace test;

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
         s.geometry.spheres.add({}, k, 0);
         s.geometry.spheres.add({}, k / 2, 0);
       },
       1.4f},
      {"equal balls",
       [](Scene& s, float k) {
         s.geometry.spheres.add({}, k, 0);
         s.geometry.spheres.add({}, k, 0);
       },
       1.f},
      {"touching balls",
       [](Scene& s, float k) {
         s.geometry.spheres.add({-k, 0, 0}, k, 0);
         s.geometry.spheres.add({k, 0, 0}, k, 0);
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

namespace {

using oracle::Real;
using oracle::V;

/// The result of a refraction at a face of the ball: undecided, the ray leaves the ball, or it goes
/// on to the other face.
enum class Next { kOpen, kOutside, kInside };

struct Path {
  V org, dir;
};

/// One face of the unit ball, by Snell's law.
Next refract(Path& path, Real& eta, Real ior, bool entering) {
  const Real foot = -dot(path.org, path.dir), miss = length(cross(path.dir, path.org));
  if (entering && std::abs(miss - 1) < 1e-5L)
    return Next::kOpen;
  if (miss > 1)
    return Next::kOutside;
  const Real chord = std::sqrt((1 - miss) * (1 + miss));
  path.org = path.org + (entering ? foot - chord : foot + chord) * path.dir;
  const V n = entering ? oracle::unit(path.org) : Real(-1) * oracle::unit(path.org);
  const Real cosine = -dot(path.dir, n), inside = 1 - eta * eta * (1 - cosine * cosine);
  if (std::abs(inside) < 1e-4L)
    return Next::kOpen;  // at the critical angle
  if (inside < 0) {      // total reflection, outside the ball: done
    path.dir = path.dir + 2 * cosine * n;
    return Next::kOutside;
  }
  path.dir = oracle::unit(eta * path.dir + (eta * cosine - std::sqrt(inside)) * n);
  eta = ior;
  return Next::kInside;
}

/// Whether x may be what is seen along a ray that comes to the ball.
bool right_behind_glass(Path path, Real ior, float x) {
  Real eta = 1 / ior;
  for (const bool entering : {true, false}) {
    const Next next = refract(path, eta, ior, entering);
    if (next == Next::kOpen)
      return true;
    if (next == Next::kOutside)
      break;
  }
  const auto& [org, dir] = path;
  if (dir.z > -1e-3L)
    return dir.z < 0 || x == 0;
  const Real at = org.x + dir.x * (-3 - org.z) / dir.z, slack = 1e-3L / -dir.z;
  if (std::abs(at) < slack ||
      std::abs(org.y + dir.y * (-3 - org.z) / dir.z) + std::abs(at) / 2 > 900)
    return true;
  return x == (at > 0 ? 1.f : 0.f);
}

Scene ball_before_a_half(float ior) {
  Scene s;
  s.materials.resize(2);
  s.materials[0].transmission = 1;
  s.materials[0].ior = ior;
  s.materials[1].emission = {1, 1, 1};
  s.geometry.spheres.add({}, 1, 0);
  add_triangle(s, {0, -1000, -3}, {2000, 0, -3}, {0, 1000, -3}, 1);
  return s;
}

}  // namespace

/// A view through a glass ball at a world whose right half glows: Snell's law twice in long double,
/// up to rays that graze the ball. Rays that arrive within 1e-3 of the border, or pass within 1e-5
/// of the rim, are undecided.
PictureCounts glass_ball(int size) {
  Camera cam;
  // the ball fills it
  cam.eye = {0, 0, 3};
  cam.at = {};
  cam.up = {0, 1, 0};
  cam.width = cam.height = size;
  cam.angle_deg = 39;
  const Real half = std::tan(Real(39) / 2 * 3.14159265358979323846L / 180);
  const auto width = static_cast<std::size_t>(size);
  PictureCounts c;
  for (const float ior : {1.5f, 1.05f, .8f}) {
    const Image image = picture(ball_before_a_half(ior), cam, {});
    count(c, image, "glass ball", [&](std::size_t i, float x) {
      const Real px = (2 * (static_cast<Real>(i % width) + .5L) / size - 1) * half;
      const Real py = (1 - 2 * (static_cast<Real>(i / width) + .5L) / size) * half;
      return right_behind_glass({V{0, 0, 3}, oracle::unit(V{px, py, -1})}, Real(ior), x);
    });
  }
  return c;
}

}  // namespace grelha::stability
