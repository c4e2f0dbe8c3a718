#include "frontend/input/read_scene.hpp"
#include "frontend/ply/mesh_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include "grelha/mesh_check.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kAsciiTriangle;
using test::TemporaryFolder;

TEST(PlyAlone, PolygonsAreCutAndBadFacesCounted) {
  const TemporaryFolder folder;
  const std::string path =
      folder.add("m.ply",
                 "ply\nformat ascii 1.0\nelement vertex 9\nproperty float x\nproperty float "
                 "y\nproperty float z\n"
                 "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n4 0 0\n1 1 0\n0 4 0\n0 0 0\n+inf 0 0\n8 0 0\n0 0 1e19\n-3 0 0\n"
                 "4 0 1 2 3\n3 0 0 1\n3 0 4 1\n3 0 1 5\n2 0 1\n3 0 1 7\n");
  std::vector<std::string> warnings;
  const SceneFile file =
      read_scene(path, [&](const std::string& line) { warnings.push_back(line); });
  EXPECT_EQ(file.counts.ply, 6u);
  EXPECT_EQ(file.counts.materials, 0u);
  EXPECT_EQ(file.scene.geometry.triangles.size(), 4u);
  EXPECT_EQ(file.dropped.zero_area, 1u) << "of two corners";
  EXPECT_EQ(file.dropped.not_finite, 2u);
  EXPECT_EQ(
      warnings,
      std::vector<std::string>{
          path +
          ": warning: 3 primitives are left out: 2 not finite (or beyond 1e18), 1 without area"});
}

/// They number the faces, and join what lies along a longer side, in polygons too.
TEST(PlyAlone, TrianglesWithoutAreaAreKept) {
  const TemporaryFolder folder;
  const SceneFile file = read_scene(
      folder.add("m.ply", kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n3 2 1 0\n"), nullptr);
  EXPECT_EQ(file.dropped.zero_area, 0u);
  EXPECT_EQ(file.scene.geometry.triangles.a, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(file.scene.geometry.triangles.material.size(), 2u);
  EXPECT_EQ(file.counts.ply, 2u);
  // a tetrahedron with two vertices on its first side, each seen from one face alone
  const std::string vertices =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face ";
  const std::string sides =
      "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n1 0 "
      "0\n2 0 0\n3 0 2 1\n3 1 2 3\n3 0 3 2\n5 0 4 5 1 3\n";
  for (const auto& [count, flat] : {std::pair<const char*, const char*>{"5", "4 0 1 5 4\n"},
                                    {"6", "3 0 1 5\n3 0 5 4\n"},
                                    {"4", ""}}) {
    const SceneFile mesh =
        read_scene(folder.add("t.ply", vertices + count + sides + flat), nullptr);
    EXPECT_EQ(check_mesh(mesh.scene).is_closed(), *flat != 0) << flat;
    EXPECT_EQ(mesh.dropped.zero_area, 0u);
  }
}

/// Nothing is seen of them, so a picture is the same without.
TEST(PlyAlone, TrianglesWithoutAreaAreNotInView) {
  const TemporaryFolder folder;
  std::string vertices = kAsciiTriangle;
  const std::string far = "element vertex 4";
  vertices.replace(vertices.find("element vertex 3"), far.size(), far);
  std::string one = vertices;
  one.replace(one.find("face 2"), 6, "face 1");
  const SceneFile with = read_scene(
                      folder.add("a.ply",
                                 vertices + "9 9 9\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n3 0 1 0\n"),
                      nullptr),
                  without = read_scene(
                      folder.add("b.ply", one + "9 9 9\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n"), nullptr);
  EXPECT_EQ(with.scene.geometry.triangles.size(), 2u);
  EXPECT_EQ(with.camera.eye, without.camera.eye);
  EXPECT_EQ(with.camera.at, without.camera.at);
}

TEST(PlyAlone, EmptyMeshHasAView) {
  const TemporaryFolder folder;
  const SceneFile file =
      read_scene(folder.add("m.ply", "ply\nformat ascii 1.0\nend_header\n"), nullptr);
  EXPECT_TRUE(file.default_camera);
  EXPECT_TRUE(std::isfinite(file.camera.eye.x));
  EXPECT_TRUE(file.scene.geometry.objects.empty());
}

TEST(PlyAlone, IsToldByItsExtensionOrItsFirstWord) {
  const TemporaryFolder folder;
  for (const char* name : {"m.PLY", "m.mesh", "m"})
    EXPECT_TRUE(
        read_scene(folder.add(name, "ply\nformat ascii 1.0\nend_header\n"), nullptr).default_camera)
        << name;
}

/// Alone and named by a scene; a triangle whose vertices have normals gets a crossing that has one.
TEST(PlyAlone, FacesThatCrossThemselvesAreFilledAndSaid) {
  const TemporaryFolder folder;
  const std::string mesh = folder.add(
      "ties.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 3\nproperty list "
      "uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 1 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n"
      "2 2 0 0 0 1\n3 0 2 1\n4 0 1 2 3\n4 3 2 1 0\n");
  const std::string scene = folder.add("scene.nff", test::kView + "f 1 1 1\nply ties.ply\n");
  const std::string said =
      mesh +
      ": warning: 2 faces cross themselves, face 1 from 0 is the first: filled by the "
      "even-odd rule";
  for (const std::string& file : {mesh, scene}) {
    std::vector<std::string> warnings;
    const SceneFile read =
        read_scene(file, [&](const std::string& line) { warnings.push_back(line); });
    const Triangles& t = read.scene.geometry.triangles;
    EXPECT_EQ(t.size(), 5u);
    EXPECT_EQ(t.vertex_count(), 7u);
    EXPECT_EQ((Float3{t.x.at(6), t.y.at(6), t.nz.at(6)}), (Float3{.5f, .5f, 1}));
    EXPECT_NE(std::find(warnings.begin(), warnings.end(), said), warnings.end());
  }
}

TEST(PlyAlone, FacesThatFoldOverThemselvesAreSaid) {
  const TemporaryFolder folder;
  const std::string mesh = folder.add(
      "folded.ply",
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n4 2 0\n"
      "3 2 0\n3 2 2\n1 2 2\n1 2 0\n4 0 2 1 3\n7 0 1 2 3 4 5 6\n");
  std::vector<std::string> warnings;
  read_scene(mesh, [&](const std::string& line) { warnings.push_back(line); });
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0],
            mesh +
                ": warning: face 0 from 0 crosses itself: filled by the even-odd rule; face 1 from "
                "0 folds over itself: what is seen along the normal is filled");
}

}  // namespace
}  // namespace grelha
