// STL, binary and text, against PLY files of the same meshes.
#include "frontend/ply/mesh_file.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "frontend/input/read_scene.hpp"
#include "frontend/input/view.hpp"
#include "frontend/jobs/identity.hpp"
#include "grelha/mesh_check.hpp"
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
    SceneFile ply = read_scene(folder.add("m.ply", ply_of(shape)), nullptr);
    add_default_view(ply, Float3{0, 0, 1});
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
            "m.stl:6:1: error: expected \"vertex\" or \"endloop\", found \"normal\"");
  EXPECT_NE(message(start).find("expected \"endloop\" behind three vertices, found end of file"),
            std::string::npos);
  EXPECT_EQ(message("solid\nfacet\nouter loop\nendloop\nendfacet\nendsolid\n"),
            "m.stl:4:1: error: expected three vertices before \"endloop\", found \"endloop\"");
  EXPECT_EQ(message(start + "vertex 0 1 0\nvertx 0 0 1\nendloop\n"),
            "m.stl:7:1: error: expected \"vertex\" or \"endloop\", found \"vertx\"");
  EXPECT_EQ(message(start + "vertex 0 1 0\nfacet normal 0 0 1\n"),
            "m.stl:7:1: error: expected \"endloop\" behind three vertices, found \"facet\"");
  EXPECT_EQ(message("solid\n"),
            "m.stl:2:1: error: expected a facet, or \"endsolid\", found end of file");
  EXPECT_EQ(message("<html>\n<body>\n"), "m.stl:1:1: error: expected STL, found XML or a web page");
  EXPECT_EQ(message("version https://git-lfs.github.com/spec/v1\n").substr(0, 44),
            "m.stl:1:1: error: expected a scene, found a ");
  for (const std::string header : {"made by a test", "solid by name alone"}) {
    EXPECT_EQ(message(binary_of(random_shape(1), header).substr(0, 1000)),
              "m.stl:byte 1000: error: expected 40 triangles, found 18 in 1000 bytes, and then the "
              "end of the file");
    EXPECT_EQ(
        message(binary_of(random_shape(1), header).substr(0, 84)),
        "m.stl:byte 84: error: expected 40 triangles, found 0 in 84 bytes, and then the end of "
        "the file");
  }
}

TEST(Stl, WhatIsOddIsWarnedOf) {
  const auto warnings = [](const std::string& bytes) {
    std::string lines;
    read_stl_mesh(
        "m.stl", bytes, [&](const std::string& line) { lines += line + '\n'; }, nullptr, {});
    return lines;
  };
  const std::string solid = text_of(random_shape(1));
  EXPECT_EQ(warnings(solid), "");
  EXPECT_EQ(warnings(solid.substr(0, solid.find("endsolid"))),
            "m.stl: warning: the file ends without \"endsolid\"\n");
  EXPECT_EQ(warnings(solid + solid.substr(0, solid.find("endsolid"))),
            "m.stl: warning: the file ends without \"endsolid\"\n");
  EXPECT_EQ(warnings(solid + "written by x\n"), "");
  EXPECT_EQ(warnings("written by x\n" + solid),
            "m.stl:1:1: warning: no line of an STL file begins with \"written\"; such lines are "
            "skipped\n");
  EXPECT_EQ(warnings(binary_of(random_shape(1)) + std::string(60, ' ')),
            "m.stl: warning: 60 bytes follow the last of 40 triangles; they are skipped\n");
}

