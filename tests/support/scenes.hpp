#pragma once
// Small scenes built in memory.

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "grelha/camera.hpp"
#include "grelha/geometry.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {

inline void add_triangle(
    Scene& s, const Float3& a, const Float3& b, const Float3& c, std::uint32_t material = 0) {
  Triangles& t = s.geometry.triangles;
  for (const Float3& p : {a, b, c}) {
    t.x.push_back(p.x);
    t.y.push_back(p.y);
    t.z.push_back(p.z);
    if (!t.nx.empty()) {
      t.nx.push_back(0);
      t.ny.push_back(0);
      t.nz.push_back(0);
    }
  }
  const auto n = static_cast<std::uint32_t>(t.x.size());
  t.a.push_back(n - 3);
  t.b.push_back(n - 2);
  t.c.push_back(n - 1);
  t.material.push_back(material);
}

inline Scene empty_scene() {
  Scene s;
  s.materials.emplace_back().diffuse = {1, 1, 1};
  return s;
}

inline Scene one_sphere(const Float3& center, float radius) {
  Scene s = empty_scene();
  s.geometry.spheres.add(center, radius, 0);
  return s;
}
inline Scene one_plane(const Float3& point, const Float3& normal) {
  Scene s = empty_scene();
  s.geometry.planes.add(point, normal, 0);
  return s;
}
inline Scene one_cone(const Float3& base, float r0, const Float3& apex, float r1) {
  Scene s = empty_scene();
  s.geometry.cones.add(base, r0, apex, r1, 0);
  return s;
}
inline Scene one_triangle(const Float3& a, const Float3& b, const Float3& c) {
  Scene s = empty_scene();
  add_triangle(s, a, b, c);
  return s;
}

// ---- clusters ----

inline void add_spheres(Scene& s, Random& random, int n, double half, double least, double most) {
  for (int i = 0; i < n; ++i) {
    const float r = static_cast<float>(random.log_in(least, most) * (random.chance(.1) ? -1 : 1));
    s.geometry.spheres.add(random.point(half), r, 0);
  }
}
inline void add_triangles(Scene& s, Random& random, int n, double half, double least, double most) {
  for (int i = 0; i < n; ++i) {
    const double size = random.log_in(least, most);
    const Float3 a = random.point(half);
    add_triangle(s, a, at(a, size, random.direction()), at(a, size, random.direction()));
  }
}
inline void add_cones(Scene& s, Random& random, int n, double half, double least, double most) {
  for (int i = 0; i < n; ++i) {
    const double size = random.log_in(least, most), sign = random.chance(.1) ? -1 : 1;
    const Float3 base = random.point(half);
    const double r0 = size * random.unit(), r1 = random.chance(.3) ? r0 : size * random.unit();
    s.geometry.cones.add(base,
                         static_cast<float>(sign * r0),
                         at(base, size, random.direction()),
                         static_cast<float>(sign * r1),
                         0);
  }
}

