// Tests the warning for pictures that show nothing, and that no other picture gets it.
#include "frontend/commands/nothing_seen.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/reading.hpp"

namespace grelha {
namespace {

using test::read_text;
using Lines = std::vector<std::string>;

// From z = 5 down on the origin, 8 x 6 pixels: at distance d the view reaches .414 d up and .552 d
// to the right.
const std::string kEye = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 6\n";
const std::string kLit = kEye + "l 0 0 9 1 1 1\nf 1 1 1 1 0 1 0 1\n";

Lines said(const std::string& text, double aperture = 0, int width = 8) {
  SceneFile file = read_text(text).file;
  file.camera.aperture = aperture;
  file.camera.width = width;
  Lines lines;
  warn_empty_image(
      "x.nff", file, file.camera, [&](const std::string& line) { lines.push_back(line); });
  return lines;
}

const Lines kBehind{
    "x.nff: warning: everything lies behind the eye: exchange \"from\" and \"at\", or turn the "
    "view round"};

TEST(NothingSeen, OfWhatIsSeenNothingIsSaid) {
  EXPECT_EQ(said(kLit + "s 0 0 0 1"), Lines{});
  EXPECT_EQ(said(kLit + "s 0 0 8 1\ns 2 0 0 1"), Lines{}) << "one behind, one in view";
  EXPECT_EQ(said(kLit + "s 0 0 6 1.1"), Lines{}) << "around the eye";
  EXPECT_EQ(said(kLit + "p 3 -100 -100 -9  100 -100 -9  0 200 -9"), Lines{})
      << "no corner is in view, the middle is";
  EXPECT_EQ(said(kLit + "c 0 -90 0 1 0 90 0 1"), Lines{});
  EXPECT_EQ(said(kLit + "pl 0 0 0 1 0 0 0 1 0"), Lines{});
  EXPECT_EQ(said(kLit + "pl 0 -1 0 1 -1 0 0 -1 -1"), Lines{}) << "edge on, and met further down";
}

TEST(NothingSeen, NoPrimitives) {
  EXPECT_EQ(said(kLit),
            Lines{"x.nff: warning: nothing to draw: add an object, such as \"s 0 0 0 1\""});
  SceneFile cloud = read_text(kLit).file;
  cloud.points = 3;
  Lines lines;
  warn_empty_image(
      "x.ply", cloud, cloud.camera, [&](const std::string& line) { lines.push_back(line); });
  EXPECT_EQ(lines,
            Lines{"x.ply: warning: 3 points have no faces and will not be drawn: make a mesh of "
                  "them, or spheres"});
}

TEST(NothingSeen, NoLight) {
  const Lines dark{
      "x.nff: warning: no light: surfaces will show no color of their own; add one, such as \"l 0 "
      "0 5\""};
  EXPECT_EQ(said(kEye + "s 0 0 0 1"), dark);
  EXPECT_EQ(said(kEye + "l 0 0 9 0 0 0\ns 0 0 0 1"), dark) << "a black light is none";
  const std::string emission = "f 1 1 1 1 1 1 1 0 1 0 1 .5 0 0\n", dull = "f 1 1 1 1 0 1 0 1\n";
  EXPECT_EQ(said(kEye + emission + "s 0 0 0 1"), Lines{});
  EXPECT_EQ(said(kEye + emission + dull + "s 0 0 0 1"), dark) << "what shines is on nothing";
}

TEST(NothingSeen, BehindTheEye) {
  EXPECT_EQ(said(kLit + "s 0 0 7 1\np 3 0 0 6 1 0 6 0 1 6\nc 0 0 8 1 0 0 9 1"), kBehind);
  EXPECT_EQ(said(kLit + "s 0 0 7 1", .1), kBehind) << "with a lens too";
  EXPECT_NE(said(kLit + "s 0 0 7 1\ns 90 0 0 1"), kBehind) << "some is only beside";
}

TEST(NothingSeen, OutsideTheView) {
  const Lines right{
      "x.nff: warning: everything lies outside the view: widen \"angle\", or look \"at 7 0 0\", "
      "the middle of the scene"};
  EXPECT_EQ(said(kLit + "s 7 0 0 1"), right);
  EXPECT_EQ(said(kLit + "s 7 0 0 1", .1), Lines{}) << "a lens sees round the edge";
  EXPECT_EQ(said(kLit + "s 7 0 0 1", 0, 24), Lines{}) << "a wider picture has it";
  EXPECT_EQ(said(kLit + "p 3 6 0 0 8 0 0 7 0 0.001"),
            Lines{"x.nff: warning: everything lies outside the view: widen \"angle\", or look \"at "
                  "7 0 0.0005\", the middle of the scene"});
  EXPECT_EQ(said(kLit + "s 0 9 0 1\ns 0 -9 0 1\ns -9 0 0 1\nc 9 0 0 1 12 0 0 1").size(), 1u)
      << "all around it";
  EXPECT_EQ(said(kLit + "pl 0 0 9 1 0 9 0 1 9"),
            Lines{"x.nff: warning: everything lies outside the view: widen \"angle\""})
      << "a plane behind";
}

/// The distances from a ball's centre to the four sides of the view tell if the ball is visible.
/// There must be no warning for a visible ball.
TEST(NothingSeen, AgreesWithGeometry) {
  const double tan_y = std::tan(22.5 * 3.14159265358979 / 180), tan_x = tan_y * 8 / 6;
  int outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = (i * 7919 % 2001 - 1000) / 100., y = (i * 104729 % 2003 - 1001) / 100.,
                 z = -(i % 97) / 10.;
    const double r = .01 + (i % 13) / 10., d = 5 - z;
    const double beyond_x = (std::abs(x) - d * tan_x) / std::sqrt(1 + tan_x * tan_x);
    const double beyond_y = (std::abs(y) - d * tan_y) / std::sqrt(1 + tan_y * tan_y);
    if (std::abs(beyond_x - r) < 1e-5 || std::abs(beyond_y - r) < 1e-5)
      continue;
    const bool expected = beyond_x > r || beyond_y > r;
    SceneFile file = read_text(kLit).file;
    file.scene.geometry.spheres.add({float(x), float(y), float(z)}, float(r), 0);
    bool found = false;
    warn_empty_image("x", file, file.camera, [&](const std::string&) { found = true; });
    ASSERT_EQ(found, expected) << x << ' ' << y << ' ' << z << ' ' << r;
    outside += expected;
  }
  EXPECT_GT(outside, 1000);
  EXPECT_LT(outside, 19000);
}

}  // namespace
}  // namespace grelha
