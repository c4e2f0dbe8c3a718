// Where in its pixel a beam finds what hides, and how bright that may be.
#include "tests/support/beams.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

class BeamBoxes : public EveryVariant {
 protected:
  PixelDoubts look(const Scene& s) const { return doubts(s, variant()); }
};
GRELHA_FOR_EVERY_ISA(BeamBoxes);

constexpr std::size_t index_of(int x, int y) {
  return static_cast<std::size_t>(8 * y + x);
}
/// The pixel that most scenes here are made for, around (-1.5, 2.5, 0), and a place in it.
constexpr std::size_t kPixel = index_of(2, 1);
Float3 somewhere(Random& random) {
  return {static_cast<float>(random.in(-1.9, -1.1)), static_cast<float>(random.in(2.2, 2.9)), 0};
}

Scene dark_wall() {
  Scene s = wall();
  s.lights.clear();
  return s;
}

/// A stretch of a picture's plane along x or y, in pixels from its upper left corner.
struct Stretch {
  double lo, hi;
};

/// What floats make of places in a beam, and a step of the box.
constexpr double kRounding = 1. / 256 + 1e-4;

/// Whether a box holds what of a thing lies in its pixel, and is not much larger: by its room, and
/// by a tenth of its size, on either side.
void expect_box(std::uint32_t word, const Stretch (&thing)[2], const Stretch (&loose)[2]) {
  ASSERT_NE(word, 0u);
  const PixelBox box = unpacked(word);
  const double lo[2] = {double{box.x0}, double{box.y0}};
  const double hi[2] = {double{box.x1}, double{box.y1}};
  for (int a = 0; a < 2; ++a) {
    EXPECT_LE(lo[a], std::clamp(thing[a].lo, 0., 1.) + kRounding) << a;
    EXPECT_GE(hi[a], std::clamp(thing[a].hi, 0., 1.) - kRounding) << a;
    const double room = .011 + .11 * (loose[a].hi - loose[a].lo) + kRounding;
    EXPECT_GE(lo[a], std::clamp(loose[a].lo, 0., 1.) - room) << a;
    EXPECT_LE(hi[a], std::clamp(loose[a].hi, 0., 1.) + room) << a;
  }
}

/// The stretches, in pixel (2, 1), of a disc on the wall.
void expect_disc(std::uint32_t word, const Float3& at, double radius, double loose) {
  const double x = double{at.x} + 2;
  const double y = 3 - double{at.y};
  expect_box(word,
             {{x - radius, x + radius}, {y - radius, y + radius}},
             {{x - loose, x + loose}, {y - loose, y + loose}});
}

/// Specks anywhere: each pixel that one reaches into has a box that holds it there, though one
/// corner met it alone. By their rims, less than a tenth of their radii, they need not be found.
TEST_P(BeamBoxes, HoldSpecksInEachPixelTheyReachInto) {
  Random random(1);
  int corners = 0;
  for (int i = 0; i < 1000; ++i) {
    const double radius = random.log_in(.01, .12);
    const Float3 at{
        static_cast<float>(random.in(-1.2, .2)), static_cast<float>(random.in(1.8, 3.2)), 0};
    Scene s = dark_wall();
    s.geometry.spheres.add(at, static_cast<float>(radius), 0);
    const PixelDoubts found = look(s);
    int reached = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        SCOPED_TRACE(testing::Message() << i << ": " << x << ' ' << y);
        const double in[2] = {double{at.x} + 4 - x, 4 - double{at.y} - y};
        const double away =
            std::hypot(in[0] - std::clamp(in[0], 0., 1.), in[1] - std::clamp(in[1], 0., 1.));
        const std::size_t p = index_of(x, y);
        if (away < .9 * radius) {
          ++reached;
          EXPECT_EQ(found.boxed[p], 1);
          const Stretch disc[2] = {{in[0] - radius, in[0] + radius},
                                   {in[1] - radius, in[1] + radius}};
          expect_box(found.box[p], disc, disc);
        } else if (away > 1.01 * radius + .045) {
          EXPECT_EQ(found.boxed[p], 0);
          EXPECT_EQ(found.box[p], 0u);
        }
        EXPECT_EQ(found.inside[p], 0);
      }
    corners += reached == 4;
  }
  EXPECT_GT(corners, 10);
}

