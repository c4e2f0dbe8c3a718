// Tests the default view, lights and samples of a mesh file without a scene.
#include "frontend/input/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "frontend/input/effects.hpp"
#include "frontend/input/read_scene.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "grelha/render.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha {
namespace {

SceneFile file_of(const std::vector<Float3>& points,
                  const std::vector<std::array<std::uint32_t, 3>>& faces) {
  SceneFile file;
  Triangles& t = file.scene.geometry.triangles;
  for (const Float3& p : points) {
    t.x.push_back(p.x);
    t.y.push_back(p.y);
    t.z.push_back(p.z);
  }
  for (const auto& [a, b, c] : faces) {
    t.a.push_back(a);
    t.b.push_back(b);
    t.c.push_back(c);
    t.material.push_back(0);
  }
  file.scene.materials.push_back(default_mesh_material());
  add_default_view(file);
  return file;
}

/// A box from 0 to its size, moved; `inward`: its faces turned inside out.
SceneFile box(const Float3& size, float shift = 0, float scale = 1, bool inward = false) {
  std::vector<Float3> points;
  for (int i = 0; i < 8; ++i)
    points.push_back({scale * (shift + size.x * float(i & 1)),
                      scale * (shift + size.y * float(i >> 1 & 1)),
                      scale * (shift + size.z * float(i >> 2))});
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    faces.push_back({a, b, c}), faces.push_back({a, c, d});
  if (inward)
    for (auto& f : faces)
      std::swap(f[1], f[2]);
  return file_of(points, faces);
}

/// Triangles as they are read of an STL file.
SceneFile stl_of(const Triangles& t) {
  std::string text = "solid box\n";
  const auto vertex = [&](std::uint32_t v) {
    for (const float number : {t.x[v], t.y[v], t.z[v]})
      text += ' ' + std::to_string(number);
    text += '\n';
  };
  for (std::size_t i = 0; i < t.size(); ++i) {
    text += "facet\nouter loop\n";
    for (const auto* corner : {&t.a, &t.b, &t.c}) {
      text += "vertex";
      vertex((*corner)[i]);
    }
    text += "endloop\nendfacet\n";
  }
  const test::TemporaryFolder folder;
  return read_scene(folder.add("box.stl", text + "endsolid\n"), nullptr);
}

/// The vertices alone.
SceneFile points_of(const Triangles& t) {
  SceneFile file;
  for (std::size_t v = 0; v < t.vertex_count(); ++v)
    file.scene.geometry.spheres.add({t.x[v], t.y[v], t.z[v]}, .01f, 0);
  add_default_view(file);
  return file;
}

Image picture(const SceneFile& file, int side) {
  Camera camera = file.camera;
  camera.width = camera.height = side;
  RenderStats stats;
  return render(World(file.scene, {}), camera, {}, stats);
}

struct Seen {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;  ///< pixels that are not background
  float darkest = 1;
};

Seen seen(const SceneFile& file, int side) {
  const Image image = picture(file, side);
  const Float3& b = file.scene.background;
  Seen s;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float* const p = image.row(y) + 3 * x;
      if (p[0] == b.x && p[1] == b.y && p[2] == b.z)
        continue;
      s.left = std::min(s.left, x);
      s.right = std::max(s.right, x);
      s.top = std::min(s.top, y);
      s.bottom = std::max(s.bottom, y);
      s.darkest = std::min({s.darkest, p[0], p[1], p[2]});
    }
  return s;
}

/// A mesh of any form, size and position fills exactly nine tenths of the picture's width or
/// height.
TEST(DefaultView, FillsThePicture) {
  constexpr int kSide = 200;
  for (const Float3& size : {Float3{1, 1, 1},
                             Float3{5, 1, .5f},
                             Float3{.2f, 4, .2f},
                             Float3{1, 1, 30},
                             Float3{1, .01f, 1}})
    for (const float scale : {1e-6f, 1.f, 1e9f})
      for (const float shift : {-.5f, 100.f}) {
        const Seen s = seen(box(size, shift, scale), kSide);
        const int across = s.right - s.left + 1, down = s.bottom - s.top + 1;
        EXPECT_NEAR(std::max(across, down), .9 * kSide, 2.5)
            << size.x << ' ' << size.y << ' ' << size.z << " times " << scale << ", from " << shift;
        EXPECT_NEAR(across >= down ? s.left + s.right : s.top + s.bottom, kSide - 1, 3)
            << "in the middle";
        EXPECT_GE(std::min({s.left, s.top, kSide - 1 - s.right, kSide - 1 - s.bottom}),
                  .05 * kSide - 2);
      }
}

TEST(DefaultView, NoFaceIsBlack) {
  for (const bool inward : {false, true})
    for (const Float3& size : {Float3{1, 1, 1}, Float3{3, 1, .2f}, Float3{.1f, 2, 3}})
      EXPECT_GT(seen(box(size, 0, 1, inward), 64).darkest, .19f);
}

