#include "frontend/nff/nff_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "frontend/input/read_scene.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kFill;
using test::kView;
using test::read_text;
using test::read_with_view;
using test::Reading;
using test::TemporaryFolder;
using testing::Test;
using Lines = std::vector<std::string>;

const Triangles& triangles(const Reading& r) {
  return r.file.scene.geometry.triangles;
}

TEST(NffView, FieldsInAnyOrder) {
  const Reading r = read_text(
      "b .1 .2 .3 v resolution 640 480.0 angle 30.5 hither 0 up 0 0 1\nat 1 2 3 from -4 +5 6e0");
  EXPECT_EQ(r.warnings, Lines{});
  const Camera& c = r.file.camera;
  EXPECT_EQ(c.eye, (Float3{-4, 5, 6}));
  EXPECT_EQ(c.at, (Float3{1, 2, 3}));
  EXPECT_EQ(c.up, (Float3{0, 0, 1}));
  EXPECT_EQ(c.angle_deg, 30.5);
  EXPECT_EQ(c.width, 640);
  EXPECT_EQ(c.height, 480);
  EXPECT_EQ(r.file.scene.background, (Float3{.1f, .2f, .3f}));
  EXPECT_FALSE(r.file.lens.present);
}

TEST(NffView, CameraAndEyeOf2023) {
  const Reading r = read_text(
      "accel bvh\nspp 4\nbclr 1 0 0\ncamera\neye 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither "
      "1\nresolution 3 2\n"
      "aperture 0\nfocal 1.5\n");
  EXPECT_EQ(r.warnings, Lines{});
  EXPECT_EQ(r.file.camera.eye, (Float3{0, 0, 5}));
  EXPECT_EQ(r.file.accelerator, "bvh");
  EXPECT_EQ(r.file.samples_per_pixel, 4);
  EXPECT_TRUE(r.file.lens.present);
  EXPECT_EQ(r.file.lens.focal, 1.5);
  EXPECT_EQ(r.file.scene.background, (Float3{1, 0, 0}));
}

TEST(NffView, LensInsideTheViewIsKept) {
  const Reading r = read_text(
      "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nfocal 4\nview 1\napperture .5\nangle 45\nhither "
      "1\nresolution 8 6\n");
  EXPECT_EQ(r.file.lens.aperture, .5);
  EXPECT_EQ(r.file.lens.focal, 4);
  EXPECT_EQ(r.warnings, Lines{});
}

TEST(NffView, EnvironmentIsNamedAndLeftOut) {
  EXPECT_EQ(read_with_view("B probe.hdr").warnings.size(), 1u);
  const Reading r = read_with_view("env sky box # night\nenv other");
  EXPECT_EQ(r.file.environment, "other");
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:8:1: warning: environment maps are not rendered; the background color "
                  "is seen instead"});
}

TEST(NffView, MissingResolutionAndSecondView) {
  Reading r = read_text("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45");
  EXPECT_EQ(r.file.camera.width, 512);
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:1:1: warning: the view has no resolution; 512 512 is taken"});
  r = read_with_view("v from 0 0 7 at 0 0 0 up 0 1 0 angle 60 resolution 4 4");
  EXPECT_EQ(r.file.camera.angle_deg, 60);
  EXPECT_EQ(r.warnings, Lines{"scene.nff:8:1: warning: a second view; the last one counts"});
}

TEST(NffLights, ColorlessOnesShare) {
  const Reading r =
      read_with_view(kFill + "s 0 0 0 1\nl 1 2 3\nl 4 5 6 # late\nl 7 8 9 .1 .2 .3\nl 1 1 1");
  const auto& lights = r.file.scene.lights;
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(r.file.counts.lights, 4u);
  EXPECT_EQ(lights[1].position, (Float3{4, 5, 6}));
  EXPECT_EQ(lights[1].color, (Float3{.5f, .5f, .5f}));  // 1/sqrt(4)
  EXPECT_EQ(lights[2].color, (Float3{.1f, .2f, .3f}));
}

