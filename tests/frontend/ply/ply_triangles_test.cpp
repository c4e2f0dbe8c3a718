// Rows of three indices, which are read many at once. A part of ply_reader_test.
#include <gtest/gtest.h>

#include "frontend/ply/ply_reader.hpp"
#include "tests/support/ply_writer.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::PlyWriter;

class PlyTriangles : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Ply,
                         PlyTriangles,
                         testing::Values("ascii", "binary_little_endian", "binary_big_endian"));

/// Faces over 100 vertices, of three corners but for one of `size`.
struct Faces {
  std::vector<std::uint32_t> indices, sizes;
  Faces(std::uint32_t count, std::uint32_t odd, std::uint32_t size) {
    for (std::uint32_t f = 0; f < count; ++f) {
      sizes.push_back(f == odd ? size : 3);
      for (std::uint32_t i = 0; i < sizes.back(); ++i)
        indices.push_back((f * 7 + i * i) % 100);
    }
  }
};

std::string file_of(const Faces& faces, const std::string& format, const std::string& index) {
  PlyWriter file(format);
  file.line("element vertex 100").line("property float x");
  file.line("property float y").line("property float z");
  file.line("element face " + std::to_string(faces.sizes.size()));
  file.line("property list uchar " + index + " vertex_index").line("end_header");
  for (int v = 0; v < 100; ++v)
    file.values("float", {double(v), 0, 1}).end_row();
  std::size_t at = 0;
  for (const std::uint32_t size : faces.sizes) {
    file.value("uchar", size);
    for (std::uint32_t i = 0; i < size; ++i)
      file.value(index, faces.indices[at++]);
    file.end_row();
  }
  return file.bytes();
}

TEST_P(PlyTriangles, AreReadBetweenOthers) {
  constexpr std::uint32_t kFaces = 10000;
  for (const std::uint32_t odd : {0u, 1u, 4095u, 4096u, 9000u, kFaces - 1})
    for (const std::uint32_t size : {1u, 3u, 4u})
      for (const std::string index : {"int", "uint", "ushort"}) {
        const Faces faces(kFaces, odd, size);
        const Mesh mesh = read_ply_mesh("m.ply", file_of(faces, GetParam(), index));
        EXPECT_TRUE(mesh.indices == faces.indices) << odd << ' ' << size << ' ' << index;
        EXPECT_TRUE(size == 3 ? mesh.sizes.empty() : mesh.sizes == faces.sizes)
            << odd << ' ' << size << ' ' << index;
      }
}

/// Strips of three vertices may stitch, or hold the end of one.
TEST_P(PlyTriangles, AreNoStrips) {
  PlyWriter file(GetParam());
  file.line("element vertex 3").line("property float x").line("property float y");
  file.line("property float z").line("element tristrips 3");
  file.line("property list uchar int vertex_indices").line("end_header");
  for (int v = 0; v < 3; ++v)
    file.values("float", {double(v), 0, 1}).end_row();
  for (const std::vector<double>& strip : {std::vector<double>{0, 1, 2}, {0, 0, 1}, {2, -1, 1}})
    file.value("uchar", 3).values("int", strip).end_row();
  const Mesh mesh = read_ply_mesh("m.ply", file.bytes());
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

constexpr std::uint32_t kRows = 10000;

/// A file of triangles, each a row of 13 bytes. The last index of triangle `row` is `index`.
std::string rows_with(std::uint32_t row, double index) {
  PlyWriter file("binary_little_endian");
  file.line("element vertex 3").line("property float x").line("property float y");
  file.line("property float z").line("element face " + std::to_string(kRows));
  file.line("property list uchar int vertex_index").line("end_header");
  file.values("float", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  for (std::uint32_t f = 0; f < kRows; ++f)
    file.value("uchar", 3).values("int", {0, 1, f == row ? index : 2});
  return file.bytes();
}

TEST(PlyRows, FaultsAmongThemAreFound) {
  for (const std::uint32_t row : {0u, 4095u, 4096u, kRows - 1})
    for (const double index : {3., -1.}) {
      const std::string bytes = rows_with(row, index);
      const std::size_t offset = bytes.size() - 13 * (kRows - row) + 9;
      EXPECT_EQ(test::message_of([&] { read_ply_mesh("m.ply", bytes); }),
                "m.ply:byte " + std::to_string(offset) +
                    ": error: expected the index of a vertex, 0 or more and below their number, "
                    "found " +
                    std::to_string(int(index)));
    }
}

TEST(PlyRows, MustAllBeThere) {
  const std::string bytes = rows_with(0, 2);
  for (const std::size_t missing : {1, 12, 13}) {
    const std::string cut = bytes.substr(0, bytes.size() - missing);
    EXPECT_EQ(test::message_of([&] { read_ply_mesh("m.ply", cut); }),
              "m.ply:byte " + std::to_string(cut.size()) +
                  ": error: expected row 10000 of 10000 of \"face\", found end of file");
  }
}

TEST(PlyRows, FaultsInTextAreFound) {
  for (const std::string index : {"3", "-1", "2.5", "x"})
    EXPECT_EQ(test::message_of([&] {
                read_ply_mesh(
                    "m.ply",
                    test::kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 " + index + " 1\n");
              }),
              "m.ply:14:5: error: expected the index of a vertex, 0 or more and below their "
              "number, found \"" +
                  index + '"');
}

}  // namespace
}  // namespace grelha
