// Shading against closed forms in long double: one ray, one pixel, one effect at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernel/world/world_impl.hpp"
#include "tests/kernel/shade/look.hpp"

namespace grelha::test {
namespace {

using oracle::Real;
using oracle::V;

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

/// Vertices 0 to 8 of a square of 2 x 2, row by row, with random colours, tilted and moved.
struct Patch {
  explicit Patch(Random& random) {
    Triangles& t = scene.geometry.triangles;
    scene.materials = {plain({.5f, .75f, 1})};
    scene.materials[0].emission = {.25f, .125f, .5f};
    scene.lights = {{{2, 6, 3}, {.5f, 1, 2}}};
    for (int i = 0; i < 9; ++i) {
      const int x = i % 3 - 1, z = i / 3 - 1;
      t.x.push_back(static_cast<float>(x));
      t.y.push_back(static_cast<float>(.25 * x));
      t.z.push_back(static_cast<float>(z));
      t.red.push_back(static_cast<float>(random.in(0, 1)));
      t.green.push_back(static_cast<float>(random.in(0, 1)));
      t.blue.push_back(static_cast<float>(random.in(0, 1)));
    }
    for (const std::uint32_t i : {0u, 1u, 3u, 4u})
      for (const auto& [b, c] : {std::pair{i + 3, i + 4}, {i + 4, i + 1}}) {
        t.a.push_back(i);
        t.b.push_back(b);
        t.c.push_back(c);
        t.material.push_back(0);
      }
  }
  V vertex(std::size_t i) const {
    const Triangles& t = scene.geometry.triangles;
    return V(Float3{t.x[i], t.y[i], t.z[i]});
  }
  V color(std::size_t i) const {
    const Triangles& t = scene.geometry.triangles;
    return V(Float3{t.red[i], t.green[i], t.blue[i]});
  }
  Scene scene;
};

/// At corners, middles of edges, middles of triangles and between: the vertices' colours, mixed by
/// exact weights, times diffuse and emission. The spot is off by the direction's 12 eps over a
/// distance of 6, where a colour changes by up to 1 on a way of 1.
TEST(Shade, ColorsAreMixedByWeights) {
  int seen = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const Patch patch(random);
    const Triangles& t = patch.scene.geometry.triangles;
    const Real u = random.in(0, .5), v = random.in(0, .5);
    const V mixes[] = {{1, 0, 0}, {0, .5L, .5L}, {.5L, 0, .5L}, {.5L, .5L, 0}, {1 - u - v, u, v}};
    const std::size_t triangle = seed % 8;
    for (const V& mix : mixes) {
      // vertex 4 is in the middle, where a ray that is off still hits
      const std::size_t a = mix.x == 1 ? 4 : t.a[triangle], b = t.b[triangle], c = t.c[triangle];
      const V spot = mix.x * patch.vertex(a) + mix.y * patch.vertex(b) + mix.z * patch.vertex(c);
      const V color = mix.x * patch.color(a) + mix.y * patch.color(b) + mix.z * patch.color(c);
      const Pixel p = look(patch.scene, {.5f, 5, 1}, {float(spot.x), float(spot.y), float(spot.z)});
      if (p.stats.rays.shadow == 0)
        continue;  // past the rim
      ++seen;
      const V normal = oracle::unit({-.25L, 1, 0});
      const Real cosine = dot(oracle::unit(V(patch.scene.lights[0].position) - spot), normal);
      const double bound = 2 * 12 * 6 * 6e-8 + kFew;
      EXPECT_NEAR(p.r, double((.25L * cosine + .25L) * color.x), bound)
          << seed << ' ' << double(mix.x);
      EXPECT_NEAR(p.g, double((.75L * cosine + .125L) * color.y), bound)
          << seed << ' ' << double(mix.x);
      EXPECT_NEAR(p.b, double((2 * cosine + .5L) * color.z), 3 * bound)
          << seed << ' ' << double(mix.x);
    }
  }
  EXPECT_GT(seen, 800);
}

/// Colours are of triangles alone: a ball beside them, with a material of its own, has none.
TEST(Shade, ColorsAreOfTheirTriangles) {
  Random random(1);
  Patch patch(random);
  patch.scene.materials.push_back(plain({1, 1, 1}));
  patch.scene.geometry.spheres.add({0, 2, 0}, 1, 1);
  patch.scene.lights = {{{0, 9, 0}, {1, 1, 1}}};
  const Pixel p = look(patch.scene, {0, 5, 0}, {0, 3, 0});
  EXPECT_NEAR(p.r, 1, kFew);
  EXPECT_NEAR(p.b, 1, kFew);
}

TEST(Shade, BlinnHighlight) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Material m;
    m.specular = {.5f, 1, .25f};
    m.shine = static_cast<float>(random.log_in(1, 200));
    Scene s = floor_scene(m);
    const Float3 eye{static_cast<float>(random.in(-2, 2)), 3, static_cast<float>(random.in(-2, 2))};
    const Float3 light{
        static_cast<float>(random.in(-3, 3)), 4, static_cast<float>(random.in(-3, 3))};
    s.lights = {{light, {1, 1, 1}}};
    const Pixel p = look(s, eye, {0, 0, 0});
    const Real nh = oracle::unit(oracle::unit(V(light)) + oracle::unit(V(eye))).y;
    const Real wanted = std::pow(nh, Real(m.shine));
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

/// Something that is hit head on: the normal faces the eye, where the light hangs as well.
struct HeadOn {
  const char* what;
  void (*add)(Geometry&);
  Float3 eye, at;
};

void add_sphere(Geometry& g) {
  g.spheres.add({1, 2, 3}, 1, 0);
}
void add_sphere_around(Geometry& g) {
  g.spheres.add({1, 2, 3}, 4, 0);
}
void add_cylinder(Geometry& g) {
  g.cones.add({0, 0, 0}, 1, {0, 4, 0}, 1, 0);
}
void add_cone(Geometry& g) {
  g.cones.add({0, 0, 0}, 2, {0, 2, 0}, 0, 0);
}
void add_plane(Geometry& g) {
  g.planes.add({0, 1, 0}, {3, 3, 0}, 0);
}
void add_facet(Geometry& g) {
  const Scene one = one_triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  g.triangles = one.geometry.triangles;
}

constexpr HeadOn kHeadOn[] = {
    {"sphere", add_sphere, {1, 2, 9}, {1, 2, 3}},
    {"sphere from within", add_sphere_around, {1, 2, 4}, {1, 2, 9}},
    {"cylinder", add_cylinder, {5, 2, 0}, {0, 2, 0}},
    {"cone", add_cone, {3, 3, 0}, {1, 1, 0}},
    {"plane", add_plane, {4, 5, 0}, {0, 1, 0}},
    {"triangle", add_facet, {0, 0, -4}, {0, 0, 0}},
};

TEST(Shade, EveryKindHasItsNormal) {
  for (const HeadOn& kind : kHeadOn) {
    Scene s;
    s.materials = {plain({1, 1, 1})};
    kind.add(s.geometry);
    s.lights = {{kind.eye, {1, 1, 1}}};
    EXPECT_NEAR(look(s, kind.eye, kind.at).r, 1, kFew) << kind.what;  // the cosine
  }
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
    return std::vector<bool>{v.reflects, v.refracts, v.fresnel, v.emits, v.highlights, v.glossy};
  };
  s.geometry.spheres.add({0, 0, 0}, 1, 0);
  EXPECT_EQ(selected(), std::vector<bool>(6, false));
  using Add = void (*)(Geometry&);
  const Add add[] = {[](Geometry& g) {
                       g.spheres.add({3, 0, 0}, 1, 1);
                     },
                     [](Geometry& g) {
                       g.planes.add({0, -3, 0}, {0, 1, 0}, 1);
                     },
                     [](Geometry& g) {
                       g.cones.add({0, 3, 0}, 1, {0, 4, 0}, 0, 1);
                     }};
  for (const Add& a : add) {
    const Scene before = s;
    a(s.geometry);
    EXPECT_EQ(selected(), std::vector<bool>(6, true));
    s = before;
  }
}

}  // namespace
}  // namespace grelha::test
