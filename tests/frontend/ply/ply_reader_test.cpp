#include "frontend/ply/mesh_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <tuple>

#include "frontend/files/load_progress.hpp"
#include "tests/support/ply_writer.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::PlyWriter;

const std::string kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
const std::string kIntegers[] = {"char",
                                 "int8",
                                 "uchar",
                                 "uint8",
                                 "short",
                                 "int16",
                                 "ushort",
                                 "uint16",
                                 "int",
                                 "int32",
                                 "uint",
                                 "uint32"};

class EveryType : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(EveryType, AsCoordinateAndAsSomethingToStepOver) {
  const auto& [format, type] = GetParam();
  PlyWriter w(format);
  w.line("element vertex 3").line("property " + type + " skipped").line("property " + type + " z");
  w.line("property " + type + " x").line("property double also").line("property " + type + " y");
  w.line("element face 1")
      .line("property " + type + " flag")
      .line("property list uchar int vertex_indices");
  w.line("property list int " + type + " more").line("end_header");
  for (const double v : {1.0, 5.0, 9.0})
    w.value(type, 77)
        .value(type, v)
        .value(type, v + 1)
        .value("double", .5)
        .value(type, v + 2)
        .end_row();
  w.value(type, 1)
      .value("uchar", 3)
      .values("int", {2, 0, 1})
      .value("int", 2)
      .values(type, {7, 8})
      .end_row();
  const Mesh mesh = read_ply_mesh("m.ply", w.bytes());
  EXPECT_EQ(mesh.z, (std::vector<float>{1, 5, 9}));
  EXPECT_EQ(mesh.x, (std::vector<float>{2, 6, 10}));
  EXPECT_EQ(mesh.y, (std::vector<float>{3, 7, 11}));
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{2, 0, 1}));
}
INSTANTIATE_TEST_SUITE_P(Ply,
                         EveryType,
                         testing::Combine(testing::ValuesIn(kFormats),
                                          testing::Values("char",
                                                          "int8",
                                                          "uchar",
                                                          "uint8",
                                                          "short",
                                                          "int16",
                                                          "ushort",
                                                          "uint16",
                                                          "int",
                                                          "int32",
                                                          "uint",
                                                          "uint32",
                                                          "float",
                                                          "float32",
                                                          "double",
                                                          "float64")));

class EveryIndexType
    : public testing::TestWithParam<std::tuple<std::string, std::string, std::string>> {};

TEST_P(EveryIndexType, InFacesOfAnySize) {
  const auto& [format, count, item] = GetParam();
  PlyWriter w(format);
  w.line("comment faces first")
      .line("element face 4")
      .line("property list " + count + ' ' + item + " vertex_index");
  w.line("element vertex 5")
      .line("property float x")
      .line("property float y")
      .line("property float z")
      .line("end_header");
  w.value(count, 3).values(item, {0, 1, 2}).end_row();
  w.value(count, 5).values(item, {0, 1, 2, 3, 4}).end_row();
  w.value(count, 2).values(item, {0, 1}).end_row();
  w.value(count, 0).end_row();
  for (int i = 0; i < 5; ++i)
    w.values("float", {double(i), double(i * i), 0}).end_row();
  const Mesh mesh = read_ply_mesh("m.ply", w.bytes());
  EXPECT_EQ(mesh.face_count(), 4u);
  EXPECT_EQ(mesh.sizes, (std::vector<std::uint32_t>{3, 5, 2, 0}));
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2, 3, 4, 0, 1}));
  EXPECT_EQ(mesh.y[4], 16);
}
INSTANTIATE_TEST_SUITE_P(Ply,
                         EveryIndexType,
                         testing::Combine(testing::ValuesIn(kFormats),
                                          testing::ValuesIn(kIntegers),
                                          testing::ValuesIn(kIntegers)));

class EveryFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Ply, EveryFormat, testing::ValuesIn(kFormats));

PlyWriter& vertex_header(PlyWriter& w, int count) {
  return w.line("element vertex " + std::to_string(count))
      .line("property float x")
      .line("property float y")
      .line("property float z");
}

