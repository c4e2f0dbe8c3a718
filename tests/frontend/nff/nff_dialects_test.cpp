// Tests NFF dialects of other programs and of courses: C comments, Windows paths, additional
// keywords.
#include "frontend/nff/nff_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "frontend/input/read_scene.hpp"
#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::kAsciiTriangle;
using test::kFill;
using test::kView;
using test::message_of;
using test::read_with_view;
using test::Reading;
using test::TemporaryFolder;
using Lines = std::vector<std::string>;

TEST(NffDialects, CommentsOfC) {
  const Reading r = read_with_view(kFill +
                                   "/* s 9 9 9 9\n s 8 8 8 8 */ s 0 0 0 1 // a ball\n"
                                   "s 0 0 /* z */ 0 /* and\nits radius */ 2// s 7 7 7 7\n"
                                   "// s 6 6 6 6\n# /* s 1 1 1 1\ns 0 0 0 3 /**/\nl 1 2 3 // key\n"
                                   "l 4 5 6 /* no color */\nfoo 1 /* 2\n3 */ 4 5\ns 0 0 0 4");
  EXPECT_EQ(r.file.scene.geometry.spheres.radius, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(r.file.scene.lights.size(), 2u);
  EXPECT_EQ(r.warnings,
            Lines{"scene.nff:18:1: warning: unknown word \"foo\"; its line is skipped"});
}

/// Nothing closes it: no comment, or all behind it would be lost without a word.
TEST(NffDialects, CommentsEnd) {
  const Reading r = read_with_view(kFill + "/* balls\ns 0 0 0 1\ns 0 0 0 2 /\n");
  EXPECT_EQ(r.file.counts.s, 2u);
  EXPECT_EQ(r.warnings.size(), 2u);
}

TEST(NffDialects, NumbersThatAreNoneAsMicrosoftWroteThem) {
  const Reading r = read_with_view(kFill +
                                   "s 1.#IND 0 0 1\ns 0 0 -1.#QNAN00 1\ns 0 0 0 1.#INF\n"
                                   "s 0 0 0 1.#a comment\ns 0 0 0 1.#INFO of no use\n");
  EXPECT_EQ(r.file.counts.s, 5u);
  EXPECT_EQ(r.file.dropped.not_finite, 3u);
  EXPECT_EQ(r.warnings, Lines{});
}

TEST(NffDialects, MaterialIsMat) {
  for (const char* fields : {"1 .5 .2 .8 1 1 1 .2 20 0 1",
                             "1 .5 .2 .8\n1 1 1 .2\n20 0 1",
                             "1 .5 .2 .8 1 1 1 .2 20 0 1 .3",
                             "1 .5 .2 .8 1 1 1 .2 20 0 1 2 2 2"}) {
    const std::string ball = std::string(fields) + "\ns 0 0 0 1\n";
    const Reading full = read_with_view("material " + ball),
                  short_one = read_with_view("mat " + ball);
    EXPECT_EQ(full.warnings, Lines{});
    const Material &a = full.file.scene.materials.at(0), &b = short_one.file.scene.materials.at(0);
    EXPECT_EQ(a.diffuse, b.diffuse);
    EXPECT_EQ(a.specular, b.specular);
    EXPECT_EQ(a.roughness, b.roughness);
    EXPECT_EQ(a.emission, b.emission);
  }
  EXPECT_EQ(
      read_with_view("material 1 .5 .2 .8 .2 20 0 1\ns 0 0 0 1").file.scene.materials[0].diffuse,
      (Float3{.8f, .5f * .8f, .2f * .8f}));
  const Reading heading = read_with_view("material of the floor\n" + kFill + "s 0 0 0 1");
  EXPECT_EQ(heading.file.counts.materials, 1u);
  EXPECT_EQ(heading.warnings.size(), 1u);
}

TEST(NffDialects, TexturesAreLeftOut) {
  const Reading r = read_with_view(kFill +
                                   "t wood.tga\nppt 3\n-1 -1 0 0 0 1 0 0\n1 -1 0 0 0 1 1 0\n"
                                   "0 1 0 0 0 1 .5 1\npt 3\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n"
                                   "st 0 0 0 1\ns 0 0 0 2\n");
  const Triangles& t = r.file.scene.geometry.triangles;
  EXPECT_EQ(t.size(), 2u);
  EXPECT_EQ(t.x, (std::vector<float>{-1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(t.nz, (std::vector<float>{1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(r.file.counts.pp, 1u);
  EXPECT_EQ(r.file.counts.p, 1u);
  EXPECT_EQ(r.file.scene.geometry.spheres.radius, (std::vector<float>{1, 2}));
  EXPECT_EQ(r.warnings, Lines{"scene.nff:9:1: warning: texture \"wood.tga\" is left out"});
  for (const char* alone : {"st 0 0 0 1", "pt 3 0 0 0 0 0 1 0 0 1 0 0 1 0 0 1"})
    EXPECT_EQ(read_with_view(kFill + alone).warnings,
              Lines{"scene.nff:9:1: warning: textures are left out: the material is seen in their "
                    "place"});
}

/// Two quadrangles shine, one twice as much; a triangle does not; behind the last `L` none does.
TEST(NffDialects, PolygonsShine) {
  const Reading r = read_with_view(
      kFill +
      "L 1 .5 0 20 atten 0 0 1\np 4 -1 2 -1 1 2 -1 1 2 1 -1 2 1\np 3 0 0 0 1 0 0 0 1 0\n"
      "L 1 0 0 40\npp 4 0 0 0 0 0 1 2 0 0 0 0 1 2 2 0 0 0 1 0 2 0 0 0 1\n"
      "L 0 0 0 0\np 4 0 0 0 1 0 0 1 1 0 0 1 0\n");
  ASSERT_EQ(r.file.scene.lights.size(), 2u);
  EXPECT_EQ(r.file.counts.p, 2u);
  const Light& first = r.file.scene.lights[0];
  EXPECT_EQ(first.position, (Float3{0, 2, 0}));
  EXPECT_EQ(first.edge1, (Float3{2, 0, 0}));
  EXPECT_EQ(first.edge2, (Float3{0, 0, 2}));
  EXPECT_EQ(first.color, (Float3{.5f, .25f, 0}));
  EXPECT_EQ(r.file.scene.lights[1].color, (Float3{1, 0, 0}));
  EXPECT_EQ(r.file.scene.lights[1].edge2, (Float3{0, 2, 0}));
  EXPECT_EQ(r.warnings,
            (Lines{"scene.nff:10:1: warning: light does not fall off here: the brightest light of "
                   "\"L\", \"la\" and \"ls\" gets the power 1",
                   "scene.nff:11:1: warning: a polygon behind \"L\" that is no parallelogram; it "
                   "does not shine"}));
}

TEST(NffDialects, LightsOfOtherTracers) {
  const Reading r = read_with_view(kFill +
                                   "la 1 2 3  2 0 0  0 0 4  50 100 25\nla 0 0 0 1 0 0 0 1 0\n"
                                   "ls 15 1 2 3 10 20 30\nls 2 0 0 1\n"
                                   "lf 0 0 -2  0 0 -1  10 .3 .3 .3\nld .7 -.7 1 10 5 0\n"
                                   "l 1 2 3  2  .5 .25 1\n"
                                   "s 0 0 0 1\n");
  const std::vector<Light>& lights = r.file.scene.lights;
  ASSERT_EQ(lights.size(), 5u);
  EXPECT_EQ(r.file.counts.lights, 5u);
  EXPECT_EQ(lights[0].position, (Float3{2, 2, 5}));
  EXPECT_EQ(lights[0].edge1, (Float3{2, 0, 0}));
  EXPECT_EQ(lights[0].edge2, (Float3{0, 0, 4}));
  EXPECT_EQ(lights[0].color, (Float3{.5f, 1, .25f}));
  EXPECT_EQ(lights[1].color, (Float3{.01f, .01f, .01f}));
  EXPECT_EQ(lights[2].position, (Float3{1, 2, 3}));
  EXPECT_EQ(lights[2].color, (Float3{.1f, .2f, .3f}));
  EXPECT_EQ(lights[3].position, (Float3{0, 0, 1}));
  EXPECT_EQ(lights[4].color, (Float3{1, .5f, 2})) << "an intensity and a color, as in ENFF";
  EXPECT_EQ(r.warnings,
            (Lines{"scene.nff:9:1: warning: light does not fall off here: the brightest light of "
                   "\"L\", \"la\" and \"ls\" gets the power 1",
                   "scene.nff:11:1: warning: a light that is a ball is drawn as a point",
                   "scene.nff:13:1: warning: lights of \"lf\" are left out: they shine one way",
                   "scene.nff:14:1: warning: lights of \"ld\" are left out: they shine one way"}));
  EXPECT_EQ(message_of([] { read_with_view(kFill + "ls 1 2 3\ns 0 0 0 1\n"); }),
            "scene.nff:10:1: error: expected 4 or 7 numbers for the light, found \"s\"");
}

TEST(NffDialects, Sense8IsNamedWhateverFollows) {
  for (const char* text : {"nff\nversion 2.1\n",
                           "NFF   // a can\nversion 3.0\n\nCan\n3\n0 0 0\n",
                           "nff /* a can */\n// of coke\n\nversion 3.0\n",
                           "nff\nviewpos 0 0 0\n",
                           "\xEF\xBB\xBFnff\n\nCan\n3\n"})
    EXPECT_EQ(message_of([&] { test::read_text(text); }).substr(14),
              " error: expected Haines' Neutral File Format, found Sense8's (WorldToolKit) NFF")
        << text;
  EXPECT_EQ(test::read_text("nff\n" + kView).warnings.size(), 1u) << "a heading of Haines' NFF";
}

TEST(NffDialects, NamesThatWindowsWrote) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const std::string mesh = kAsciiTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n";
  fs::create_directories(folder.path() / "home" / "my meshes");
  folder.add("home/my meshes/a #1.ply", mesh);
  folder.add("home/b\\c.ply", mesh);
  folder.add("home/\"d\".ply", mesh);
  folder.add("outside.ply", mesh);
  const auto message = [&](const std::string& name) {
    const std::string scene = folder.add("home/scene.nff", kView + kFill + "ply " + name + "\n");
    return message_of([&] { read_scene(scene, nullptr); });
  };
  for (const char* name : {R"("my meshes\a #1.ply")",
                           R"('my meshes/a #1.ply'  # twice)",
                           R"("my meshes\a #1.ply" // again)",
                           R"(b\c.ply)",
                           R"("d".ply)"})
    EXPECT_EQ(message(name), "") << name;
  for (const char* name : {R"(..\outside.ply)", R"("../outside.ply")", R"("..\outside.ply")"})
    EXPECT_NE(message(name).find("--allow-outside"), std::string::npos) << name;
}

}  // namespace
}  // namespace grelha
