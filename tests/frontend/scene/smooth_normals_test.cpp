// Tests smooth normals and points drawn as balls: what else meshes become on request.
#include <cmath>
#include <numbers>

#include "frontend/input/read_scene.hpp"
#include "frontend/ply/ply_faces.hpp"
#include "frontend/scene/mesh.hpp"
#include "grelha/query.hpp"
#include "tests/support/random.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

void add(Triangles& t, const std::vector<Float3>& points) {
  for (const Float3& p : points) {
    t.x.push_back(p.x);
    t.y.push_back(p.y);
    t.z.push_back(p.z);
  }
}
void add(Triangles& t, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  t.a.push_back(a);
  t.b.push_back(b);
  t.c.push_back(c);
}
Float3 normal(const Triangles& t, std::uint32_t v) {
  return {t.nx[v], t.ny[v], t.nz[v]};
}
Float3 point(const Triangles& t, std::uint32_t v) {
  return {t.x[v], t.y[v], t.z[v]};
}
double distance(const Float3& a, const Float3& b) {
  return std::hypot(double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z);
}

/// Where all corners lie on a sphere the weights are exact (Max 1999), however long the sides are.
TEST(SmoothNormals, OfACornerOnASphereAreItsOwn) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Triangles t;
    add(t, {{0, 0, 1}});
    const int sides = 3 + int(random.below(8));
    double angle = random.in(0, 1);
    std::vector<double> angles;
    for (int i = 0; i < sides; ++i)
      angles.push_back(angle += random.in(.6, 1));
    const double whole = angle - angles[0] + .8;
    for (double& a : angles)
      a *= 2 * std::numbers::pi / whole;
    for (const double a : angles) {
      const double down = random.in(.1, 1.2);
      add(t,
          {{float(std::sin(down) * std::cos(a)),
            float(std::sin(down) * std::sin(a)),
            float(std::cos(down))}});
    }
    for (int i = 0; i < sides; ++i)
      add(t, 0, std::uint32_t(1 + i), std::uint32_t(1 + (i + 1) % sides));
    smooth_normals(t, 0, 180);
    EXPECT_LT(distance(normal(t, 0), {0, 0, 1}), 1e-5) << "seed " << seed;
    EXPECT_EQ(t.vertex_count(), std::size_t(sides) + 1) << "none is doubled";
  }
}

Triangles cube() {
  Triangles t;
  for (int i = 0; i < 8; ++i)
    add(t, {{float(i & 1), float(i >> 1 & 1), float(i >> 2)}});
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    add(t, a, b, c);
    add(t, a, c, d);
  }
  return t;
}

/// A square's corner weighs as much cut in two, so those of a cube are its diagonals.
TEST(SmoothNormals, OfACubeAreItsFacesOrItsDiagonals) {
  Triangles sharp = cube(), round = cube();
  smooth_normals(sharp, 0, 89);
  smooth_normals(round, 0, 91);
  EXPECT_EQ(sharp.vertex_count(), 24u);
  EXPECT_EQ(round.vertex_count(), 8u);
  for (std::size_t i = 0; i < 12; ++i)
    for (const auto* of : {&sharp.a, &sharp.b, &sharp.c}) {
      const auto a = point(sharp, sharp.a[i]), b = point(sharp, sharp.b[i]),
                 c = point(sharp, sharp.c[i]);
      EXPECT_EQ(normal(sharp, (*of)[i]), normalized(cross(b - a, c - a)));
    }
  const float third = float(1 / std::sqrt(3.));
  for (std::uint32_t v = 0; v < 8; ++v) {
    const Float3 p = point(round, v);
    const Float3 outward{
        p.x > 0 ? third : -third, p.y > 0 ? third : -third, p.z > 0 ? third : -third};
    EXPECT_LT(distance(normal(round, v), outward), 1e-6) << v;
  }
}

/// Two walls that turn by some degrees: below, the edge stays; above, it is round.
TEST(SmoothNormals, KeepSharperEdges) {
  for (const double turn : {5., 40., 90., 130., 175.}) {
    const double radian = turn * std::numbers::pi / 180;
    for (const double by : {-.01, .01}) {
      Triangles t;
      add(t,
          {{0, 0, 0},
           {0, 1, 0},
           {-1, 0, 0},
           {float(std::cos(radian)), 0, float(-std::sin(radian))}});
      add(t, 0, 1, 2);
      add(t, 0, 3, 1);
      t.red = t.green = t.blue = {.1f, .2f, .3f, .4f};
      smooth_normals(t, 0, turn + by);
      EXPECT_EQ(t.vertex_count(), by < 0 ? 6u : 4u) << turn;
      EXPECT_EQ(t.red.size(), t.vertex_count());
      EXPECT_EQ(t.red[t.b[0]], .2f) << "a doubled vertex keeps its colour";
      EXPECT_EQ(t.red[t.c[1]], .2f);
    }
  }
}

