// Colours of PLY files, against the curve of sRGB in long double.
#include <cmath>

#include "frontend/input/read_scene.hpp"
#include "frontend/ply/mesh_file.hpp"
#include "tests/support/ply_writer.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

float light_of(const std::string& type, double number) {
  if (type != "uchar")
    return float(type == "ushort" ? number / 65535 : number);
  const long double encoded = static_cast<long double>(number) / 255;
  return float(encoded <= .04045L ? encoded / 12.92L : std::pow((encoded + .055L) / 1.055L, 2.4L));
}

double full(const std::string& type) {
  return type == "uchar" ? 255 : type == "ushort" ? 65535 : 1;
}

using Case = std::tuple<std::string, std::string, std::string>;
class PlyColors : public testing::TestWithParam<Case> {
 protected:
  std::string format = std::get<0>(GetParam()), type = std::get<1>(GetParam());
  /// Colours of 86 vertices, or of faces: all bytes, or as many other numbers.
  PlyWriter file(bool of_faces) const {
    const std::string& prefix = std::get<2>(GetParam());
    PlyWriter w(format);
    const auto colors = [&](bool here) {
      for (const char* name : {"red", "green", "blue", "alpha"})
        if (here)
          w.line("property " + type + ' ' + prefix + name);
    };
    w.line("element vertex 86").line("property float x");
    colors(!of_faces);
    w.line("property float y").line("property float z").line("element face 86");
    w.line("property list uchar int vertex_indices");
    colors(of_faces);
    w.line("end_header");
    for (const bool faces : {false, true})
      for (int i = 0; i < 86; ++i) {
        faces ? w.value("uchar", 3).values("int", {double(i), double((i + 1) % 86), 0})
              : w.value("float", i);
        if (faces == of_faces)
          w.values(type, {number(3 * i), number(3 * i + 1), number(3 * i + 2), 1});
        if (!faces)
          w.values("float", {double(i * i), 0});
        w.end_row();
      }
    return w;
  }
  double number(int i) const {
    const double share = double(i % 256) / 255;
    return type == "uchar" || type == "ushort" ? std::round(share * full(type)) : share;
  }
};
INSTANTIATE_TEST_SUITE_P(
    Ply,
    PlyColors,
    testing::Combine(testing::Values("ascii", "binary_little_endian", "binary_big_endian"),
                     testing::Values("uchar", "ushort", "float", "double"),
                     testing::Values("", "diffuse_")));

TEST_P(PlyColors, AreLight) {
  for (const bool of_faces : {false, true}) {
    const PlyWriter w = file(of_faces);
    const Mesh mesh = read_ply_mesh("m.ply", w.bytes());
    EXPECT_EQ(mesh.colors_of_faces, of_faces);
    EXPECT_EQ(mesh.has_alpha, std::get<2>(GetParam()).empty());
    ASSERT_EQ(mesh.red.size(), 86u);
    for (std::size_t i = 0; i < 86; ++i)
      for (int c = 0; c < 3; ++c) {
        const float got = (c == 0 ? mesh.red : c == 1 ? mesh.green : mesh.blue)[i];
        // ASCII numbers have six digits
        const double wanted = light_of(type, number(3 * int(i) + c));
        if (format == "ascii")
          EXPECT_NEAR(got, wanted, 1e-6);
        else
          EXPECT_EQ(got, float(wanted)) << type << ' ' << number(3 * int(i) + c);
      }
    EXPECT_TRUE(read_ply_mesh("m.ply", w.bytes(), {}, nullptr, {}, false).red.empty());
  }
}

std::vector<std::string> warnings_of(const std::string& bytes) {
  std::vector<std::string> lines;
  read_ply_mesh("m.ply", bytes, [&](const std::string& line) { lines.push_back(line); });
  return lines;
}

using Names = std::array<const char*, 3>;

std::string one_vertex(const std::string& type,
                       const std::string& numbers,
                       const Names& names = {"red", "green", "blue"}) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (const char* name : {"x", "y", "z"})
    text += std::string("property float ") + name + '\n';
  for (const char* name : names)
    text += "property " + type + ' ' + name + '\n';
  return text + "end_header\n0 0 0 " + numbers + '\n';
}

