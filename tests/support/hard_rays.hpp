#pragma once
// Rays at vertices and edges, along axes and sides of triangles, from any distance on either side,
// and intervals of every kind.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "grelha/rays.hpp"
#include "tests/support/hard_meshes.hpp"

namespace grelha::test {

/// Rays at one mesh whose answers are hard to tell.
class HardRays {
 public:
  HardRays(const Scene& scene, std::uint64_t seed) : scene_(scene), random_(seed) {
    const Triangles& t = scene.geometry.triangles;
    Float3 lo{kInf, kInf, kInf};
    Float3 hi{-kInf, -kInf, -kInf};
    for (std::size_t i = 0; i < t.x.size(); ++i) {
      lo = {std::min(lo.x, t.x[i]), std::min(lo.y, t.y[i]), std::min(lo.z, t.z[i])};
      hi = {std::max(hi.x, t.x[i]), std::max(hi.y, t.y[i]), std::max(hi.z, t.z[i])};
    }
    const Float3 d = minus(hi, lo);
    diagonal_ = std::sqrt(double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z);
  }

  Ray next() {
    if (random_.chance(.1))
      return from_beside_zeros();
    constexpr double kAway[] = {0, .3, .8, 3, 4.2, 20, 1e4, 1e8, 1e13};
    const Float3 target = point_on_mesh();
    const double away = diagonal_ * kAway[random_.below(std::size(kAway))];
    Ray ray;
    if (random_.chance(.4)) {
      const Float3 axis = axis_or_diagonal();
      ray = {at(target, -away, axis), axis};
    } else if (random_.chance(.3)) {
      const Float3 along = grazing();
      ray = {at(target, -away, along), along};
    } else {
      ray.org = at(target, away, random_.direction());
      ray.dir = away > 0 ? minus(target, ray.org) : random_.direction();
    }
    if (random_.chance(.3))  // the mesh lies behind
      ray.dir = minus({0, 0, 0}, ray.dir);
    set_length(ray);
    set_ends(ray, target);
    return ray;
  }

 private:
  Float3 point_on_mesh() {
    const Triangles& t = scene_.geometry.triangles;
    const std::uint32_t k = random_.below(static_cast<std::uint32_t>(t.a.size()));
    triangle_ = k;
    const Float3 a = vertex(scene_, t.a[k]);
    const Float3 on_edge = at(a, random_.unit(), minus(vertex(scene_, t.b[k]), a));
    switch (random_.below(4)) {
      case 0:
        return a;
      case 1:
        return at(a, .5, minus(vertex(scene_, t.b[k]), a));
      case 2:
        return on_edge;
      default:
        return at(on_edge, .5 * random_.unit(), minus(vertex(scene_, t.c[k]), on_edge));
    }
  }
  /// Along a side of the triangle that was chosen last, and out of its plane a little.
  Float3 grazing() {
    const Triangles& t = scene_.geometry.triangles;
    const Float3 a = vertex(scene_, t.a[triangle_]);
    const Float3 side = at(minus(vertex(scene_, t.b[triangle_]), a),
                           random_.unit(),
                           minus(vertex(scene_, t.c[triangle_]), a));
    const Float3 d =
        at(side, std::ldexp(1., -4 - static_cast<int>(random_.below(18))), random_.direction());
    return d.x == 0 && d.y == 0 && d.z == 0 ? axis_or_diagonal() : d;
  }
  Float3 axis_or_diagonal() {
    for (;;) {
      const auto part = [&] { return static_cast<float>(random_.below(3)) - 1; };
      const Float3 d{part(), part(), part()};
      if (d.x != 0 || d.y != 0 || d.z != 0)
        return d;
    }
  }

  /// From a point on the mesh whose zeros are moved by less than normal floats hold. So t is no
  /// normal float.
  Ray from_beside_zeros() {
    const Float3 target = point_on_mesh();
    Ray ray;
    ray.org = target;
    for (float* x : {&ray.org.x, &ray.org.y, &ray.org.z})
      if (*x == 0)
        *x = denormal();
    ray.dir = random_.chance(.5) ? axis_or_diagonal() : random_.direction();
    if (random_.chance(.5))
      ray.dir = at({0, 0, 0}, 200, ray.dir);
    else
      set_length(ray);
    if (random_.chance(.3))
      set_ends(ray, target);
    return ray;
  }
  float denormal() {
    const auto steps = static_cast<float>(1 + random_.below(1u << random_.below(6)));
    return random_.sign() < 0 ? -steps * 0x1p-149f : steps * 0x1p-149f;
  }

  void set_length(Ray& ray) {
    constexpr float kLengths[] = {1, 1, 1, .125f, 0x1p-20f, 1024, 0x1p20f, .37f};
    const float by = kLengths[random_.below(std::size(kLengths))];
    const Float3 d{by * ray.dir.x, by * ray.dir.y, by * ray.dir.z};
    const double length = std::hypot(double{d.x}, double{d.y}, double{d.z});
    if (length > 1e-18 && length < 1e18)
      ray.dir = d;
  }

  /// Ends before, at, next to and behind the target, which is where the ray is at t.
  void set_ends(Ray& ray, const Float3& target) {
    const Float3 way = minus(target, ray.org);
    const double dd = double{ray.dir.x} * ray.dir.x + double{ray.dir.y} * ray.dir.y +
                      double{ray.dir.z} * ray.dir.z;
    const auto t = static_cast<float>(
        (double{way.x} * ray.dir.x + double{way.y} * ray.dir.y + double{way.z} * ray.dir.z) / dd);
    const auto end = [&]() -> float {
      switch (random_.below(10)) {
        case 9:
          return denormal();
        case 0:
          return t;
        case 1:
          return std::nextafter(t, -kInf);
        case 2:
          return std::nextafter(t, kInf);
        case 3:
          return std::nextafter(0.f, -1.f);
        case 4:
          return -2 * std::fabs(t);
        case 5:
          return 2 * std::fabs(t);
        case 6:
          return 0;
        default:
          return kInf;
      }
    };
    if (random_.chance(.5)) {
      ray.t_min = end();
      if (ray.t_min == kInf)
        ray.t_min = -kInf;
    }
    if (random_.chance(.5))
      ray.t_max = end();
    if (random_.chance(.05))
      ray.t_max = std::nextafter(ray.t_min, kInf);
  }

  const Scene& scene_;
  Random random_;
  double diagonal_ = 1;
  std::uint32_t triangle_ = 0;
};

}  // namespace grelha::test