/// Whiter than white is nothing either: the lights together leave a face its shade.
TEST(DefaultView, NoFaceIsBurntOut) {
  const Image image = picture(box({1, 1, 1}), 64);
  EXPECT_LT(*std::max_element(image.rgb.begin(), image.rgb.end()), 1);
}

/// A table on four legs stands on them, along y or along z; a box has y up.
TEST(DefaultView, AMeshStandsOnItsFeet) {
  const auto table = [](bool z_up) {
    std::vector<Float3> points;
    std::vector<std::array<std::uint32_t, 3>> faces;
    const auto add = [&](float x, float y, float height) {
      points.push_back(z_up ? Float3{x, y, height} : Float3{x, height, -y});
    };
    for (const auto& [x, y] : {std::pair{0.f, 0.f}, {4.f, 0.f}, {0.f, 3.f}, {4.f, 3.f}}) {
      const auto first = static_cast<std::uint32_t>(points.size());
      add(x, y, 0);
      add(x + .1f, y, 3);
      add(x, y + .1f, 3);
      faces.push_back({first, first + 1, first + 2});
    }
    const auto first = static_cast<std::uint32_t>(points.size());
    add(2, 1.5f, 5);
    add(1, 1, 3);
    add(3, 1.2f, 3);
    faces.push_back({first, first + 1, first + 2});
    add(2, -1, 4);
    add(2, 5, 4.5f);  // a bird over it
    faces.push_back({first, first + 3, first + 4});
    return file_of(points, faces);
  };
  EXPECT_EQ(table(false).camera.up, (Float3{0, 1, 0}));
  EXPECT_EQ(table(true).camera.up, (Float3{0, 0, 1}));
  const Camera c = table(true).camera;
  EXPECT_GT(c.eye.z, c.at.z) << "seen from above";
  EXPECT_LT(c.eye.y, c.at.y) << "and from its front";
  EXPECT_EQ(box({1, 1, 1}).camera.up, (Float3{0, 1, 0}));
}

/// Twelve first pictures by what is up and which side the eye is on: boxes by their size, as PLY
/// and points, or as STL.
TEST(DefaultView, StandsUprightAndShowsItsFront) {
  const Float3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, front_z{0, 0, 1}, front_y{0, -1, 0};
  struct Case {
    const char* name;
    Float3 size;
    bool stl;
    Float3 up, front;
  };
  const Case cases[] = {
      {"calibration cube", {20, 20, 20}, true, z, front_y},
      {"plate printed upright", {80, 4, 50}, true, z, front_y},
      {"flat plate", {80, 50, 4}, true, z, front_y},
      {"shaft", {120, 10, 10}, true, z, front_y},
      {"mast", {10, 10, 300}, true, z, front_y},
      {"wall", {4, 80, 50}, true, z, front_y},
      {"scan", {1, 2, 1.2f}, false, y, front_z},
      {"scan of a slab", {2, 3, .4f}, false, y, front_z},
      {"terrain, z up", {60, 60, .6f}, false, z, front_y},
      {"terrain, y up", {60, .6f, 60}, false, y, front_z},
      {"terrain, x up", {.6f, 60, 60}, false, x, front_y},
      {"rod", {.1f, 5, .1f}, false, y, front_z},
  };
  for (const auto& [name, size, stl, up, front] : cases) {
    const SceneFile mesh = box(size);
    const Triangles& t = mesh.scene.geometry.triangles;
    for (const SceneFile& file : {stl ? stl_of(t) : mesh, stl ? stl_of(t) : points_of(t)}) {
      const Camera& c = file.camera;
      EXPECT_EQ(c.up, up) << name;
      const Float3 back = c.eye - c.at;
      EXPECT_GT(dot(back, front), .6 * std::sqrt(dot(back, back))) << name;
      EXPECT_GT(dot(back, up), .3 * std::sqrt(dot(back, back))) << name << " from above";
      EXPECT_GT(dot(cross(up, front), back), 0) << name << " from its right";
    }
  }
}

TEST(DefaultView, AMeshTakesSixteenSamplesUnlessAskedOtherwise) {
  const auto samples = [](const Effects& effects) {
    SceneFile file = box({1, 1, 1});
    RenderOptions options;
    apply_effects(effects, file, options);
    return options.sampling.samples;
  };
  Effects one, jitter;
  one.samples = 1;
  jitter.jitter = 3;
  EXPECT_EQ(samples({}), 16);
  EXPECT_EQ(samples(one), 1);
  EXPECT_EQ(samples(jitter), 9);
  SceneFile scene = box({1, 1, 1});
  scene.default_camera = false;
  RenderOptions options;
  apply_effects({}, scene, options);
  EXPECT_EQ(options.sampling.samples, 1);
}

}  // namespace
}  // namespace grelha