TEST_P(BeamBoxes, HoldWhatAMirrorShows) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    Scene s = dark_wall();
    s.materials[0].diffuse = {0, 0, 0};
    s.materials[0].mirror = {.5f, .5f, .5f};
    const Float3 p = somewhere(random);
    const double radius = random.log_in(.005, .05);
    // where light comes back from p to 1.3 times that; the eye sees it outside the picture
    s.geometry.spheres.add({1.3f * p.x, 1.3f * p.y, 60}, static_cast<float>(radius * 1.3), 0);
    const PixelDoubts found = look(s);
    EXPECT_EQ(found.boxed[kPixel], .5f);
    expect_disc(found.box[kPixel], p, radius, radius * 1.02);
  }
}

/// A mirror that ends within the pixel, so that two of its corners see nothing: nor its middle, now
/// and then. What mirrors show is asked there all the same.
TEST_P(BeamBoxes, HoldWhatAMirrorShowsBesideItsEdge) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const Float3 p = somewhere(random);
    const double radius = random.log_in(.005, .03);
    const float edge = p.x - static_cast<float>(random.in(.04, .09));
    Scene s;
    s.materials.resize(2);
    s.materials[0].mirror = {.5f, .5f, .5f};
    add_triangle(s, {edge, -50, 0}, {edge, 50, 0}, {100, 0, 0});
    s.geometry.spheres.add({1.3f * p.x, 1.3f * p.y, 60}, static_cast<float>(radius * 1.3), 1);
    const PixelsAsked mirrors{.if_bent = ~std::uint64_t{0}};
    for (const PixelDoubts& found : {look(s), doubts(s, *GetParam(), {}, over_units(), mirrors)}) {
      EXPECT_EQ(found.boxed[kPixel], .5f);
      EXPECT_EQ(found.around[kPixel], 1);
      expect_disc(found.box[kPixel], p, radius, radius * 1.02);
    }
  }
}

/// The shadow of a ball is at most 1.3 times as long as it is wide: light falls on the wall at 51
/// degrees and more.
TEST_P(BeamBoxes, HoldShadows) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    Scene s = wall();
    const Float3 p = somewhere(random);
    const double radius = random.log_in(.005, .05);
    const Float3 light{30, 0, 40};
    s.geometry.spheres.add(at(light, .5, minus(p, light)), static_cast<float>(.5 * radius), 0);
    const PixelDoubts found = look(s);
    EXPECT_EQ(found.boxed[kPixel], 1);
    expect_disc(found.box[kPixel], p, radius, 2 * radius);
  }
}

TEST_P(BeamBoxes, AreThoseOfSpecksBesideWhatIsLarge) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    Scene s = dark_wall();
    const auto off = [&] { return static_cast<float>(random.sign() * random.in(.4, .46)); };
    const Float3 p{-1.5f + off(), 2.5f + off(), 0};
    const bool first = random.chance(.5);
    if (first)
      s.geometry.spheres.add(p, .02f, 0);
    s.geometry.spheres.add({-1.5f, 2.5f, 0}, .48f, 0);
    if (!first)
      s.geometry.spheres.add(p, .02f, 0);
    const PixelDoubts found = look(s);
    EXPECT_EQ(found.inside[kPixel], 1);
    EXPECT_EQ(found.boxed[kPixel], 1);
    expect_disc(found.box[kPixel], p, .02, .0202);
  }
}

/// Specks apart, of which one box holds some, and others not: which ones does not depend on the way
/// they were found.
TEST_P(BeamBoxes, AreTheSameForEveryGrid) {
  Random random(5);
  for (int i = 0; i < 4; ++i) {
    Scene s = dark_wall();
    for (int k = 0; k < 60; ++k)
      s.geometry.spheres.add({static_cast<float>(random.in(-4, 4)),
                              static_cast<float>(random.in(-4, 4)),
                              static_cast<float>(random.in(0, 4))},
                             static_cast<float>(random.log_in(.01, .1)),
                             0);
    const PixelDoubts want = doubts(s, *variants().front(), {.grid = false});
    for (const float density : {.5f, 4.f}) {
      const PixelDoubts got = doubts(s, variant(), {.density = density});
      for (std::size_t p = 0; p < kTile * kTile; ++p) {
        EXPECT_EQ(got.box[p], want.box[p]) << i << ": " << density << ' ' << p;
        EXPECT_EQ(got.boxed[p], want.boxed[p]) << i << ": " << density << ' ' << p;
        EXPECT_EQ(got.inside[p], want.inside[p]) << i << ": " << density << ' ' << p;
      }
    }
  }
}