TEST(PlyColors, WhatIsNoColourIsSaid) {
  EXPECT_EQ(warnings_of(one_vertex("float", "2 nan .5")),
            std::vector<std::string>{
                "m.ply:3:9: warning: 2 numbers of colours are cut: expected them from 0 to 1"});
  const Mesh cut = read_ply_mesh("m.ply", one_vertex("float", "2 -1 .5"));
  EXPECT_EQ(cut.red.at(0), 1);
  EXPECT_EQ(cut.green.at(0), 0);
  EXPECT_EQ(cut.blue.at(0), .5f);
  EXPECT_EQ(read_ply_mesh("m.ply", one_vertex("uchar", "300 -7 255")).red.at(0), 1);
  EXPECT_NE(message_of([] { read_ply_mesh("m.ply", one_vertex("uchar", "1 2 x")); }), "");
}

TEST(PlyColors, AreNamedInManyWays) {
  for (const Names& names : {Names{"r", "g", "b"},
                             {"R", "G", "B"},
                             {"Red", "Green", "Blue"},
                             {"RED", "GREEN", "BLUE"},
                             {"diffuse_red", "diffuse_green", "diffuse_blue"}}) {
    EXPECT_EQ(warnings_of(one_vertex("uchar", "255 0 51", names)), std::vector<std::string>{});
    const Mesh mesh = read_ply_mesh("m.ply", one_vertex("uchar", "255 0 51", names));
    ASSERT_EQ(mesh.red, std::vector<float>{1}) << names[0];
    EXPECT_EQ(mesh.green, std::vector<float>{0});
    EXPECT_NEAR(mesh.blue.at(0), .0331048, 1e-6);
  }
}

/// The largest number says what white is where the type does not.
TEST(PlyColors, AreReadByTheirRange) {
  struct OfRange {
    const char *type, *numbers;
    float green;
    const char* warning;  ///< the end of it
  };
  const float half = .2158605f;
  for (const OfRange& c :
       {OfRange{"ushort", "255 128 0", half, "up to 255, and read them as sRGB from 0 to 255"},
        {"ushort", "65535 13107 0", .2f, ""},
        {"ushort", "256 0 0", 0, ""},
        {"ushort", "0 0 0", 0, ""},
        {"short", "255 128 0", half, "read them as sRGB from 0 to 255"},
        {"int", "255 128 0", half, "read them as sRGB from 0 to 255"},
        {"uint", "200 128 0", half, "read them as sRGB from 0 to 255"},
        {"int", "1 1 0", 1, "read them as light from 0 to 1"},
        {"int", "60000 13107 0", .2f, "read them as light from 0 to 65535"},
        {"uint", "4294967295 858993459 0", .2f, "from 0 to 4294967295"},
        {"char", "-1 -128 0", half, "read them as sRGB from 0 to 255"},
        {"float", "255 128 0", half, "read them as sRGB from 0 to 255"},
        {"float", "254.5 127.6 0", half, "read them as sRGB from 0 to 255"},
        {"double", "65535 13107 0", .2f, "read them as light from 0 to 65535"},
        {"float", "1 .2 0", .2f, ""},
        {"float", "1.5 .2 0", .2f, "1 numbers of colours are cut: expected them from 0 to 1"}}) {
    const std::string bytes = one_vertex(c.type, c.numbers);
    EXPECT_NEAR(read_ply_mesh("m.ply", bytes).green.at(0), c.green, 1e-6) << c.type << c.numbers;
    const auto lines = warnings_of(bytes);
    ASSERT_EQ(lines.size(), *c.warning ? 1u : 0u) << c.type << ' ' << c.numbers;
    EXPECT_TRUE(lines.empty() || lines[0].ends_with(c.warning)) << lines[0];
  }
}