inline Scene random_spheres(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  add_spheres(s, random, n, 1, .01, .2);
  return s;
}
inline Scene random_triangles(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  add_triangles(s, random, n, 1, .01, .4);
  return s;
}
/// Small triangles about the corners of a cube, with much room between: rays leap it.
inline Scene triangles_at_corners(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    const Float3 corner{i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f};
    const Float3 a = at(corner, .3 * random.unit(), random.direction());
    add_triangle(s, a, at(a, .05, random.direction()), at(a, .05, random.direction()));
  }
  return s;
}
/// Spheres and triangles of many sizes, which other tracers know as we do (cones have caps in
/// Embree, planes end).
inline Scene balls_and_triangles(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  add_spheres(s, random, n / 2, 1, .01, .2);
  for (float& r : s.geometry.spheres.radius)
    r = std::abs(r);
  add_triangles(s, random, n / 2, 1, .01, .4);
  return s;
}
inline Scene random_cones(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  add_cones(s, random, n, 1, .02, .4);
  return s;
}
/// Every kind, and planes through the cluster.
inline Scene random_mixture(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  add_spheres(s, random, n / 3, 1, .01, .2);
  add_triangles(s, random, n / 3, 1, .01, .4);
  add_cones(s, random, n / 3, 1, .02, .3);
  s.geometry.planes.add({0, -1.1f, 0}, {0, 1, 0}, 0);
  s.geometry.planes.add({.1f, 0, .8f}, random.direction(), 0);
  return s;
}
/// Small pieces over one plane: no extent at all along y.
inline Scene flat_sheet(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    Float3 a = random.point(1), b = at(a, random.log_in(.02, .3), random.direction()),
           c = at(a, .1, random.direction());
    a.y = b.y = c.y = .25f;
    add_triangle(s, a, b, c);
  }
  return s;
}
/// Squares of a unit cube, one above the other.
inline Scene stacked_sheets(int n) {
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    const float z = static_cast<float>(i) / static_cast<float>(n);
    add_triangle(s, {0, 0, z}, {1, 0, z}, {1, 1, z});
    add_triangle(s, {0, 0, z}, {1, 1, z}, {0, 1, z});
  }
  return s;
}
/// A square patch of triangles along the axes, corners on whole numbers: rays hit edges and
/// vertices exactly.
inline Scene lattice_patch(int n) {
  Scene s = empty_scene();
  for (int z = 0; z < n; ++z)
    for (int x = 0; x < n; ++x) {
      const float a = static_cast<float>(x), b = static_cast<float>(z),
                  y = static_cast<float>((x * 7 + z * 5) % 3);
      add_triangle(s, {a, y, b}, {a + 1, y, b}, {a + 1, y, b + 1});
      add_triangle(s, {a, y, b}, {a + 1, y, b + 1}, {a, y, b + 1});
    }
  return s;
}
/// Everything at the same place: no cell tells one from another.
inline Scene heap(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    s.geometry.spheres.add({.5f, .25f, -.125f}, .3f, 0);
    add_triangle(s, {-1, 0, 0}, {1, .1f, 0}, {.2f, 1, .3f});
    s.geometry.cones.add({0, -.5f, 0}, .2f, {0, .7f, .1f}, .1f, 0);
  }
  return s;
}
/// Long thin triangles and cylinders that cross most cells of the grid each.
inline Scene needles(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  for (int i = 0; i < n; ++i) {
    const Float3 a = random.point(1), b = random.point(1);
    if (i % 3 == 0) {
      s.geometry.cones.add(a, .004f, b, .004f, 0);
    } else {
      add_triangle(s, a, b, at(b, .01, random.direction()));
    }
  }
  return s;
}
/// A fine teapot-like cluster in the middle of a ground and walls a thousand times larger.
/// A cluster on two triangles, `half` from their middle to their sides.
inline Scene crowd_on_a_plain(std::uint64_t seed, int n, float half) {
  Random random(seed);
  Scene s = empty_scene();
  add_triangles(s, random, n, 1, .02, .1);
  add_spheres(s, random, n / 8, 1, .02, .1);
  add_triangle(s, {-half, -1.05f, -half}, {half, -1.05f, -half}, {half, -1.05f, half});
  add_triangle(s, {-half, -1.05f, -half}, {half, -1.05f, half}, {-half, -1.05f, half});
  return s;
}

/// So wide that the cluster has a grid for rays that start near and one for those that start far
/// away.
inline Scene crowd_on_a_wide_plain(std::uint64_t seed, int n) {
  return crowd_on_a_plain(seed, n, 1e6f);
}

