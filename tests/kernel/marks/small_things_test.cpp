// Pixels that are looked at since something thin, or its shadow, may be there.
#include "kernel/marks/small_things.hpp"

#include "grelha/query.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kSide = 32;  ///< pixels
constexpr int kFine = 8;   ///< places of a pixel, each way

/// From z = 10 along -z; pixels are so wide a unit of way.
constexpr double kPixelAUnit = .01;
constexpr double kWidePixel = .07;  ///< 96 degrees in all
Camera small_camera(double pixel = kPixelAUnit) {
  Camera c;
  c.eye = {0, 0, 10};
  c.at = {0, 0, 0};
  c.up = {0, 1, 0};
  c.width = c.height = kSide;
  c.angle_deg = 360 / std::numbers::pi * std::atan(.5 * pixel * kSide);
  return c;
}

SmallThings small_things(const World& world, double pixel = kPixelAUnit) {
  const Setup setup = set_up(world, small_camera(pixel), {});
  TraceCounts counts;
  return SmallThings(world.impl(), setup, 2, counts);
}

/// Through the middles of kFine x kFine parts of each pixel, pixel by pixel.
RayList raster(double pixel = kPixelAUnit) {
  const FrameView f = make_frame(small_camera(pixel));
  RayList rays;
  for (int p = 0; p < kSide * kSide; ++p)
    for (int part = 0; part < kFine * kFine; ++part) {
      const double x = p % kSide + (part % kFine + .5) / kFine - .5 * kSide;
      const double y = .5 * kSide - p / kSide - (part / kFine + .5) / kFine;
      const auto along = [&](int a) {
        return static_cast<float>(double{f.forward[a]} + x * double{f.right[a]} +
                                  y * double{f.up[a]});
      };
      rays.add({f.eye[0], f.eye[1], f.eye[2]}, {along(0), along(1), along(2)});
    }
  return rays;
}

/// [pixels] parts of which something is true.
using Parts = std::vector<int>;
Parts parts_of(const std::vector<bool>& of_rays) {
  Parts parts(kSide * kSide);
  for (std::size_t i = 0; i < of_rays.size(); ++i)
    parts[i / (kFine * kFine)] += of_rays[i];
  return parts;
}

Answers closest_of(const World& world, const RayList& rays) {
  return trace(best_variant(), world, rays, {}, Query::kClosest);
}