/// Of loops of more corners than three, and of files of several solids, or of one line.
TEST(Stl, LoopsAndSolids) {
  const auto faces = [](const std::string& bytes) {
    const Mesh mesh = read_stl_mesh("m.stl", bytes, {}, nullptr, {});
    return std::pair(mesh.face_count(), mesh.indices.size());
  };
  const std::string loop = "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n";
  const std::string end = "endloop\nendfacet\n";
  EXPECT_EQ(faces("solid\n" + loop + end), std::pair(1ul, 3ul));
  EXPECT_EQ(faces("solid\n" + loop + "endfacet\nendsolid"), std::pair(1ul, 3ul));
  EXPECT_EQ(faces("solid\n" + loop + "vertex 0 0 0\n" + end), std::pair(1ul, 3ul)) << "closed";
  EXPECT_EQ(faces("solid\n" + loop + end + loop + "vertex 0 1 0\n" + end), std::pair(2ul, 7ul));
  EXPECT_EQ(faces(loop + end), std::pair(1ul, 3ul)) << "without a solid";
  EXPECT_EQ(faces("solid a\n" + loop + end + "endsolid a\nsolid b\n" + loop + end + loop + end),
            std::pair(3ul, 9ul));
  std::string line = "solid a name " + loop + end + loop + end + "endsolid a name solid b " + loop +
                     end + "endsolid b";
  std::ranges::replace(line, '\n', ' ');
  EXPECT_EQ(faces(line), std::pair(3ul, 9ul));
  for (std::size_t at = 0; (at = line.find("facet outer", at)) != line.npos; at += 20)
    line.insert(at + 5, " normal 0 0 1");
  EXPECT_EQ(faces(line), std::pair(3ul, 9ul));
  EXPECT_EQ(faces("solid a\nendsolid a\n"), std::pair(0ul, 0ul));
}

/// Triangles of a solid have the vertices from its first up to the next solid's.
void expect_own_vertices(const SceneFile& file) {
  const Triangles& t = file.scene.geometry.triangles;
  std::size_t end = t.vertex_count();
  for (std::size_t k = file.solids.size(); k-- > 0;) {
    const NamedObject& solid = file.solids[k];
    for (std::uint32_t i = 0; i < solid.triangles.triangle_count; ++i)
      for (const auto* corner : {&t.a, &t.b, &t.c}) {
        const std::uint32_t v = (*corner)[solid.triangles.first_triangle + i];
        EXPECT_TRUE(v >= solid.first_vertex && v < end) << v << " of solid " << k;
      }
    end = solid.first_vertex;
  }
}

/// Solids are objects with names and vertices of their own, smooth or not, also where they are read
/// by a scene; those without a facet are none.
TEST(Stl, SolidsHaveNames) {
  const auto facet = [](const std::string& last) {
    return "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n" + last +
           "endloop\nendfacet\n";
  };
  const std::string plain = facet("vertex 1 1 0\n"), quad = facet("vertex 1 1 0\nvertex 0 1 0\n"),
                    bad = facet("vertex 1e30 0 0\n");
  const std::string text = plain + "endsolid\nsolid  lid of a box \n" + quad + plain +
                           "endsolid lid\nsolid none\nendsolid\nsolid\n" + bad + "endsolid\n" +
                           "solid \xC3\xA9\n" + plain + facet("vertex 0 0 1\n") + "endsolid";
  std::string line = text;
  std::ranges::replace(line, '\n', ' ');
  const TemporaryFolder folder;
  for (const std::string& bytes : {text, line})
    for (const double smooth : {0., 30.})
      for (const bool in_scene : {false, true}) {
        std::string path = folder.add("m.stl", bytes);
        if (in_scene)
          path = folder.add("s.nff", kView + kFill + "ply m.stl\n");
        const SceneFile file = read_scene(path, nullptr, {.meshes = {.smooth_deg = smooth}});
        ASSERT_EQ(file.solids.size(), 4u) << bytes;
        ASSERT_EQ(file.scene.geometry.objects.size(), 4u);
        const std::pair<const char*, std::uint64_t> expected[] = {
            {"", 1}, {"lid of a box", 2}, {"", 1}, {"\xC3\xA9", 2}};
        const std::uint32_t triangles[] = {1, 3, 0, 2};
        for (std::size_t k = 0; k < 4; ++k) {
          const NamedObject& solid = file.solids[k];
          EXPECT_EQ(std::pair(solid.name, solid.faces),
                    std::pair(std::string(expected[k].first), expected[k].second));
          EXPECT_EQ(solid.triangles.triangle_count, triangles[k]);
          EXPECT_EQ(file.scene.geometry.objects[k].first_triangle, solid.triangles.first_triangle);
        }
        expect_own_vertices(file);
      }
}