/// A vertex of all triangles must not cost their square.
TEST(SmoothNormals, OfAFan) {
  Triangles t;
  constexpr std::uint32_t kSides = 200'000;
  add(t, {{0, 0, 1}});
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double a = 2 * std::numbers::pi * i / kSides;
    add(t, {{float(std::cos(a)), float(std::sin(a)), 0}});
    add(t, 0, 1 + i, 1 + (i + 1) % kSides);
  }
  smooth_normals(t, 0, 10);
  EXPECT_LT(distance(normal(t, 0), {0, 0, 1}), 1e-3);
}

const std::string kHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n";

TEST(SmoothNormals, AreForMeshesWithoutAny) {
  const TemporaryFolder folder;
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string rows = "3 0 1 2\n3 0 2 3\n";
  const std::string bare =
      folder.add("bare.ply", kHead + faces + "0 0 0\n1 0 0\n1 1 .5\n0 1 0\n" + rows);
  const std::string own =
      folder.add("own.ply",
                 kHead + "property float nx\nproperty float ny\nproperty float nz\n" + faces +
                     "0 0 0 0 1 0\n1 0 0 0 1 0\n1 1 .5 0 1 0\n0 1 0 0 1 0\n" + rows);
  const ReadOptions smooth{.meshes = {.smooth_deg = 60}};
  EXPECT_TRUE(read_scene(bare, nullptr).scene.geometry.triangles.nx.empty());
  EXPECT_EQ(read_scene(bare, nullptr, smooth).scene.geometry.triangles.nx.size(), 4u);
  EXPECT_EQ(read_scene(own, nullptr, smooth).scene.geometry.triangles.ny, std::vector<float>(4, 1));
  const std::string both =
      folder.add("s.nff", kView + kFill + "ply own.ply\nply bare.ply\nply own.ply\n");
  const Triangles t = read_scene(both, nullptr, smooth).scene.geometry.triangles;
  EXPECT_EQ(t.nx.size(), t.vertex_count());
  EXPECT_EQ(normal(t, 0), (Float3{0, 1, 0}));
  EXPECT_GT(t.nz[4], .8f);
}

/// Vertices at one place are one, whatever their numbers; each keeps its colour.
TEST(SmoothNormals, OfVerticesWrittenForEachFace) {
  const TemporaryFolder folder;
  const std::string bend = "0 0 0\n1 0 0\n1 1 .5\n0 1 0\n", faces = "3 0 1 2\n3 0 2 3\n";
  const std::string list = "\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string shared = folder.add("a.ply", kHead + "element face 2" + list + bend + faces);
  const std::string soup = folder.add(
      "b.ply",
      "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 3" +
          list +
          "0 0 0 1 1 1\n1 0 0 2 2 2\n1 1 .5 3 3 3\n-0 0 0 4 4 4\n1 1 .5 5 5 5\n0 1 0 6 6 6\n"
          "0 0 0 7 7 7\n.5 .5 .25 7 7 7\n1 1 .5 7 7 7\n3 0 1 2\n3 3 4 5\n3 6 7 8\n");
  for (const double degrees : {60., 5.}) {
    const ReadOptions smooth{.meshes = {.smooth_deg = degrees}};
    const Triangles one = read_scene(shared, nullptr, smooth).scene.geometry.triangles,
                    all = read_scene(soup, nullptr, smooth).scene.geometry.triangles;
    EXPECT_EQ(one.vertex_count(), degrees > 10 ? 4u : 6u);
    EXPECT_EQ(all.vertex_count(), 9u);
    for (std::size_t i = 0; i < 2; ++i)
      for (const auto corner : {&Triangles::a, &Triangles::b, &Triangles::c}) {
        const std::uint32_t v = (one.*corner)[i], w = (all.*corner)[i];
        EXPECT_EQ(normal(one, v), normal(all, w)) << degrees << ' ' << i;
        EXPECT_EQ(all.red[w], light_of_byte(w + 1));
      }
  }
}

const std::string kCloud = kHead +
                           "property float red\nproperty float green\nproperty float blue\n"
                           "end_header\n0 0 0 1 0 0\n4 0 0 0 1 0\n4 4 0 1 0 0\n0 nan 0 0 0 1\n";