Parts parts_seen(const World& world, const RayList& rays) {
  const Answers met = closest_of(world, rays);
  std::vector<bool> seen(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    seen[i] = met.id[i] != kNoPrimitive;
  return parts_of(seen);
}

/// A place that the camera sees, and how wide a pixel is there.
struct Spot {
  Float3 at;
  double pixel;
};
Spot spot(Random& random, double pixel) {
  const double way = random.log_in(1, 30);
  const double half = .5 * kSide * pixel * way;
  return {{static_cast<float>(random.in(-half, half)),
           static_cast<float>(random.in(-half, half)),
           static_cast<float>(10 - way)},
          pixel * way};
}

/// Adds a thing through a place, of .02 to 1.5 times `pixel`, short or long: past the eye as well.
/// Returns whether its primitives are things of their own.
bool add_thin(Scene& s, Random& random, const Float3& at_place, double pixel) {
  const double width = pixel * random.log_in(.02, 1.5);
  const auto radius = static_cast<float>(.5 * width);
  const Float3 way = random.direction();
  const double length = width * random.log_in(1, 3000);
  const Float3 a = at(at_place, random.unit() * length, way);
  const Float3 b = at(a, -length, way);
  switch (random.below(4)) {
    case 0:
      s.geometry.spheres.add(at_place, radius, 0);
      break;
    case 1:
      s.geometry.cones.add(a, radius, b, random.chance(.3) ? 0 : radius, 0);
      break;
    case 2: {
      const double sides[3] = {width, width * random.log_in(.1, 1), length};
      add_box(s, at_place, random_axes(random), sides);
      return false;
    }
    default:
      add_triangle(s, a, b, at(random.chance(.5) ? a : b, width, random.direction()));
  }
  return true;
}

int missed(const Parts& parts, const PixelMarks& marks, bool even_if_whole) {
  int n = 0;
  for (int p = 0; p < kSide * kSide; ++p) {
    const int found = parts[static_cast<std::size_t>(p)];
    n += found > 0 && (even_if_whole || found < kFine * kFine) && !marks.has(p % kSide, p / kSide);
  }
  return n;
}

/// Every pixel in which one of 64 rays meets something thin is marked.
TEST(SmallThings, AreMarkedWhereTheyAreSeen) {
  Random random(1);
  int seen = 0;
  for (const double pixel : {kPixelAUnit, kWidePixel}) {
    const RayList rays = raster(pixel);
    for (int i = 0; i < 120; ++i) {
      Scene s = empty_scene();
      const Spot where = spot(random, pixel);
      const bool alone = add_thin(s, random, where.at, where.pixel);
      const World world(s, {});
      const Parts parts = parts_seen(world, rays);
      for (const int n : parts)
        seen += n > 0;
      const SmallThings things = small_things(world, pixel);
      EXPECT_EQ(missed(parts, things.thin, true), 0) << pixel << ": " << i;
      EXPECT_EQ(things.stand_alone, alone) << pixel << ": " << i;
    }
  }
  EXPECT_GT(seen, 1000);
}

/// A tenth of a pixel beside a thing pixels are marked as well, no further: so wide are the beams
/// that look for it.
TEST(SmallThings, AreMarkedATenthBesideThem) {
  constexpr double kPixel = 10 * kPixelAUnit;
  constexpr double kRadius = .3;  // pixels
  for (const double beside : {.01, .08, .12, .3})
    for (const double side : {-1., 1.}) {
      SCOPED_TRACE(side * beside);
      const double middle = 20.5 + side * (.5 - beside - kRadius);
      Scene s = empty_scene();
      s.geometry.spheres.add({static_cast<float>((middle - .5 * kSide) * kPixel), 0, 0},
                             static_cast<float>(kRadius * kPixel),
                             0);
      const SmallThings things = small_things(World(s, {}));
      const int next = 20 + static_cast<int>(side);
      EXPECT_TRUE(things.thin.has(20, kSide / 2));
      EXPECT_EQ(things.thin.has(next, kSide / 2), beside < .1);
      EXPECT_EQ(things.small.has(next, kSide / 2), beside < .1);
    }
}

/// The parts of pixels that are dark though they face the light.
Parts parts_dark(const World& world, const RayList& rays, const Float3& light) {
  const Answers met = closest_of(world, rays);
  std::vector<bool> dark(rays.size());
  RayList to_light;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3 p = at(rays.org(i), double{met.t[i]}, rays.dir(i));
    to_light.add(light, minus(p, light), 0, .999f);
  }
  const Answers blocked = trace(best_variant(), world, to_light, {}, Query::kOccluded);
  for (std::size_t i = 0; i < rays.size(); ++i)
    dark[i] = primitive_of(world, met.id[i]).kind == PrimitiveKind::kPlane &&
              blocked.id[i] != kNoPrimitive;
  return parts_of(dark);
}

/// A wall, a light and a place on the wall that the camera sees.
struct Lit {
  Scene scene = one_plane({0, 0, 0}, {0, 0, 1});
  Float3 light, on_wall;

  explicit Lit(Random& random) {
    const auto in = [&](double half) { return static_cast<float>(random.in(-half, half)); };
    light = {in(5), in(5), 8};
    on_wall = {in(1.6), in(1.6), 0};
    scene.lights = {{light, {1, 1, 1}}};
  }
  Float3 on_way(double share) const { return at(light, share, minus(on_wall, light)); }
};

/// Wants every pixel with the edge of a shadow marked; returns how many there are.
int expect_edges_marked(const Lit& lit, const RayList& rays) {
  const World world(lit.scene, {});
  const Parts parts = parts_dark(world, rays, lit.light);
  EXPECT_EQ(missed(parts, small_things(world).shadows.at(0), false), 0);
  int edges = 0;
  for (const int n : parts)
    edges += n > 0 && n < kFine * kFine;
  return edges;
}