TEST_P(EveryFormat, StripsTurnEverySecondTriangle) {
  PlyWriter w(GetParam());
  vertex_header(w, 6)
      .line("element tristrips 1")
      .line("property list int int vertex_indices")
      .line("end_header");
  for (int i = 0; i < 6; ++i)
    w.values("float", {double(i), double(i % 2), 0}).end_row();
  const std::vector<double> strip{0, 1, 2, 3, -1, 2, 3, 3, 4, 5, -1, 1};
  w.value("int", double(strip.size())).values("int", strip).end_row();
  const Mesh mesh = read_ply_mesh("m.ply", w.bytes());
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 3, 4, 5}));
  EXPECT_EQ(mesh.face_count(), 3u);  // 2 3 3 and 3 3 4 only stitch
}

TEST_P(EveryFormat, OtherElementsAndNormals) {
  PlyWriter w(GetParam());
  w.line("obj_info made up")
      .line("comment")
      .line("element camera 1")
      .line("property float view_px")
      .line("property list uchar short k");
  w.line("element nothing 1000000").line("");
  w.line("  element\tvertex   3 ")
      .line("property float nx")
      .line("property float ny")
      .line("property float nz");
  w.line("comment between")
      .line("property double x")
      .line("property double y")
      .line("property double z");
  w.line("element material 2")
      .line("property uchar r")
      .line("element face 1")
      .line("property list uchar uint vertex_indices")
      .line("end_header");
  w.value("float", 1).value("uchar", 2).values("short", {4, 5}).end_row();
  for (int i = 0; i < 3; ++i)
    w.values("float", {0, 0, i + 1.0}).values("double", {i + .5, i * i + .25, 0}).end_row();
  w.value("uchar", 1).end_row().value("uchar", 2).end_row();
  w.value("uchar", 3).values("uint", {0, 1, 2}).end_row();
  const Mesh mesh = read_ply_mesh("m.ply", w.bytes() + "trailing bytes 1 2 3");
  EXPECT_EQ(mesh.nz, (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(mesh.x, (std::vector<float>{.5f, 1.5f, 2.5f}));
  EXPECT_EQ(mesh.face_count(), 1u);
}

TEST_P(EveryFormat, NoVerticesNoFaces) {
  PlyWriter w(GetParam());
  vertex_header(w, 0)
      .line("element face 0")
      .line("property list uchar int vertex_indices")
      .line("end_header");
  EXPECT_EQ(read_ply_mesh("m.ply", w.bytes()).face_count(), 0u);
  PlyWriter cloud(GetParam());
  vertex_header(cloud, 1).line("end_header").values("float", {1, 2, 3});
  EXPECT_EQ(read_ply_mesh("m.ply", cloud.bytes()).vertex_count(), 1u);
  PlyWriter none(GetParam());
  none.line("end_header");
  EXPECT_EQ(read_ply_mesh("m.ply", none.bytes()).vertex_count(), 0u);
}

/// One uchar coordinate a row, whose first byte is a line end itself.
class EveryLineEnd : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(EveryLineEnd, LeavesTheFirstDataByte) {
  const auto& [end, first] = GetParam();
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty uchar x\nproperty uchar "
      "y\nproperty uchar "
      "z\nend_header\n";
  std::string file;
  for (const char c : text)
    c == '\n' ? file += end : file += c;
  file += char(first);
  file += "\x0A\x0D";
  const Mesh mesh = read_ply_mesh("m.ply", file);
  EXPECT_EQ(mesh.x, std::vector<float>{float(first)});
  EXPECT_EQ(mesh.y, std::vector<float>{10});
  EXPECT_EQ(mesh.z, std::vector<float>{13});
}
INSTANTIATE_TEST_SUITE_P(Ply,
                         EveryLineEnd,
                         testing::Combine(testing::Values("\n", "\r\n", "\r"),
                                          testing::Values(10, 13, 65)));

using test::kAsciiTriangle;
using Lines = std::vector<std::string>;

/// Returns the warnings of reading a file.
Lines warnings_of(const std::string& bytes) {
  Lines lines;
  EXPECT_EQ(read_ply_mesh("m.ply", bytes, [&](const std::string& line) { lines.push_back(line); })
                .face_count(),
            2u);
  return lines;
}

/// A comment that an exporter broke, and words of its own: each kind once, and the mesh is read.
TEST(PlyHeader, StrayLinesAreSkipped) {
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n",
                    header = kAsciiTriangle.substr(4);
  EXPECT_EQ(warnings_of(kAsciiTriangle + rows), Lines{});
  EXPECT_EQ(
      warnings_of("ply\nmade by hand\n" + header + rows),
      Lines{"m.ply:2:1: warning: no line of a PLY header begins with \"made\"; it is skipped"});
  const std::string stray = "  going on, \xC3\xA0 la carte\nvertices 3\nvertices 3\n";
  EXPECT_EQ(
      warnings_of("ply\n" + header.substr(0, 17) + stray + header.substr(17) + rows),
      (Lines{
          "m.ply:3:3: warning: no line of a PLY header begins with \"going\"; it is skipped",
          "m.ply:4:1: warning: no line of a PLY header begins with \"vertices\"; it is skipped"}));
}

TEST(PlyHeader, NulBytesAreToldOf) {
  using std::string_literals::operator""s;
  EXPECT_EQ(warnings_of(kAsciiTriangle + "0 0 0\n1\0 0 0\n0 1\0 0\n3 0 1 2\n3 2 1 0\n"s),
            Lines{"m.ply:11:2: warning: the text holds NUL bytes, which count as blanks"});
  PlyWriter w("binary_little_endian");
  vertex_header(w, 1)
      .line("element face 2")
      .line("property list uchar int vertex_indices")
      .line("end_header");
  w.values("float", {0, 0, 0}).value("uchar", 0).value("uchar", 0);
  EXPECT_EQ(warnings_of(w.bytes()), Lines{}) << "binary data are no text";
}

/// 200,000 elements: each was compared with all before it, which took minutes.
TEST(PlyHeader, ManyElementsEndSoon) {
  std::string text = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 200000; ++i)
    text += "element e" + std::to_string(i) + " 0\n";
  const std::clock_t start = std::clock();  // of the processor: others may be busy with it
  EXPECT_EQ(read_ply_mesh("m.ply", text + "end_header\n").face_count(), 0u);
  constexpr double kPatience = 5;  // .1 s were measured
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, kPatience);
}