TEST(NffLights, Punctual) {
  const Reading r = read_with_view("light punctual -1 4 -1\n1 .5 0");
  ASSERT_EQ(r.file.scene.lights.size(), 1u);
  EXPECT_EQ(r.file.scene.lights[0].position, (Float3{-1, 4, -1}));
  EXPECT_EQ(r.file.scene.lights[0].color, (Float3{1, .5f, 0}));
}

TEST(NffLights, AreasKeepTheirShapeAroundTheirCentre) {
  const Reading r = read_with_view(
      "light quad -1 4 -1 1 1 1 1 4 -1 -1 4 3 16\n"  // three corners, color behind the first
      "al 0 0 5  2 0 0  0 4 0  1 .5 .25\n"           // corner, two edges, color
      "al 0 0 5  0 0 0  2 4  1 1 0\n");              // position, at, width, height, color
  ASSERT_EQ(r.file.scene.lights.size(), 3u);
  const Light &quad = r.file.scene.lights[0], &facing = r.file.scene.lights[2];
  EXPECT_EQ(quad.edge1, (Float3{2, 0, 0}));
  EXPECT_EQ(quad.edge2, (Float3{0, 0, 4}));
  EXPECT_EQ(quad.position, (Float3{0, 4, 1}));
  EXPECT_EQ(r.file.scene.lights[1].position, (Float3{1, 2, 5}));
  EXPECT_EQ(r.file.scene.lights[1].color, (Float3{1, .5f, .25f}));
  EXPECT_EQ(facing.position, (Float3{0, 0, 5}));
  EXPECT_EQ(std::abs(facing.edge1.x) + std::abs(facing.edge1.y), 2);
  EXPECT_EQ(std::abs(facing.edge2.x) + std::abs(facing.edge2.y), 4);
  EXPECT_EQ(facing.edge1.z, 0);
  EXPECT_EQ(r.warnings, Lines{});
}

Material only_material(const std::string& text) {
  const Reading r = read_with_view(text);
  EXPECT_EQ(r.warnings, Lines{});
  EXPECT_EQ(r.file.counts.materials, 1u);
  return r.file.scene.materials.at(0);
}

TEST(NffMaterial, EightFields) {
  const Material m = only_material("f 1 .5 0 .5 .25 10 .75 1.5");
  EXPECT_EQ(m.diffuse, (Float3{.5f, .25f, 0}));
  EXPECT_EQ(m.specular, (Float3{.25f, .125f, 0}));
  EXPECT_EQ(m.mirror, (Float3{.25f, .25f, .25f}));
  EXPECT_EQ(m.shine, 10);
  EXPECT_EQ(m.transmission, .75f);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_FALSE(m.fresnel);
}

TEST(NffMaterial, ElevenFields) {
  for (const char* word : {"f", "mat"}) {
    const Material m = only_material(std::string(word) + " 1 .5 0 .5  .5 1 0 .25 10 .75 1.5");
    EXPECT_EQ(m.diffuse, (Float3{.5f, .25f, 0}));
    EXPECT_EQ(m.specular, (Float3{.125f, .25f, 0}));
    EXPECT_EQ(m.mirror, m.specular);
    EXPECT_EQ(m.shine, 10);
    EXPECT_TRUE(m.fresnel);
  }
  EXPECT_FALSE(only_material("mat 1 .5 0 .5  .5 1 0 .25 10 0 1").fresnel);
}

TEST(NffMaterial, RoughnessAndEmission) {
  EXPECT_EQ(only_material("f 1 1 1 1 1 1 1 .5 10 0 1 .3").roughness, .3f);
  EXPECT_EQ(only_material("mat 1 1 1 1 1 1 1 .5 10 0 1 6 5 4").emission, (Float3{6, 5, 4}));
  EXPECT_EQ(only_material("f 1 1 1 1 1 1 1 .5 10 0 1 6 5 4").roughness, 0);
}

TEST(NffMaterial, BrokenOverLines) {
  EXPECT_EQ(only_material("f 1 .5\n0 .5 .25\n10 0 1\ns 0 0 0 1").shine, 10);
  EXPECT_EQ(only_material("f 1 .5 0 .5\n.5 1 0 .25 10 .75 1.5\ns 0 0 0 1").transmission, .75f);
}