TEST(Points, AreBalls) {
  const TemporaryFolder folder;
  const std::string path = folder.add("cloud.ply", kCloud);
  const SceneFile file = read_scene(path, nullptr, {.meshes = {.point_radius = .25}});
  const Spheres& s = file.scene.geometry.spheres;
  EXPECT_EQ(file.points.count, 4u);
  EXPECT_EQ(file.dropped.not_finite, 1u);
  EXPECT_TRUE(file.colors.of_vertices);
  EXPECT_EQ(s.radius, std::vector<float>(3, .25f));
  EXPECT_EQ(s.x, (std::vector<float>{0, 4, 4}));
  const auto color = [&](std::size_t i) { return file.scene.materials.at(s.material[i]).diffuse; };
  EXPECT_EQ(color(0), (Float3{.9f, 0, 0}));
  EXPECT_EQ(color(1), (Float3{0, .9f, 0}));
  EXPECT_EQ(s.material[2], s.material[0]);
  const float radius = read_scene(path, nullptr).scene.geometry.spheres.radius.at(0);
  EXPECT_NEAR(radius, .65 * 4, 1e-6);
  const SceneFile scene =
      read_scene(folder.add("s.nff", kView + kFill + "ply cloud.ply\ns 0 0 0 1\n"),
                 nullptr,
                 {.meshes = {.point_radius = .5}});
  EXPECT_EQ(scene.scene.geometry.spheres.size(), 4u);
  EXPECT_EQ(scene.scene.materials.at(scene.scene.geometry.spheres.material[3]),
            scene.scene.materials[0])
      << "what follows has the file's material";
}

/// A few points far out, and points written twice, do not change the size of the others.
TEST(Points, AreAsLargeAsTheirNeighborsAreNear) {
  Random random(1);
  const auto with = [&](std::size_t strays, const auto& add) {
    std::vector<float> x, y, z;
    const auto put = [&](float px, float py, float pz) {
      x.push_back(px);
      y.push_back(py);
      z.push_back(pz);
    };
    add(put);
    for (std::size_t i = 0; i < strays; ++i)
      put(1000 + random.point(300).x, random.point(1e6f).y, 1e4f);
    return radius_for(x, y, z);
  };
  const auto lattice = [](const auto& put) {
    for (int i = 0; i < 900; ++i)
      put(float(i % 30) / 4, float(i / 30) / 4, 0);
  };
  const auto doubled = [&](const auto& put) {
    for (int i = 0; i < 4; ++i)
      lattice(put);
    put(NAN, 0, 0);
  };
  const auto on_ball = [&](const auto& put) {
    for (int i = 0; i < 5000; ++i) {
      const Float3 p = random.point(1);
      const float size = std::hypot(p.x, p.y, p.z);
      put(p.x / size, p.y / size, p.z / size);
    }
  };
  for (const std::size_t strays : {0u, 1u, 20u, 100u}) {
    EXPECT_NEAR(with(strays, lattice), .65 / 4, 1e-6) << strays;
    EXPECT_NEAR(with(strays, doubled), .65 / 4, 1e-6) << strays;
    EXPECT_NEAR(with(strays, on_ball), .65 * std::sqrt(4 * std::numbers::pi / 5000), .005)
        << strays;
  }
  EXPECT_EQ(radius_for({}, {}, {}), 1);
  EXPECT_EQ(radius_for({1, 1}, {2, 2}, {3, 3}), 1) << "in one place";
  EXPECT_NEAR(radius_for({0, 3}, {0, 4}, {0, 0}), .65 * 5, 1e-5);
  // all but a few in one plane, across which every point is as near
  std::vector<float> x(200'000, 0), y, z;
  for (std::size_t i = 0; i < x.size(); ++i) {
    y.push_back(float(i % 500));
    z.push_back(float(i / 500));
  }
  EXPECT_NEAR(radius_for(x, y, z), .65, 1e-6);
}

/// Balls fill the picture as meshes do, however large they are.
TEST(Points, FitIntoThePicture) {
  const TemporaryFolder folder;
  const std::string path = folder.add("cloud.ply", kCloud);
  for (const double radius : {.05, .5, 3.}) {
    const SceneFile file = read_scene(path, nullptr, {.meshes = {.point_radius = radius}});
    const World world(file.scene, {});
    Camera camera = file.camera;
    camera.width = camera.height = 200;
    std::vector<Ray> rays(200);
    int most = 0;
    for (int y = 0; y < 200; ++y) {
      camera_rays(camera, y, rays);
      for (int x = 0; x < 200; ++x)
        if (closest(world, rays[std::size_t(x)]))
          most = std::max({most, std::abs(2 * x - 199), std::abs(2 * y - 199)});
    }
    EXPECT_NEAR(most, 180, 5) << radius;
  }
}

}  // namespace
}  // namespace grelha::test