/// A ball, each ring of which begins with `ring_begins`.
std::string ball_of(const std::string& ring_begins) {
  constexpr int kRings = 12;
  const auto vertex = [](int ring, int side) {
    const double polar = std::numbers::pi * ring / kRings,
                 around = std::numbers::pi * (side % (2 * kRings)) / kRings;
    const double r = ring % kRings == 0 ? 0 : std::sin(polar);
    return "vertex " +
           place(
               {float(r * std::cos(around)), float(r * std::sin(around)), float(std::cos(polar))}) +
           '\n';
  };
  std::string text;
  for (int ring = 0; ring < kRings; ++ring) {
    text += ring_begins;
    for (int side = 0; side < 2 * kRings; ++side) {
      const std::string from = "facet\nouter loop\n" + vertex(ring, side), to = "endfacet\n";
      if (ring < kRings - 1)
        text += from + vertex(ring + 1, side) + vertex(ring + 1, side + 1) + to;
      if (ring > 0)
        text += from + vertex(ring + 1, side + 1) + vertex(ring, side + 1) + to;
    }
  }
  return text;
}

/// A ball of patches, as programs of flow write it, is as smooth as one of one solid, and closed.
TEST(Stl, SmoothsOverSeams) {
  const TemporaryFolder folder;
  for (const double degrees : {10., 40.}) {
    std::vector<std::vector<float>> corners;
    for (const std::string& text : {ball_of(""), ball_of("solid ring\n")}) {
      const SceneFile file =
          read_scene(folder.add("ball.stl", text), nullptr, {.meshes = {.smooth_deg = degrees}});
      EXPECT_TRUE(check_mesh(file.scene).is_closed());
      expect_own_vertices(file);
      const Triangles& t = file.scene.geometry.triangles;
      corners.emplace_back();
      for (std::size_t i = 0; i < t.size(); ++i)
        for (const auto* corner : {&t.a, &t.b, &t.c})
          for (const auto* of : {&t.x, &t.y, &t.z, &t.nx, &t.ny, &t.nz})
            corners.back().push_back((*of)[(*corner)[i]]);
    }
    ASSERT_EQ(corners[0].size(), corners[1].size());
    for (std::size_t i = 0; i < corners[0].size(); ++i)
      EXPECT_NEAR(corners[0][i], corners[1][i], 1e-6) << "sums may be in another order";
  }
}

/// By its bytes, whatever it is called; other names are not mistaken.
TEST(Stl, OfAnyName) {
  const TemporaryFolder folder;
  const Shape shape = random_shape(1);
  for (const std::string& bytes : {text_of(shape), binary_of(shape), binary_of(shape, "solid x")}) {
    EXPECT_EQ(read_scene(folder.add("part", bytes), nullptr).counts.mesh, 40u);
    folder.add("part.stl", bytes);
    const SceneFile file =
        read_scene(folder.add("s.nff", kView + kFill + "ply part.stl\n"), nullptr);
    EXPECT_EQ(file.scene.geometry.triangles.size(), 40u);
  }
  const std::string cut = folder.add("part", binary_of(shape).substr(0, 1000));
  EXPECT_NE(message_of([&] { read_scene(cut, nullptr); }).find("expected 40 triangles, found 18"),
            std::string::npos);
  const std::string scene = folder.add("s.nff", "# solid facet vertex 0 0 0\n" + kView + kFill);
  EXPECT_EQ(read_scene(scene, nullptr).counts.mesh, 0u);
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