TEST(NffMaterial, OtherNumbersOfFieldsAreGuessed) {
  Reading r = read_with_view("f .25 .5 1\ns 0 0 0 1");
  EXPECT_EQ(r.file.scene.materials[0].diffuse, (Float3{.25f, .5f, 1}));
  EXPECT_EQ(
      r.warnings,
      Lines{"scene.nff:8:1: warning: a material with 3 fields, where 8, 11, 12 or 14 are known"});
  r = read_with_view("f 1 .5 0 .5 .25 10 0 1 .1\nf 1 .5 0 .5 .25 10 0 1 .1\ns 0 0 0 1");
  EXPECT_EQ(r.file.scene.materials[0].shine, 10);
  EXPECT_EQ(r.warnings.size(), 1u);
  r = read_with_view("f 1 .5 0 .5 .25 10 0 1 wood.jpg\ns 0 0 0 1");
  EXPECT_EQ(r.file.counts.s, 1u);
  EXPECT_EQ(r.warnings, Lines{"scene.nff:8:24: warning: texture \"wood.jpg\" is left out"});
}

TEST(NffMaterial, MissingOneIsWhiteAndNotCounted) {
  const Reading r = read_with_view("s 0 0 0 1\n" + kFill + "s 0 0 0 2\n");
  EXPECT_EQ(r.file.counts.materials, 1u);
  ASSERT_EQ(r.file.scene.materials.size(), 2u);
  EXPECT_EQ(r.file.scene.geometry.spheres.material, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(
      r.warnings,
      Lines{"scene.nff:8:1: warning: an object before the first \"f\"; it is drawn dull white"});
}

TEST(NffShapes, SpheresAndConesInAnyLayout) {
  const Reading r = read_with_view(
      kFill + "s 1 2 3\n\t4\nc 0 0 0 1 0 0 2 .5\nc\n0 0 0 -2\n0 0 3 -2 # in\ns 0 0 0 -1");
  const Spheres& s = r.file.scene.geometry.spheres;
  const Cones& c = r.file.scene.geometry.cones;
  EXPECT_EQ(r.warnings, Lines{});
  EXPECT_EQ(s.radius, (std::vector<float>{4, -1}));
  EXPECT_EQ(s.z[0], 3);
  EXPECT_EQ(c.base_radius, (std::vector<float>{1, -2}));
  EXPECT_EQ(c.apex_radius, (std::vector<float>{.5f, -2}));
  EXPECT_EQ(c.apex_z, (std::vector<float>{2, 3}));
  EXPECT_EQ(r.file.counts.s, 2u);
  EXPECT_EQ(r.file.counts.c, 2u);
}

TEST(NffShapes, AnyLineEnds) {
  const std::string unix_text =
      kView + kFill + "s 0 0 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\nl 1 1 1\nl 2 2 2 1 1 1";
  for (const std::string end : {"\n", "\r\n", "\r", "\n\r\n", " \t\r\r\n"}) {
    std::string text;
    for (const char c : unix_text)
      c == '\n' ? text += end : text += c;
    const Reading r = read_text(text);
    EXPECT_EQ(r.warnings, Lines{});
    EXPECT_EQ(r.file.counts.s, 1u);
    EXPECT_EQ(r.file.counts.p, 1u);
    EXPECT_EQ(r.file.counts.lights, 2u);
    EXPECT_EQ(r.file.scene.lights[1].color, (Float3{1, 1, 1}));
  }
}

TEST(NffShapes, PolygonsShareTheirOwnCorners) {
  const Reading r = read_with_view(kFill + "p 4 0 0 0 1 0 0 1 1 0 0 1 0\np 3 0 0 0 1 0 0 0 1 0");
  EXPECT_EQ(r.file.counts.p, 2u);
  EXPECT_EQ(triangles(r).vertex_count(), 7u);
  EXPECT_EQ(triangles(r).a, (std::vector<std::uint32_t>{0, 0, 4}));
  EXPECT_TRUE(triangles(r).nx.empty());
  EXPECT_TRUE(r.file.scene.geometry.objects.empty());
}

TEST(NffShapes, PatchesBringNormals) {
  const Reading r = read_with_view(
      kFill + "p 3 0 0 0 1 0 0 0 1 0\npp 4\n0 0 0 0 0 1\n2 0 0 1 0 1\n2 2 0 0 0 1\n0 2 0 nan 0 1");
  const Triangles& t = triangles(r);
  EXPECT_EQ(r.file.counts.pp, 1u);
  EXPECT_EQ(t.size(), 3u);
  EXPECT_EQ(t.nz, (std::vector<float>{0, 0, 0, 1, 1, 1, 0}));  // a normal that is none is (0,0,0)
  EXPECT_EQ(t.nx, (std::vector<float>{0, 0, 0, 0, 1, 0, 0}));
}

/// A corner 1e-5 off the plane on a short side gives a sliver whose own normal is far off; the
/// polygon's is used.
TEST(NffShapes, SliversTakeThePolygonsNormal) {
  const Reading r = read_with_view(kFill + "p 5 1 1 0  .5 1.00001 .00001  0 1 0  0 0 0  1 0 0");
  ASSERT_EQ(triangles(r).nz.size(), 5u);
  // the bump of 1e-5 tilts the whole by about as much
  for (const float z : triangles(r).nz)
    EXPECT_NEAR(z, 1, 1e-4);
}

TEST(NffShapes, PlanesByPointsAndByDistance) {
  const Reading r = read_with_view(kFill + "pl 12 12 -.5 -12 12 -.5 -12 -12 -.5\nnpl 0 2 0 6");
  const Planes& p = r.file.scene.geometry.planes;
  ASSERT_EQ(p.size(), 2u);
  EXPECT_EQ(r.file.counts.pl, 2u);
  EXPECT_EQ((Float3{p.nx[0], p.ny[0], p.nz[0]}), (Float3{0, 0, 1}));
  EXPECT_EQ(p.z[0], -.5f);
  EXPECT_EQ((Float3{p.nx[1], p.ny[1], p.nz[1]}), (Float3{0, 1, 0}));
  EXPECT_EQ(p.y[1], -3);  // 2 y + 6 = 0
}

/// Six times the volume inside, by the divergence theorem; positive when all triangles face
/// outwards.
double signed_volume(const Triangles& t) {
  double sum = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const std::size_t a = t.a[i], b = t.b[i], c = t.c[i];
    sum += t.x[a] * (t.y[b] * t.z[c] - t.z[b] * t.y[c]) +
           t.y[a] * (t.z[b] * t.x[c] - t.x[b] * t.z[c]) +
           t.z[a] * (t.x[b] * t.y[c] - t.y[b] * t.x[c]);
  }
  return sum / 6;
}