/// Things on the way to a place that the camera sees, on a wall that light falls on at 40 degrees
/// and more.
TEST(SmallThings, AreMarkedWhereTheirShadowsFall) {
  Random random(2);
  const RayList rays = raster();
  int edges = 0;
  for (int i = 0; i < 80; ++i) {
    SCOPED_TRACE(i);
    Lit lit(random);
    const double share = random.in(.2, .9);
    add_thin(lit.scene, random, lit.on_way(share), share * kPixelAUnit * 10);
    edges += expect_edges_marked(lit, rays);
  }
  EXPECT_GT(edges, 400);
}

/// Rods of up to 2000 pixels, to where one end's shadow is: what they are followed from is far
/// apart.
TEST(SmallThings, AreMarkedWhereShadowsOfLongRodsFall) {
  Random random(3);
  const RayList rays = raster();
  int edges = 0;
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    Lit lit(random);
    const double share = random.in(.5, .9);
    Float3 way = random.direction();
    way.z = -.01f;  // away from the light
    const Float3 a = lit.on_way(share);
    lit.scene.geometry.cones.add(a, .01f, at(a, random.log_in(20, 200), way), .01f, 0);
    edges += expect_edges_marked(lit, rays);
  }
  EXPECT_GT(edges, 300);
}

int marked(const SmallThings& things) {
  int n = 0;
  for (int p = 0; p < kSide * kSide; ++p)
    n += things.thin.has(p % kSide, p / kSide) || things.lights(p % kSide, p / kSide) != 0;
  return n;
}

