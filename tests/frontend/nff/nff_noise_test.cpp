// Tests invalid content of scenes: unknown words, primitives of size zero, numbers out of range.
#include "frontend/nff/nff_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

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
using Lines = std::vector<std::string>;

TEST(NffDropped, CountedByReason) {
  const Reading r = read_with_view(
      kFill +
      "s 0 0 0 0\ns nan 0 0 1\ns 0 0 0 inf\ns 1e39 0 0 1\ns 0 0 2e18 1\nc 0 0 0 1 0 0 0 1\nc 0 0 0 "
      "0 0 0 1 0\n"
      "p 3 0 0 0 1 1 1 2 2 2\np 3 0 0 0 nan 0 0 1 1 1\npl 0 0 0 1 1 1 2 2 2\nnpl 0 0 0 1\n"
      "mesh 4 3 0 0 0 1 0 0 0 1 0 nan 0 0 1 2 3 1 2 4 1 1 2\npp 3 0 0 0 0 0 1 0 0 0 0 0 1 1 1 1 0 "
      "0 1");
  EXPECT_EQ(r.file.dropped.not_finite, 6u);
  EXPECT_EQ(r.file.dropped.zero_area, 7u) << "a mesh keeps its own";
  EXPECT_EQ(r.file.counts.s, 5u);
  EXPECT_EQ(r.file.counts.mesh, 3u);
  const Triangles& left = r.file.scene.geometry.triangles;
  EXPECT_EQ(left.size(), 2u);
  for (const float x : left.x)
    EXPECT_TRUE(std::isfinite(x));
}

TEST(NffDropped, OneWarningForTheFile) {
  const TemporaryFolder folder;
  const std::string scene =
      folder.add("scene.nff", kView + kFill + "s 0 0 0 0\ns nan 0 0 1\ns 0 0 0 0\n");
  Lines warnings;
  read_scene(scene, [&](const std::string& line) { warnings.push_back(line); });
  EXPECT_EQ(
      warnings,
      Lines{scene +
            ": warning: 3 primitives are left out: 1 not finite (or beyond 1e18), 2 without area"});
}

TEST(NffNoise, PolygonsThatCrossThemselvesAreFilledAndSaid) {
  const Reading r = read_with_view(
      kFill +
      "p 4 0 0 0 1 0 0 1 1 0 0 1 0\n  p 5 0 1.8 0 1.058 -1.456 0 -1.712 .556 0 1.712 .556 0 "
      "-1.058 -1.456 0\npp 4 0 0 0 0 0 1 1 1 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1\n");
  EXPECT_EQ(r.file.scene.geometry.triangles.size(), 2u + 5 + 2);
  EXPECT_EQ(r.file.counts.p, 2u);
  EXPECT_EQ(r.file.dropped.zero_area, 0u);
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:10:3: warning: a polygon that crosses itself; it is filled by the "
                  "even-odd rule"});
}

TEST(NffNoise, PolygonsThatFoldOverThemselvesAreSaid) {
  const Reading r = read_with_view(
      kFill + "p 7 0 0 0 4 0 0 4 2 0 3 2 0 3 2 2 1 2 2 1 2 0\np 4 0 0 0 1 0 0 1 1 .1 0 1 0\n");
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:9:1: warning: a polygon that folds over itself; what is seen along "
                  "its normal is filled"});
}

TEST(NffNoise, IsWarnedOfOnceAKindAndSkipped) {
  const Reading r = read_with_view(
      "# a comment\n/ another\nFloor of wood\n" + kFill +
      "s 0 0 0 1 7 7\ns 0 0 0 1 8\n12 12 12\n1 2 3\nxp 3\n0 0 0\na 1 2 3\na 4 5 6\ns 0 0 0 2#end");
  EXPECT_EQ(r.file.counts.s, 3u);
  EXPECT_EQ(
      r.warnings,
      (Lines{"scene.nff:9:1: warning: unknown word \"/\"; its line is skipped",
             "scene.nff:10:1: warning: unknown word \"Floor\"; its line is skipped",
             "scene.nff:12:11: warning: more numbers than \"s\" takes; the rest of the line is "
             "skipped",
             "scene.nff:14:1: warning: numbers that belong to no entity; their line is skipped",
             "scene.nff:16:1: warning: unknown word \"xp\"; its line is skipped",
             "scene.nff:18:1: warning: unknown word \"a\"; its line is skipped"}));
}

TEST(NffNoise, IsComparedWithTheWordsThereAre) {
  const Reading r = read_with_view("resoluton 3 3\nmehs 1\nsphere 0 0 0 1\n");
  EXPECT_EQ(r.warnings,
            (Lines{"scene.nff:8:1: warning: unknown word \"resoluton\" (did you mean "
                   "\"resolution\"?); its line is skipped",
                   "scene.nff:9:1: warning: unknown word \"mehs\" (did you mean \"mesh\"?); its "
                   "line is skipped",
                   "scene.nff:10:1: warning: unknown word \"sphere\"; its line is skipped"}));
}

/// A search for what was meant takes microseconds: only what is said is worth one. Was 7 s a
/// million.
TEST(NffNoise, AMillionUnknownWordsEndSoon) {
  for (const bool alike : {true, false}) {
    std::string text = kView;
    for (int i = 0; i < 1000000; ++i)
      text += alike ? "sphere 0\n" : "sphere" + std::to_string(i) + " 0\n";
    const std::clock_t start = std::clock();  // of the processor: others may be busy with it
    EXPECT_EQ(read_text(text).warnings.size(), alike ? 1u : 21u);
    constexpr double kPatience = 2;  // .2 s were measured
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, kPatience);
  }
}

TEST(NffNoise, NulBytesAreToldOf) {
  using std::string_literals::operator""s;
  const Reading r = read_with_view(kFill + "s 0 0 0\0 1\ns 0 0\0 0 1\n"s);
  EXPECT_EQ(r.file.counts.s, 2u);
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:9:8: warning: the text holds NUL bytes, which count as blanks"});
}

TEST(NffHints, SamplesAreBoundedAndSaid) {
  EXPECT_EQ(read_with_view("spp 65536").file.samples_per_pixel, 65536);
  EXPECT_EQ(read_with_view("spp 65536").warnings, Lines{});
  for (const std::string count : {"65537", "1000000000", "4000000000", "1e30"}) {
    const Reading r = read_with_view("spp " + count);
    EXPECT_EQ(r.file.samples_per_pixel, 65536) << count;
    EXPECT_EQ(r.warnings,
              Lines{"scene.nff:8:5: warning: \"" + count +
                    "\" samples per pixel are more than 65536, which are taken"});
  }
}

TEST(NffNoise, FilesOfItStayReadable) {
  std::string text = kView;
  for (int i = 0; i < 100000; ++i)
    text += "word" + std::to_string(i) + '\n';
  const Lines warnings = read_text(text).warnings;
  ASSERT_EQ(warnings.size(), 21u);
  EXPECT_EQ(warnings.back(), "scene.nff: warning: more than 20 kinds of warnings; no more follow");
}

TEST(NffNoise, ByteOrderMarkIsSkipped) {
  const Reading r = read_text("\xEF\xBB\xBF" + kView + kFill + "s 0 0 0 1");
  EXPECT_EQ(r.warnings, Lines{});
  EXPECT_EQ(r.file.counts.s, 1u);
}

}  // namespace
}  // namespace grelha