/// Two towns, and a hamlet in one town, in a desert of few spheres: one level of cells does not
/// suit this scene.
inline Scene towns_in_a_desert(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  const auto spread = [&](int count, const Float3& middle, float size) {
    for (int i = 0; i < count; ++i)
      s.geometry.spheres.add(
          at(middle, size * random.in(0, 1), random.direction()), .02f * size, 0);
  };
  spread(n / 10, {0, 0, 0}, 1000);
  spread(n, {200, 0, 0}, 3);
  spread(n, {-300, 100, 50}, 2);
  spread(2 * n, {-300, 101, 50}, .01f);
  return s;
}

inline Scene stadium(std::uint64_t seed, int n) {
  Random random(seed + 1);
  Scene s = crowd_on_a_plain(seed, n, 1000);
  for (int i = 0; i < 60; ++i) {  // stands: more than are kept outside of grids
    const double w = i * std::numbers::pi / 30;
    const Float3 foot{
        static_cast<float>(900 * std::cos(w)), -1, static_cast<float>(900 * std::sin(w))};
    add_triangle(s, foot, at(foot, 300, {0, 1, 0}), at(foot, 250, random.direction()));
  }
  return s;
}

/// The same scene, each coordinate times `scale` plus `offset`.
inline Scene placed(Scene s, double scale, const Float3& offset) {
  const auto move = [&](std::vector<float>& v, float by) {
    for (float& x : v)
      x = static_cast<float>(x * scale + by);
  };
  const auto size = [&](std::vector<float>& v) {
    for (float& x : v)
      x = static_cast<float>(x * scale);
  };
  Geometry& g = s.geometry;
  for (auto* v : {&g.spheres.x, &g.cones.base_x, &g.cones.apex_x, &g.planes.x, &g.triangles.x})
    move(*v, offset.x);
  for (auto* v : {&g.spheres.y, &g.cones.base_y, &g.cones.apex_y, &g.planes.y, &g.triangles.y})
    move(*v, offset.y);
  for (auto* v : {&g.spheres.z, &g.cones.base_z, &g.cones.apex_z, &g.planes.z, &g.triangles.z})
    move(*v, offset.z);
  for (auto* v : {&g.spheres.radius, &g.cones.base_radius, &g.cones.apex_radius})
    size(*v);
  return s;
}

/// The mixture with everything to sample but a lens: rough mirrors, glass, area lights among point
/// lights.
inline Scene everything() {
  Scene s = random_mixture(5, 120);
  s.materials.resize(3);
  s.materials[1].mirror = {.7f, .8f, .9f};
  s.materials[1].roughness = .15f;
  s.materials[1].specular = {.4f, .4f, .4f};
  s.materials[1].shine = 20;
  s.materials[2].transmission = .8f;
  s.materials[2].ior = 1.4f;
  s.materials[2].mirror = {.1f, .1f, .1f};
  Random random(4);
  for (auto* m :
       {&s.geometry.spheres.material, &s.geometry.triangles.material, &s.geometry.cones.material})
    for (std::uint32_t& i : *m)
      i = random.below(3);
  s.lights = {{{3, 4, 5}, {.7f, .7f, .6f}, {1, 0, 0}, {0, 1, 0}},
              {{-4, 2, 3}, {.3f, .3f, .4f}},
              {{0, 5, 1}, {.2f, .2f, .2f}, {0, 0, 1}, {1, 0, 0}}};
  s.background = {.1f, .2f, .3f};
  return s;
}

/// Looks along -z at the plane z = 0 from 1 above it; the picture is 2 tan(angle/2) high there.
inline Camera straight_down(int width, int height, double across) {
  Camera c;
  c.eye = {0, 0, 1};
  c.at = {0, 0, 0};
  c.up = {0, 1, 0};
  c.width = width;
  c.height = height;
  c.angle_deg = 360 / std::numbers::pi * std::atan(across / 2);
  return c;
}

// ---- closed meshes ----

