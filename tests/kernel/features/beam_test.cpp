// What a pixel's beam knows: whether something may hide from its samples, before any is taken.
#include "tests/support/beams.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

class Beam : public testing::TestWithParam<const Variant*> {
 protected:
  void SetUp() override {
    if (!GetParam()->runs_here())
      GTEST_SKIP() << "this processor has no " << GetParam()->name;
  }
  Tile look(const Scene& s) const { return doubt(s, *GetParam()); }
};

TEST_P(Beam, DoubtsNothingWhereThereIsNothing) {
  for (const float d : look(empty_scene()))
    EXPECT_EQ(d, 0);
  for (const float d : look(wall()))
    EXPECT_EQ(d, 0);
}

TEST_P(Beam, DoubtsOnlyThePixelWithTheSpeck) {
  Scene s = wall();
  s.geometry.spheres.add({-1.3f, 2.4f, 0}, .02f, 0);  // pixel (2, 1)
  s.lights.clear();
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 2 && y == 1 ? 2 : 0) << x << ' ' << y;
}

TEST_P(Beam, DoubtsTheOutlineOfABallAndNotItsInside) {
  Scene s = wall();
  s.lights.clear();
  s.geometry.spheres.add({0, 0, 0}, 3.6f, 0);
  const Tile tile = look(s);
  EXPECT_EQ(at(tile, 3, 3), 0);
  EXPECT_EQ(at(tile, 3, 0), 1);  // its top, y = 3.6, lies in (3, 4)
}

TEST_P(Beam, DoubtsNothingHiddenBehind) {
  Scene s = wall();
  s.geometry.spheres.add({-1.3f, 2.4f, -3}, .02f, 0);
  for (const float d : look(s))
    EXPECT_EQ(d, 0);
}

TEST_P(Beam, DoubtsWhereTheShadowOfASpeckFalls) {
  Scene s = wall();
  // Half way from the light to (-1.5, 2.5, 0), the middle of pixel (2, 1), and out of the camera's
  // sight.
  s.geometry.spheres.add({14.25f, 1.25f, 20}, .02f, 0);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 2 && y == 1 ? 2 : 0) << x << ' ' << y;
}

TEST_P(Beam, DoubtsNothingInAShadowThatOneBallCasts) {
  Scene s = wall();
  s.geometry.spheres.add({14.25f, 1.25f, 20}, 1.8f, 0);  // shadow of radius 3.6 around (-1.5, 2.5)
  const Tile tile = look(s);
  EXPECT_EQ(at(tile, 2, 1), 0);
  EXPECT_EQ(at(tile, 7, 7), 0);
  bool edge = false;
  for (const float d : tile)
    edge |= d > 0;
  EXPECT_TRUE(edge);
}

TEST_P(Beam, DoubtsWhatAMirrorShowsByItsWeight) {
  Scene s = wall();
  s.lights.clear();
  s.materials[0].diffuse = {0, 0, 0};
  s.materials[0].mirror = {.5f, .5f, .5f};
  // The ray to (-1.5, 2.5, 0), the middle of pixel (2, 1), comes back from there to 1.3 times that
  // at height 60. The eye sees that point against (-2.8, 4.6, 0), outside the picture.
  s.geometry.spheres.add({-1.95f, 3.25f, 60}, .02f, 0);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 2 && y == 1 ? 2 * .5f : 0) << x << ' ' << y;
}

/// Adds a clear sheet at height z over the whole picture.
void add_pane(Scene& s, float z, float ior) {
  Material& clear = s.materials.emplace_back();
  clear.transmission = .75f;
  clear.ior = ior;
  const auto m = static_cast<std::uint32_t>(s.materials.size() - 1);
  add_triangle(s, {-50, -50, z}, {50, -50, z}, {0, 90, z}, m);
}

TEST_P(Beam, DoubtsOnlyThePixelWithTheSpeckBehindAPane) {
  Scene s = wall();
  s.lights.clear();
  // the eye sees this at (-1.5, 2.5, 0), the middle of pixel (2, 1)
  s.geometry.spheres.add({-1.35f, 2.25f, 20}, .02f, 0);
  add_pane(s, 60, 1);
  add_pane(s, 50, 1);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 2 && y == 1 ? 2 * .5625f : 0) << x << ' ' << y;
}