/// Where all is large nothing is: neither walls and balls, nor a mesh of small triangles, nor a
/// polygon of slivers.
TEST(SmallThings, AreNotWhereAllIsLarge) {
  Scene s = one_plane({0, 0, 0}, {0, 0, 1});
  s.lights = {{{3, 3, 8}, {1, 1, 1}}};
  s.geometry.spheres.add({-.5f, .5f, 0}, .4f, 0);
  s.geometry.cones.add({.5f, -.5f, 0}, .3f, {.5f, 0, 1}, .2f, 0);
  add_triangle(s, {-1, -1, .5f}, {0, -1, .5f}, {0, 0, .5f});
  const SmallThings large = small_things(World(s, {}));
  EXPECT_EQ(marked(large), 0);
  EXPECT_FALSE(large.stand_alone);

  Scene mesh = ball_mesh(60, 30);  // 20 pixels wide, its triangles one
  mesh.lights = {{{3, 3, 8}, {1, 1, 1}}};
  const SmallThings outline = small_things(World(mesh, {}));
  EXPECT_EQ(marked(outline), 0);
  EXPECT_FALSE(outline.stand_alone);
  EXPECT_FALSE(outline.mirrored);

  Scene polygon = empty_scene();
  const auto corner = [](int k) {
    const double angle = std::numbers::pi * k / 45;
    return Float3{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
  };
  for (int k = 1; k < 89; ++k)
    add_triangle(polygon, corner(0), corner(k), corner(k + 1));
  polygon.lights = mesh.lights;
  EXPECT_EQ(marked(small_things(World(polygon, {}))), 0);
  EXPECT_FALSE(small_things(World(polygon, {})).stand_alone);
  EXPECT_FALSE(small_things(World(polygon, {})).mirrored);
}

/// What looks thin from as far as a mirror may be counts for mirrors: in front of the camera,
/// behind it, and of any kind, but no mesh.
TEST(SmallThings, CountForMirrorsAsFarAsTheseShowThem) {
  Random random(5);
  for (const float z : {0.f, 20.f})
    for (const double pixels : {.1, 1., 2.5, 5.5, 6.5, 30.}) {
      const double width = pixels * 10 * kPixelAUnit;
      const auto radius = static_cast<float>(width / 2);
      Scene ball = one_sphere({0, 0, z}, radius);
      Scene rod = one_cone({0, 0, z - radius}, radius, {0, 0, z + radius}, radius);
      Scene face = one_triangle({0, 0, z}, {0, radius, z}, {radius, 0, z});
      Scene box = empty_scene();
      const double length[3] = {width, width, width};
      add_box(box, {0, 0, z}, random_axes(random), length);
      // no wider than 2 pixels, from 3 times the way to the farthest corner
      const double least = 6, most = 6 * std::hypot(1 + radius / 10., radius / 10., radius / 10.);
      for (const Scene* s : {&ball, &rod, &face}) {
        const bool thin = small_things(World(*s, {})).mirrored;
        EXPECT_TRUE(thin || pixels >= least) << z << ' ' << pixels;
        EXPECT_FALSE(thin && s != &face && pixels > most) << z << ' ' << pixels;
      }
      EXPECT_FALSE(small_things(World(box, {})).mirrored) << pixels;
    }
}

/// A short thing in pixels that a long one before it has marked.
TEST(SmallThings, AreSmallBesideLongOnes) {
  Scene s = empty_scene();
  s.geometry.cones.add({-1, 0, 0}, .02f, {1, 0, 0}, .02f, 0);
  EXPECT_TRUE(small_things(World(s, {})).thin.has(kSide / 2, kSide / 2));
  EXPECT_FALSE(small_things(World(s, {})).small.has(kSide / 2, kSide / 2));
  s.geometry.cones.add({-.02f, 0, .1f}, .02f, {.02f, 0, .1f}, .02f, 0);
  EXPECT_TRUE(small_things(World(s, {})).small.has(kSide / 2, kSide / 2));
}

/// Shadows of more things than half the pixels may be anywhere.
TEST(SmallThings, AreManyWhereTheirShadowsMayBeAnywhere) {
  constexpr int kPixels = kSide * kSide;
  for (const int count : {kPixels / 2, kPixels / 2 + 1, 20 * kPixels}) {
    Scene s = one_plane({0, 0, 0}, {0, 0, 1});
    s.lights = {{{0, 0, 8}, {1, 1, 1}}};
    for (int i = 0; i < count; ++i)
      s.geometry.spheres.add({.001f * static_cast<float>(i % 100), 0, 4}, .01f, 0);
    const SmallThings things = small_things(World(s, {}));
    int lit_by = 0;
    for (int p = 0; p < kPixels; ++p)
      lit_by += things.lights(p % kSide, p / kSide) != 0;
    if (count > kPixels / 2)
      EXPECT_EQ(lit_by, kPixels) << count;
    else
      EXPECT_LT(lit_by, kPixels / 4) << count;
    EXPECT_GT(lit_by, 0) << count;
  }
}

struct Box {
  double x0, y0, x1, y1;

  Box(Random& random, int width, int height)
      : x0(random.in(-10, width + 2)),
        y0(random.in(-10, height + 2)),
        x1(x0 + random.in(0, 30)),
        y1(y0 + random.in(0, 30)) {}
  bool reaches(int x, int y) const { return x1 >= x && x0 < x + 1 && y1 >= y && y0 < y + 1; }
};

/// A box marks the pixels that it reaches into, whatever tiles they lie in and however much of it
/// lies outside.
TEST(PixelMarks, AreThoseThatABoxReachesInto) {
  constexpr int kWidth = 29;
  constexpr int kHeight = 21;
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const Box box(random, kWidth, kHeight);
    PixelMarks marks(kWidth, kHeight);
    marks.mark(box.x0, box.y0, box.x1, box.y1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        ASSERT_EQ(marks.has(x, y), box.reaches(x, y)) << k << ' ' << x << ' ' << y;
  }
}

/// A box has all its marks where each pixel that it reaches into has one.
TEST(PixelMarks, AreAllThereWhereNoPixelOfABoxIsLeft) {
  constexpr int kWidth = 29;
  constexpr int kHeight = 21;
  Random random(8);
  int full = 0;
  for (int k = 0; k < 2000; ++k) {
    PixelMarks marks(kWidth, kHeight);
    for (int i = 0; i < 3; ++i) {
      const Box box(random, kWidth, kHeight);
      marks.mark(box.x0, box.y0, box.x1, box.y1);
    }
    const Box box(random, kWidth, kHeight);
    bool all = true;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        all &= !box.reaches(x, y) || marks.has(x, y);
    ASSERT_EQ(marks.has_all(box.x0, box.y0, box.x1, box.y1), all) << k;
    full += all;
  }
  EXPECT_GT(full, 100);
  EXPECT_LT(full, 1900);
}

}  // namespace
}  // namespace grelha::test