TEST(PlyColors, OfElementsByOtherNames) {
  const Mesh mesh = read_ply_mesh(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertices 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement Faces 1\nproperty list uchar int vertex_indices\nproperty uchar "
      "r\nproperty uchar g\nproperty uchar b\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
  EXPECT_EQ(mesh.face_count(), 1u);
  EXPECT_EQ(mesh.vertex_count(), 3u);
  EXPECT_EQ(mesh.red, std::vector<float>{1});
}

/// Those of vertices count where faces have some too; an element keeps the name that is another's.
TEST(PlyColors, OfVerticesBeforeThoseOfFaces) {
  const Mesh mesh = read_ply_mesh(
      "m.ply",
      "ply\nformat ascii 1.0\nelement faces 1\nproperty int r\nelement vertices 1\nproperty int "
      "r\nelement face 1\nproperty list uchar int vertex_indices\nproperty uchar r\nproperty uchar "
      "g\nproperty uchar b\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n7\n7\n"
      "3 0 1 2 255 0 0\n0 0 0 0 0 255\n1 0 0 0 0 255\n0 1 0 0 0 255\n");
  EXPECT_FALSE(mesh.colors_of_faces);
  EXPECT_EQ(mesh.blue, std::vector<float>(3, 1));
}

/// A square of two triangles, red and green, both as faces have colours.
const std::string kColoredFaces =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 3\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
    "3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n4 0 1 2 3 255 0 0\n";

TEST(ColoursOfFaces, BecomeMaterials) {
  const TemporaryFolder folder;
  folder.add("m.ply", kColoredFaces);
  const SceneFile file = read_scene(
      folder.add("s.nff", kView + "f .5 .5 .5 .8 0 0 0 1\nply m.ply\ns 0 0 0 1\n"), nullptr);
  const Scene& s = file.scene;
  EXPECT_TRUE(file.colors.of_faces && !file.colors.of_vertices && !file.colors.alpha);
  EXPECT_TRUE(s.geometry.triangles.red.empty());
  ASSERT_EQ(s.geometry.triangles.size(), 4u);
  const auto color = [&](std::uint32_t material) { return s.materials.at(material).diffuse; };
  const Float3 base = color(s.geometry.spheres.material.at(0));
  const std::vector<std::uint32_t>& of = s.geometry.triangles.material;
  EXPECT_EQ(base, s.materials.at(0).diffuse) << "the ball behind the mesh has the file's material";
  EXPECT_EQ(color(of[0]), (Float3{base.x, 0, 0}));
  EXPECT_EQ(color(of[1]), (Float3{0, base.y, 0}));
  EXPECT_EQ(of[2], of[0]) << "one material for each colour";
  EXPECT_EQ(of[3], of[0]);
  EXPECT_FALSE(
      read_scene(folder.path() / "m.ply", nullptr, {.meshes = {.colors = false}}).colors.any());
}

/// Meshes with and without colours, and polygons, in one scene: what has none is white. Where sides
/// cross, the new vertex has the mean of both sides.
TEST(ColoursOfVertices, StayWithTheirMesh) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  folder.add("plain.ply", head + faces + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  folder.add("bow.ply",
             head + "property float red\nproperty float green\nproperty float blue\n" + faces +
                 "0 0 0 1 0 0\n1 0 0 0 0 0\n0 1 0 0 0 1\n1 1 0 0 1 0\n4 0 1 2 3\n");
  const SceneFile file = read_scene(
      folder.add(
          "s.nff",
          kView + kFill + "ply plain.ply\nply bow.ply\nply plain.ply\np 3 0 0 0 1 0 0 0 1 0\n"),
      nullptr);
  const Triangles& t = file.scene.geometry.triangles;
  ASSERT_EQ(t.red.size(), t.vertex_count());
  ASSERT_EQ(t.vertex_count(), 4u + 5 + 4 + 3);
  const auto color = [&](std::size_t v) { return Float3{t.red[v], t.green[v], t.blue[v]}; };
  for (const std::size_t v : {0u, 3u, 9u, 12u, 13u, 15u})
    EXPECT_EQ(color(v), (Float3{1, 1, 1})) << v;
  EXPECT_EQ(color(4), (Float3{1, 0, 0}));
  EXPECT_EQ(color(6), (Float3{0, 0, 1}));
  // (1 0)-(0 1) crosses (1 1)-(0 0)
  EXPECT_EQ(color(8), (Float3{.25f, .25f, .25f}));
}

}  // namespace
}  // namespace grelha::test