TEST(NffShapes, BoxesFromCornersInEitherOrder) {
  for (const char* text : {"box 0 0 0 1 2 3",
                           "box 1 2 3 0 0 0",
                           "box 1 0 3 0 2 0",
                           "aabb 0 0 0 1 2 3",
                           "aabb 1 2 3 0 0 0"}) {
    const Reading r = read_with_view(kFill + text);
    EXPECT_EQ(triangles(r).size(), 12u);
    EXPECT_EQ(signed_volume(triangles(r)), 6) << text;  // small whole numbers: exact
    EXPECT_EQ(r.file.counts.box, 1u);
  }
}

/// Volumes of the boxes of one file, in its order.
std::vector<double> box_volumes(const std::string& boxes) {
  const Triangles t = triangles(read_with_view(kFill + boxes));
  std::vector<double> volumes;
  for (std::size_t first = 0; first + 12 <= t.size(); first += 12) {
    Triangles one = t;
    for (auto* indices : {&one.a, &one.b, &one.c}) {
      indices->erase(indices->begin() + std::ptrdiff_t(first + 12), indices->end());
      indices->erase(indices->begin(), indices->begin() + std::ptrdiff_t(first));
    }
    volumes.push_back(signed_volume(one));
  }
  return volumes;
}

TEST(NffShapes, AabbHasOneOrderAFile) {
  using Volumes = std::vector<double>;
  const std::string pairs = "aabb 0 4 -1 1 2 3\n";    // as corners unordered on y
  const std::string corners = "aabb 5 4 -1 1 2 3\n";  // x 5..4 is no pair
  const std::string both = "aabb 0 1 2 3 4 5\n";      // pairs: 1 x 1 x 1; corners: 3 x 3 x 3
  EXPECT_EQ(box_volumes(pairs), Volumes{8});
  EXPECT_EQ(box_volumes(corners), Volumes{32});
  EXPECT_EQ(box_volumes(both), Volumes{27});
  EXPECT_EQ(box_volumes(both + pairs), (Volumes{1, 8})) << "the box in front of the one that tells";
  EXPECT_EQ(box_volumes(pairs + both), (Volumes{8, 1}));
  EXPECT_EQ(box_volumes(both + corners + both), (Volumes{27, 32, 27}));
  EXPECT_EQ(box_volumes(pairs + corners + both), (Volumes{8, 32, 27}))
      << "any numbers can be corners";
  EXPECT_EQ(box_volumes(both + "# aabb 0 4 -1 1 2 3\n"), Volumes{27}) << "a comment is no box";
  EXPECT_EQ(box_volumes(pairs + "aabb nan 4 3 1 2 3\n" + both), (Volumes{8, 1}))
      << "what is left out has no say";
}

