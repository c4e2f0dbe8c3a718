// What docs/library.md shows does what it says. The build takes its code from there.
#include <grelha/grelha.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace page {
#include "library_page.hpp"
}  // namespace page

#ifdef GRELHA_C
#include <grelha.h>
extern "C" int depths(const float* vertices,
                      size_t vertex_count,
                      const uint32_t* indices,
                      size_t triangles,
                      const float* points,
                      size_t count,
                      float* t);
extern "C" int meshes_below(const grelha_mesh* meshes,
                            size_t count,
                            size_t which,
                            const grelha_mesh* moved,
                            const float* points,
                            size_t point_count,
                            uint32_t* mesh);
#endif

namespace grelha {
namespace {

struct LibraryPage : testing::Test {
  Scene scene = page::cube();
  World world{scene, {}};
  const Ray down{.org = {.25f, .5f, 5}, .dir = {0, 0, -1}};
  const Ray beside{.org = {2, .5f, 5}, .dir = {0, 0, -1}};
};

TEST_F(LibraryPage, FirstHit) {
  const std::optional<SurfacePoint> below = page::surface_below(world, {.25f, .5f, 5});
  ASSERT_TRUE(below);
  EXPECT_EQ(below->point, (Float3{.25f, .5f, 1}));
  EXPECT_EQ(below->normal, (Float3{0, 0, 1}));
  EXPECT_FALSE(page::surface_below(world, {2, .5f, 5}));
}

TEST_F(LibraryPage, Stream) {
  std::vector<float> t(3);
  std::vector<float> u(3);
  std::vector<float> v(3);
  page::range_image(world, {-.5f, -.75f, 5}, {0, 0, -1, 0, 0, 1, .0625f, .125f, -1}, t, u, v);
  EXPECT_EQ(t, (std::vector{4.f, std::numeric_limits<float>::infinity(), 4.f}));
  // the triangle (-1 -1) (1 -1) (-1 1) at (-.5 -.75) and (-.25 -.25)
  EXPECT_EQ(u, (std::vector{.25f, 0.f, .375f}));
  EXPECT_EQ(v, (std::vector{.125f, 0.f, .375f}));
}

TEST_F(LibraryPage, AnyHit) {
  const std::optional<SurfacePoint> top = page::surface_below(world, {.25f, .5f, 5});
  ASSERT_TRUE(top);
  EXPECT_TRUE(page::is_lit(world, *top, {3, 3, 4}));
  EXPECT_FALSE(page::is_lit(world, *top, {0, 0, -4}));
}

TEST_F(LibraryPage, AllHits) {
  const std::vector<Hit> all = page::layers(world, down, 5);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].t, 4);
  EXPECT_EQ(all[1].t, 6);
  EXPECT_EQ(page::layers(world, down, 1).size(), 1u);
  const std::vector<Hit> last = page::exits(world, std::vector{down, beside});
  EXPECT_EQ(last[0].t, 6);
  EXPECT_FALSE(last[1]);
}

TEST_F(LibraryPage, WhatAMeshIs) {
  EXPECT_FALSE(page::first_gap(world));
  Triangles& t = scene.geometry.triangles;
  t.a.pop_back();  // 3 7 5
  t.b.pop_back();
  t.c.pop_back();
  const World open(scene, {});
  EXPECT_EQ(page::first_gap(open), (std::pair<std::uint32_t, std::uint32_t>{5, 7}));
}

TEST_F(LibraryPage, Inside) {
  EXPECT_EQ(page::filled_share(world, std::vector<Float3>{{0, 0, 0}, {0, 0, 2}, {.5f, 0, .5f}}),
            2. / 3);
  Triangles& t = scene.geometry.triangles;
  t.a.pop_back();
  t.b.pop_back();
  t.c.pop_back();
  const World scan(scene, {});
  EXPECT_EQ(page::filled_share_of_scan(scan, std::vector<Float3>{{0, 0, 0}, {0, 0, 2}}), .5);
  EXPECT_THROW(page::filled_share(scan, std::vector<Float3>(1)), NotClosed);
}

