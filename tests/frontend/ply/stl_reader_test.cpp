// STL, binary and text, against PLY files of the same meshes.
#include "frontend/ply/stl_reader.hpp"

#include <cstring>

#include "frontend/input/read_scene.hpp"
#include "frontend/jobs/identity.hpp"
#include "tests/support/random.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

struct Shape {
  std::vector<Float3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
};

/// Random triangles over few vertices, numbered in the order in which faces name them.
Shape random_shape(std::uint64_t seed) {
  Random random(seed);
  std::vector<Float3> points;
  for (int i = 0; i < 30; ++i)
    points.push_back(random.point(10));
  Shape shape;
  std::vector<std::uint32_t> number(points.size(), ~0u);
  for (int f = 0; f < 40; ++f) {
    std::array<std::uint32_t, 3> face;
    for (std::uint32_t& v : face) {
      const std::size_t p = random.below(std::uint32_t(points.size()));
      if (number[p] == ~0u) {
        number[p] = std::uint32_t(shape.vertices.size());
        shape.vertices.push_back(points[p]);
      }
      v = number[p];
    }
    shape.faces.push_back(face);
  }
  return shape;
}

std::string number(float v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", double{v});
  return text;
}

std::string place(const Float3& p) {
  return number(p.x) + ' ' + number(p.y) + ' ' + number(p.z);
}

std::string ply_of(const Shape& shape) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(shape.vertices.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(shape.faces.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Float3& p : shape.vertices)
    text += place(p) + '\n';
  for (const auto& [a, b, c] : shape.faces)
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  return text;
}

std::string text_of(const Shape& shape, const std::string& line_end = "\n") {
  std::string text = "solid part of two" + line_end;
  for (const auto& face : shape.faces) {
    text += "facet normal 0 nan 1" + line_end + "outer loop" + line_end;
    for (const std::uint32_t v : face)
      text += "vertex " + place(shape.vertices[v]) + line_end;
    text += "endloop" + line_end + "endfacet" + line_end;
  }
  return text + "endsolid part" + line_end;
}

std::string binary_of(const Shape& shape, const std::string& header = "made by a test") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  const auto put = [&](const void* from, std::size_t size) {
    bytes.append(static_cast<const char*>(from), size);
  };
  const auto count = std::uint32_t(shape.faces.size());
  put(&count, 4);
  for (const auto& face : shape.faces) {
    put("\0\0\0\0\0\0\0\0\0\0\0", 12);
    for (const std::uint32_t v : face)
      put(&shape.vertices[v], 12);
    put("\1\2", 2);
  }
  return bytes;
}

/// The digest is of all that a picture shows.
TEST(Stl, IsThePlyOfItsMesh) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Shape shape = random_shape(seed);
    const SceneFile ply = read_scene(folder.add("m.ply", ply_of(shape)), nullptr);
    for (const std::string& bytes : {text_of(shape),
                                     text_of(shape, "\r\n"),
                                     binary_of(shape),
                                     binary_of(shape, "solid by name alone"),
                                     binary_of(shape) + "more"}) {
      std::vector<std::string> lines;
      const SceneFile stl = read_scene(folder.add("m.STL", bytes),
                                       [&](const std::string& line) { lines.push_back(line); });
      EXPECT_EQ(scene_digest(stl), scene_digest(ply)) << "seed " << seed;
      EXPECT_EQ(stl.counts.mesh, shape.faces.size());
      EXPECT_LE(lines.size(), 1u) << "of triangles without area";
    }
  }
}

/// Surveys in text keep their digits, and corners at 0 and -0 are one.
TEST(Stl, FarAndNearZero) {
  const TemporaryFolder folder;
  const SceneFile far = read_scene(
      folder.add("m.stl",
                 "SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 5000000.25 0 0\n"
                 "VERTEX 5000001.25 0 0\nVERTEX 5000000.25 1 0\nENDLOOP\nENDFACET\nENDSOLID\n"),
      nullptr);
  EXPECT_EQ(far.scene.geometry.triangles.size(), 1u);
  EXPECT_EQ(far.frame.outside(far.scene.geometry.triangles.x[0], 0), 5000000.25);
  const std::string facet =
      "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 -0\nvertex 0 1 0\nendloop\n"
      "endfacet\nfacet\nouter loop\nvertex -0 0 0\nvertex 0 1 0\nvertex 0 0 1\n"
      "endloop\nendfacet\n";
  const Mesh mesh = read_stl_mesh("m.stl", "solid\n" + facet + "endsolid\n", {}, nullptr, {});
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  const Mesh two = read_stl_mesh(
      "m.stl", "solid a\n" + facet + "endsolid\nsolid b\n" + facet + "endsolid\n", {}, nullptr, {});
  EXPECT_EQ(two.face_count(), 4u);
}

TEST(Stl, WhatIsBrokenIsSaid) {
  const auto message = [](const std::string& bytes) {
    return message_of([&] { read_stl_mesh("m.stl", bytes, {}, nullptr, {}); });
  };
  const std::string start = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n";
  EXPECT_EQ(message(start + "vertex 0 x 0\n"),
            "m.stl:6:10: error: expected a number of the vertex, found \"x\"");
  EXPECT_EQ(message(start + "endloop\n"),
            "m.stl:6:1: error: expected three vertices before \"endloop\", found \"endloop\"");
  EXPECT_EQ(message(start + "normal\n"),
            "m.stl:6:1: error: expected \"facet\", \"vertex\" or \"endsolid\", found \"normal\"");
  EXPECT_NE(message(start).find("expected \"endloop\" behind three vertices, found end of file"),
            std::string::npos);
  EXPECT_EQ(message(binary_of(random_shape(1)).substr(0, 1000)),
            "m.stl:byte 1000: error: expected \"solid\" in text, or 2084 bytes of triangles, found "
            "end of file");
  EXPECT_EQ(message(""),
            "m.stl:byte 0: error: expected \"solid\" in text, or 84 bytes of triangles, found end "
            "of file");
  std::vector<std::string> lines;
  read_stl_mesh(
      "m.stl", "solid\n", [&](const std::string& line) { lines.push_back(line); }, nullptr, {});
  EXPECT_EQ(lines, std::vector<std::string>{"m.stl: warning: the file ends without \"endsolid\""});
}

/// Whatever is changed, a file is read or refused in one line.
TEST(Stl, MutantsAreReadOrRefused) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    std::string bytes = seed % 2 == 0 ? binary_of(random_shape(seed)) : text_of(random_shape(seed));
    for (int k = 0; k < 3; ++k)
      bytes[random.below(std::uint32_t(bytes.size()))] = char(random.below(256));
    if (random.chance(.3))
      bytes.resize(random.below(std::uint32_t(bytes.size())));
    const std::string path = folder.add("m.stl", bytes);
    const std::string message = message_of([&] { read_scene(path, nullptr); });
    EXPECT_TRUE(message.empty() || message.starts_with(path)) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace grelha::test