/// A mesh round in u and, unless it is closed by poles, in v; point(u, v) for u, v in [0, 1].
inline Scene closed_mesh(int nu,
                         int nv,
                         bool poles,
                         const std::function<Float3(double, double)>& point) {
  Scene s = empty_scene();
  Triangles& t = s.geometry.triangles;
  const auto put = [&](const Float3& p) {
    t.x.push_back(p.x);
    t.y.push_back(p.y);
    t.z.push_back(p.z);
  };
  const auto tri = [&](int a, int b, int c) {
    t.a.push_back(static_cast<std::uint32_t>(a));
    t.b.push_back(static_cast<std::uint32_t>(b));
    t.c.push_back(static_cast<std::uint32_t>(c));
    t.material.push_back(0);
  };
  const int rings = poles ? nv - 1 : nv;
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < nu; ++i)
      put(point(double(i) / nu, double(poles ? j + 1 : j) / nv));
  for (int j = 0; j + (poles ? 1 : 0) < rings; ++j)
    for (int i = 0; i < nu; ++i) {
      const int a = j * nu + i, b = j * nu + (i + 1) % nu, c = (j + 1) % rings * nu + i,
                d = (j + 1) % rings * nu + (i + 1) % nu;
      tri(a, b, d);
      tri(a, d, c);
    }
  if (poles) {
    put(point(0, 0));
    put(point(0, 1));
    const int south = rings * nu, north = south + 1;
    for (int i = 0; i < nu; ++i) {
      tri(south, (i + 1) % nu, i);
      tri(north, (rings - 1) * nu + i, (rings - 1) * nu + (i + 1) % nu);
    }
  }
  return s;
}

/// A ball of radius about 1; `bumps` moves vertices in and out, to each its own amount (pbrt-v4's
/// test mesh).
inline Scene ball_mesh(int nu, int nv, double bumps = 0, std::uint64_t seed = 1) {
  Random random(seed);
  return closed_mesh(nu, nv, true, [&](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = std::numbers::pi * v,
                 r = 1 + bumps * random.in(-1, 1);
    return Float3{static_cast<float>(r * std::cos(a) * std::sin(b)),
                  static_cast<float>(r * std::cos(b)),
                  static_cast<float>(r * std::sin(a) * std::sin(b))};
  });
}

inline Scene torus_mesh(int nu, int nv, double tube) {
  return closed_mesh(nu, nv, false, [&](double u, double v) {
    const double a = 2 * std::numbers::pi * u, b = 2 * std::numbers::pi * v,
                 r = 1 + tube * std::cos(b);
    return Float3{static_cast<float>(r * std::cos(a)),
                  static_cast<float>(tube * std::sin(b)),
                  static_cast<float>(r * std::sin(a))};
  });
}
inline Float3 vertex(const Scene& s, std::uint32_t i) {
  const Triangles& t = s.geometry.triangles;
  return {t.x[i], t.y[i], t.z[i]};
}

/// The triangles of a mesh, as an object of its own.
inline void add_object(Scene& s, const Scene& mesh) {
  const Triangles& from = mesh.geometry.triangles;
  const auto first = static_cast<std::uint32_t>(s.geometry.triangles.size());
  for (std::size_t t = 0; t < from.size(); ++t)
    add_triangle(s, vertex(mesh, from.a[t]), vertex(mesh, from.b[t]), vertex(mesh, from.c[t]));
  s.geometry.objects.push_back({first, static_cast<std::uint32_t>(from.size())});
}

/// A mesh on so wide a floor that the cells of a grid for rays from all over would hold much of it.
inline Scene in_a_vast_scene(const Scene& mesh) {
  Scene s = empty_scene();
  add_object(s, mesh);
  const float half = 1e6;
  add_triangle(s, {-half, -1.3f, -half}, {half, -1.3f, -half}, {half, -1.3f, half});
  add_triangle(s, {-half, -1.3f, -half}, {half, -1.3f, half}, {-half, -1.3f, half});
  return s;
}
inline Scene mesh_in_a_vast_scene() {
  return in_a_vast_scene(ball_mesh(24, 12, .2));
}

}  // namespace grelha::test