TEST_F(LibraryPage, Distance) {
  EXPECT_EQ(page::kept_away(world, {0, 0, .5f}, .25f), (Float3{0, 0, 1.25f}));
  EXPECT_EQ(page::kept_away(world, {0, 0, 1.125f}, .25f), (Float3{0, 0, 1.25f}));
  EXPECT_EQ(page::kept_away(world, {0, 0, 3}, .25f), (Float3{0, 0, 3}));
}

TEST_F(LibraryPage, Moving) {
  page::lift(world, scene, 2);
  EXPECT_EQ(closest(world, down).t, 2);
  EXPECT_EQ(scene.geometry.triangles.z[7], 3);
}

TEST_F(LibraryPage, MovingAnObject) {
  scene.geometry.objects = {{0, 12}};
  World whole(scene, {});
  page::lift_object(whole, scene, scene.geometry.objects[0], 0, 8, 2);
  EXPECT_EQ(closest(whole, down).t, 2);
}

TEST_F(LibraryPage, SeveralMeshes) {
  const std::vector<Float3> low{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  const std::vector<Float3> high{{-1, -1, 1}, {1, -1, 1}, {0, 1, 1}};
  const std::vector<std::array<std::uint32_t, 3>> face{{0, 1, 2}};
  const MeshArrays meshes[] = {{PointArray(std::span(low)), face},
                               {PointArray(std::span(high)), face}};
  OwningWorld owner(scene_of(meshes), {});
  const Ray ray{.org = {0, 0, 5}, .dir = {0, 0, -1}};
  EXPECT_EQ(page::mesh_at(owner, ray), (MeshFace{1, 0}));
  EXPECT_EQ(page::mesh_behind(owner, 1, ray), (MeshFace{0, 0}));
  EXPECT_EQ(page::mesh_at(owner, ray), (MeshFace{1, 0}));
  const std::vector<Float3> above{{-1, -1, 2}, {1, -1, 2}, {0, 1, 2}};
  page::move_one(owner, 0, above);
  EXPECT_EQ(page::mesh_at(owner, ray), (MeshFace{0, 0}));
}

TEST_F(LibraryPage, Threads) {
  std::atomic<double> done = 0;
  std::atomic<bool> cancelled = false;
  const std::vector<Ray> rays{down, beside};
  EXPECT_EQ(page::shadows(world, rays, done, cancelled), (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(done, 1);
  cancelled = true;
  EXPECT_THROW(page::shadows(world, rays, done, cancelled), Stopped);
}

#ifdef GRELHA_C
TEST_F(LibraryPage, FromC) {
  const float corners[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const float points[] = {0, 0, 2, 0, 0, 3, 5, 5, 5};
  const std::uint32_t indices[] = {0, 1, 2, 3};
  std::vector<float> t(3);
  EXPECT_EQ(depths(corners, 3, indices, 1, points, 3, t.data()), 0);
  EXPECT_EQ(t, (std::vector{2.f, 3.f, std::numeric_limits<float>::infinity()}));
  EXPECT_NE(depths(corners, 3, indices + 1, 1, points, 3, t.data()), 0);
}

TEST_F(LibraryPage, SeveralMeshesFromC) {
  const float low[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0}, high[] = {-1, -1, 1, 1, -1, 1, 0, 1, 1};
  const float aside[] = {4, -1, 1, 6, -1, 1, 5, 1, 1};
  const float points[] = {0, 0, 2, 5, 0, 3, 9, 9, 9};
  const std::uint32_t face[] = {0, 1, 2};
  grelha_mesh meshes[] = {{low, nullptr, 12, 3, face, 1}, {high, nullptr, 12, 3, face, 1}};
  const grelha_mesh moved{aside, nullptr, 12, 3, nullptr, 0};
  std::vector<std::uint32_t> mesh(3);
  EXPECT_EQ(meshes_below(meshes, 2, 1, &moved, points, 3, mesh.data()), 0);
  EXPECT_EQ(mesh, (std::vector{0u, 1u, GRELHA_NONE}));
  meshes[1].indices = nullptr;
  EXPECT_NE(meshes_below(meshes, 2, 1, &moved, points, 3, mesh.data()), 0);
}
#endif

}  // namespace
}  // namespace grelha
