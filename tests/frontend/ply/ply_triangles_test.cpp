// Rows of three indices.
#include <gtest/gtest.h>

#include "frontend/ply/mesh_file.hpp"
#include "tests/support/ply_writer.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::PlyWriter;

class PlyTriangles : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Ply,
                         PlyTriangles,
                         testing::Values("ascii", "binary_little_endian", "binary_big_endian"));

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