TEST_P(Beam, FollowsLightThatABallBends) {
  Scene s = wall();
  s.lights.clear();
  Material& glass = s.materials.emplace_back();
  glass.transmission = 1;
  glass.ior = 1.5f;
  // it brings nearly parallel rays together at 1.5 of its radii behind its centre: before that each
  // pixel has a place of its own
  s.geometry.spheres.add({0, 0, 100}, 30, 1);
  const Tile empty = look(s);
  s.geometry.spheres.add({-.07f, .07f, 64}, .02f, 0);
  const Tile tile = look(s);
  for (const int y : {3, 4})
    for (const int x : {3, 4}) {
      EXPECT_EQ(at(empty, x, y), 0) << x << ' ' << y;
      EXPECT_EQ(at(tile, x, y) > 0, x == 3 && y == 3) << x << ' ' << y;
    }
}

TEST_P(Beam, SaysSoWhereAPaneIsOneTooMany) {
  Scene s = wall();
  s.lights.clear();
  for (int i = 0; i < 5; ++i)
    add_pane(s, 50 + static_cast<float>(i), 1);
  for (const float d : look(s))
    EXPECT_GT(d, 0);
}

TEST_P(Beam, TakesASmoothMeshForOneSurface) {
  Scene s = empty_scene();
  for (int y = -6; y < 6; ++y)  // a gently bent sheet, several triangles a pixel
    for (int x = -12; x < 12; ++x) {
      const auto p = [](int i, int j) {
        return Float3{.5f * float(i), float(j), -.01f * float(i) * float(i)};
      };
      add_triangle(s, p(x, y), p(x + 1, y), p(x + 1, y + 1));
      add_triangle(s, p(x, y), p(x + 1, y + 1), p(x, y + 1));
    }
  for (const float d : look(s))
    EXPECT_EQ(d, 0);
}

TEST_P(Beam, DoubtsASlitBetweenTrianglesOfOneSurface) {
  Scene s = empty_scene();
  const auto strip = [&](float x0, float x1) {
    add_triangle(s, {x0, -6, 0}, {x1, -6, 0}, {x1, 6, 0});
    add_triangle(s, {x0, -6, 0}, {x1, 6, 0}, {x0, 6, 0});
  };
  strip(-6, 1.6f);
  strip(1.62f, 6);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 5 ? 1 : 0) << x << ' ' << y;
}

/// A sheet over the whole picture with a square hole around the middle of pixel (2, 1); four
/// triangles over the hole rise to a tip.
Scene sheet_with_a_tip(float half, float height) {
  Scene s = empty_scene();
  const Float3 outer[4] = {{-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0}};
  const Float3 tip{-1.5f, 2.5f, height};
  Float3 inner[4];
  for (int i = 0; i < 4; ++i)
    inner[i] = {tip.x + (i == 1 || i == 2 ? half : -half), tip.y + (i >= 2 ? half : -half), 0};
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    add_triangle(s, outer[i], outer[next], inner[next]);
    add_triangle(s, outer[i], inner[next], inner[i]);
    add_triangle(s, inner[i], inner[next], tip);
  }
  return s;
}

/// What turns by more than 37 degrees within a pixel is no one surface, though it be of one mesh:
/// the tip is .2 wide, so .3 is 56 degrees and .1 is 27.
TEST_P(Beam, DoubtsASteepTipAndNotAGentleOne) {
  const Tile steep = look(sheet_with_a_tip(.2f, .3f));
  const Tile gentle = look(sheet_with_a_tip(.2f, .1f));
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(at(steep, x, y), x == 2 && y == 1 ? 1 : 0) << x << ' ' << y;
      EXPECT_EQ(at(gentle, x, y), 0) << x << ' ' << y;
    }
}

/// A ball that all corners of its pixel meet, and that bends away between them.
TEST_P(Beam, DoubtsASurfaceThatTurnsWithinAPixel) {
  Scene s = wall();
  s.lights.clear();
  s.geometry.spheres.add({-1.5f, 2.5f, 0}, .8f, 0);  // its corners are .75 from the middle
  EXPECT_EQ(at(look(s), 2, 1), 1);
}