/// A speck just beside the pixel is its neighbour's, and takes no box from one in it.
TEST_P(BeamBoxes, AreThoseOfSpecksInThePixel) {
  for (const bool first : {false, true})
    for (const float x : {-2.02f, -.98f}) {
      Scene s = dark_wall();
      const Float3 p{x < -1.5f ? -1.1f : -1.9f, 2.1f, 0};
      if (first)
        s.geometry.spheres.add(p, .01f, 0);
      s.geometry.spheres.add({x, 2.9f, 0}, .01f, 0);
      if (!first)
        s.geometry.spheres.add(p, .01f, 0);
      const PixelDoubts found = look(s);
      EXPECT_EQ(found.boxed[kPixel], 1);
      EXPECT_EQ(found.inside[kPixel], 0);
      expect_disc(found.box[kPixel], p, .01, .0101);
    }
}

/// What is brighter than white hides as much more, also in a mirror and where one corner meets it;
/// what is darker may hide white.
TEST_P(BeamBoxes, WeighWhatShinesByItsLight) {
  for (const float shines : {0.f, .5f, 50.f})
    for (const float mirrored : {0.f, .5f})
      for (const bool corner : {false, true}) {
        Scene s = dark_wall();
        if (mirrored > 0)
          s.materials[0].diffuse = {0, 0, 0};
        s.materials[0].mirror = {mirrored, mirrored, mirrored};
        Material& lamp = s.materials.emplace_back();
        lamp.emission = {.25f * shines, shines, 0};
        const Float3 p = corner ? Float3{-1, 3, 0} : Float3{-1.5f, 2.5f, 0};
        if (mirrored > 0)
          s.geometry.spheres.add({1.3f * p.x, 1.3f * p.y, 60}, .08f, 1);
        else
          s.geometry.spheres.add(p, .06f, 1);
        EXPECT_EQ(look(s).boxed[kPixel], std::max(shines, 1.f) * (mirrored > 0 ? mirrored : 1))
            << shines << ' ' << mirrored << ' ' << corner;
      }
}

/// Adds glass that does not bend light.
std::uint32_t add_glass(Scene& s) {
  Material& clear = s.materials.emplace_back();
  clear.transmission = 1;
  clear.ior = 1;
  return static_cast<std::uint32_t>(s.materials.size() - 1);
}

void expect_only_one(const PixelDoubts& found) {
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(found.boxed[index_of(x, y)], index_of(x, y) == kPixel ? 1 : 0) << x << ' ' << y;
}

/// Behind a pane that rises by 60 degrees, and behind the side of a ball, which light meets 73
/// degrees aslant.
TEST_P(BeamBoxes, HoldSpecksBehindSlantedGlass) {
  for (const bool ball : {false, true}) {
    SCOPED_TRACE(ball);
    Scene s = dark_wall();
    const std::uint32_t glass = add_glass(s);
    const auto on_pane = [](float x, float y) { return Float3{x, y, 100 + std::sqrt(3.f) * x}; };
    if (ball)
      s.geometry.spheres.add({28, 1.25f, 100}, 30, glass);
    else
      add_triangle(s, on_pane(-50, -50), on_pane(50, -50), on_pane(0, 90), glass);
    const Float3 p{-1.4f, 2.6f, 0};
    s.geometry.spheres.add({.9f * p.x, .9f * p.y, 20}, .018f, 0);
    const PixelDoubts found = look(s);
    expect_only_one(found);
    EXPECT_EQ(found.inside[kPixel], 0);
    expect_disc(found.box[kPixel], p, .02, .0205);
  }
}

}  // namespace
}  // namespace grelha::test