/// Whoever waits for a header, or for one long list, can stop it.
TEST(PlyReader, AsksWhetherToGoOn) {
  std::string header = "ply\nformat ascii 1.0\n";
  while (header.size() < (3u << 20))
    header += "comment again and again\n";
  std::string list = kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n2000000";
  for (int i = 0; i < 2000000; ++i)
    list += " 0";
  for (const std::string& text : {header + "end_header\n", list + "\n0\n"}) {
    int asked = 0;
    const std::function<bool(double)> report = [&](double) { return ++asked < 2; };
    LoadProgress progress(report);
    progress.expect(double(text.size()));
    EXPECT_THROW(read_ply_mesh("m.ply", text, {}, &progress), Stopped);
    EXPECT_EQ(asked, 2);
  }
}

TEST(PlyAscii, RowsMayBreakAndJoin) {
  const std::vector<std::uint32_t> expected{0, 1, 2, 2, 1, 0};
  for (const char* rows : {"0 0 0\n1 0\n0\n0\n1 0\n3 0 1\n2\n3 2 1 0",
                           "0 0 0 1 0 0 0 1 0 3 0 1 2 3 2 1 0\n",
                           "0 0 0 1 0 0\r\n0 1 0\r\n\r\n3 0 1 2 3 2 1 0",
                           "000 0 0\r1 0 0\r0 1 0\r3 0 1 2\r3 2 1 0\rtail"}) {
    const Mesh mesh = read_ply_mesh("m.ply", kAsciiTriangle + rows);
    EXPECT_EQ(mesh.indices, expected) << rows;
    EXPECT_EQ(mesh.x, (std::vector<float>{0, 1, 0})) << rows;
  }
}

TEST(PlyAscii, RowsTooLongAreCut) {
  const Mesh mesh = read_ply_mesh(
      "m.ply", kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 .5 .5 .5 .5\n3 2 1 0 6 1 1 1 1\n");
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 0}));
}

}  // namespace
}  // namespace grelha