TEST(NffShapes, TheOrderOfAabbIsSaid) {
  EXPECT_EQ(read_with_view(kFill + "s 0 0 0 1").file.box_order, BoxOrder::kNone);
  EXPECT_EQ(read_with_view(kFill + "aabb 0 0 0 1 1 1").file.box_order, BoxOrder::kVertices);
  EXPECT_EQ(read_with_view(kFill + "aabb 0 1 0 1 0 1").file.box_order, BoxOrder::kPairs);
}

TEST(NffShapes, BoxWithoutThicknessIsTwoFaces) {
  const Reading r = read_with_view(kFill + "box 0 0 0 1 0 3\nbox 0 0 0 1 0 0");
  EXPECT_EQ(triangles(r).size(), 4u);
  EXPECT_EQ(r.file.dropped.zero_area, 1u);
  EXPECT_EQ(r.file.counts.box, 2u);
}

TEST(NffShapes, MeshesAreObjects) {
  const Reading r = read_with_view(
      kFill + "p 3 0 0 0 1 0 0 0 1 0\nmesh 4 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 2 3\n-4 -2 -1\n" +
      "p 3 0 0 0 1 0 0 0 1 0\nmesh 3 1 0 0 0 1 0 0 1 1 0 1 2 3");
  const Geometry& g = r.file.scene.geometry;
  EXPECT_EQ(r.file.counts.mesh, 3u);
  ASSERT_EQ(g.objects.size(), 2u);
  EXPECT_EQ(g.objects[0].first_triangle, 1u);
  EXPECT_EQ(g.objects[0].triangle_count, 2u);
  EXPECT_EQ(g.objects[1].first_triangle, 4u);
  EXPECT_EQ(g.triangles.a, (std::vector<std::uint32_t>{0, 3, 3, 7, 10}));
  EXPECT_EQ(g.triangles.c, (std::vector<std::uint32_t>{2, 5, 6, 9, 12}));
}

TEST(NffShapes, PlyFilesStandBesideTheScene) {
  const TemporaryFolder folder;
  folder.add("a mesh.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
             "y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 "
             "1 0\n3 0 1 2\n");
  const std::string scene = folder.add(
      "scene.nff",
      kView + kFill + "ply a mesh.ply # twice\n" + kFill + "ply a mesh.ply\r\ns 0 0 0 1");
  const SceneFile file = read_scene(scene, nullptr);
  EXPECT_EQ(file.counts.ply, 2u);
  EXPECT_EQ(file.counts.s, 1u);
  EXPECT_EQ(file.scene.geometry.objects.size(), 2u);
  EXPECT_EQ(file.scene.geometry.triangles.material, (std::vector<std::uint32_t>{0, 1}));
}

}  // namespace
}  // namespace grelha