/// An edge without a neighbour, at .7 of the way from the middle of a pixel to its side.
TEST_P(Beam, DoubtsASlitNearThePixelsEdge) {
  Scene s = empty_scene();
  const auto strip = [&](float x0, float x1) {
    add_triangle(s, {x0, -6, 0}, {x1, -6, 0}, {x1, 6, 0});
    add_triangle(s, {x0, -6, 0}, {x1, 6, 0}, {x0, 6, 0});
  };
  strip(-6, 1.5f + .37f);
  strip(1.5f + .375f, 6);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 5 ? 1 : 0) << x << ' ' << y;
}

/// A speck .015 beside pixel (2, 1), within a sixteenth of half of it.
TEST_P(Beam, DoubtsPixelsThatASpeckOnlyTouches) {
  Scene s = wall();
  s.geometry.spheres.add({-1 + .015f, 2.5f, 0}, .005f, 0);
  s.lights.clear();
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), (x == 2 || x == 3) && y == 1 ? 2 : 0) << x << ' ' << y;
}

/// The same beside the whole tile: squares are not left out before their pixels are asked.
TEST_P(Beam, AsksThePixelsBesideWhatLiesOutsideTheirSquare) {
  Scene s = wall();
  s.geometry.spheres.add({-4 - .015f, 2.5f, 0}, .005f, 0);
  s.lights.clear();
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 0 && y == 1 ? 2 : 0) << x << ' ' << y;
}

/// A speck on the last twentieth of the way from the light to the middle of pixel (2, 1), which the
/// eye sees against another pixel.
TEST_P(Beam, DoubtsWhereTheShadowOfWhatIsNearTheSurfaceFalls) {
  Scene s = wall();
  const auto on_way = [](float a, float b) { return a + .95f * (b - a); };
  s.geometry.spheres.add({on_way(30, -1.5f), on_way(0, 2.5f), on_way(40, 0)}, .02f, 0);
  EXPECT_EQ(at(look(s), 2, 1), 2);
}

/// Lights are told apart by their number modulo 64, and each by itself all the same: only the last
/// of 70 shines past the speck.
TEST_P(Beam, DoubtsTheShadowsOfSeventyLights) {
  Scene s = wall();
  const Light last = s.lights[0];
  Light behind = last;
  behind.position = {30, 0, -40};
  s.lights.assign(69, behind);
  s.lights.push_back(last);
  s.geometry.spheres.add({14.25f, 1.25f, 20}, .02f, 0);
  const Tile tile = look(s);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(at(tile, x, y), x == 2 && y == 1 ? 2 : 0) << x << ' ' << y;
}

/// Pixels side by side share corners, whatever lights they are asked about.
TEST_P(Beam, AsksEachPixelItsOwnLight) {
  Scene s = wall();
  s.lights.push_back({{-30, 0, 40}, {1, 1, 1}});
  s.geometry.spheres.add({14.25f, 1.25f, 20}, .02f, 0);   // half way from the first to (-1.5, 2.5)
  s.geometry.spheres.add({-15.25f, 1.25f, 20}, .02f, 0);  // from the second to (-.5, 2.5)
  constexpr int kLeft = 8 + 2, kRight = 8 + 3;
  PixelsAsked asked;
  for (const int i : {kLeft, kRight}) {
    asked.shadows |= std::uint64_t{1} << i;
    asked.lights[i] = i == kLeft ? 1 : 2;
  }
  const PixelDoubts found = doubts(s, *GetParam(), {}, over_units(), asked);
  EXPECT_EQ(found.boxed[kLeft], 1);
  EXPECT_EQ(found.boxed[kRight], 1);
}

TEST_P(Beam, LeavesOutMirrorsThatWeighNothing) {
  for (const float weight : {.02f, .01f}) {  // of 1 / 64 and less
    Scene s = wall();
    s.lights.clear();
    s.materials[0].diffuse = {0, 0, 0};
    s.materials[0].mirror = {weight, weight, weight};
    s.geometry.spheres.add({-1.95f, 3.25f, 60}, .02f, 0);
    EXPECT_EQ(at(look(s), 2, 1), weight > .015f ? 2 * weight : 0);
  }
}

INSTANTIATE_TEST_SUITE_P(,
                         Beam,
                         testing::ValuesIn(variants().begin(), variants().end()),
                         [](const auto& p) { return std::string(p.param->name); });

}  // namespace
}  // namespace grelha::test
