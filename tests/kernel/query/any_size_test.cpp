// Scenes whose sizes differ by 36 powers of ten, and rays through them: within what a caller may
// send each ray is told the same alone as in any company, and hits lie between its ends.
#include "grelha/grelha.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kRays = 200;

/// How numbers of a scene, or of its rays, are drawn.
class Sizes {
 public:
  explicit Sizes(Random& random) : random_(random), kind_(random.below(5)) {}

  float number() {
    const bool strange = random_.chance(.15);
    switch (kind_) {
      case 0:
        return static_cast<float>(random_.in(-1, 1));
      case 1:
        return any(18);
      case 2:
        return any(9);
      case 3:
        return strange ? any(18) : static_cast<float>(random_.in(-1, 1));
      default:
        return special();
    }
  }
  float size() { return std::abs(number()); }
  Float3 point() { return {number(), number(), number()}; }
  Float3 direction() {
    for (;;) {
      const Float3 d = point();
      const double length = std::hypot(double{d.x}, double{d.y}, double{d.z});
      if (length >= 1e-18 && length <= 1e18)
        return d;
    }
  }

 private:
  float any(double powers) {
    return static_cast<float>(random_.sign() * std::pow(10, random_.in(-powers, powers)));
  }
  float special() {
    constexpr float kValues[] = {
        0.f, -0.f, 1.f, -1.f, 1e18f, -9e17f, 1e9f, -1e5f, 1e-9f, 1e-18f, 1e-38f, 1e-45f, -1e-45f};
    return kValues[random_.below(std::size(kValues))];
  }

  Random& random_;
  const std::uint32_t kind_;
};

Scene scene_of_any_size(Random& random) {
  Scene scene = empty_scene();
  Sizes sizes(random);
  const std::uint32_t count = 1 + random.below(6);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % 2 == 0)
      scene.geometry.planes.add(sizes.point(), sizes.direction(), 0);
    scene.geometry.spheres.add(sizes.point(), sizes.number(), 0);
    scene.geometry.cones.add(sizes.point(), sizes.size(), sizes.point(), sizes.size(), 0);
    add_triangle(scene, sizes.point(), sizes.point(), sizes.point());
  }
  return scene;
}

std::vector<Ray> rays_of_any_size(Random& random) {
  Sizes sizes(random);
  std::vector<Ray> rays(kRays);
  for (Ray& ray : rays) {
    ray.org = sizes.point();
    ray.dir = random.chance(.3) ? sizes.direction() : random.direction();
    if (random.chance(.5))
      ray.t_min = sizes.size();
    if (random.chance(.3))
      ray.t_max = sizes.size();
  }
  return rays;
}

bool same(const Hit& a, const Hit& b) {
  return a.id == b.id && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t);
}

void expect_one_answer(const World& world, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(kRays);
  std::vector<Hit> by_sixteen(kRays);
  std::vector<std::uint8_t> blocked(kRays);
  closest(world, rays, hits);
  closest(world, rays, by_sixteen, {.packet = 16});
  occluded(world, rays, blocked);
  for (std::size_t i = 0; i < kRays; ++i) {
    const Ray& r = rays[i];
    SCOPED_TRACE(testing::Message() << r.org.x << " " << r.org.y << " " << r.org.z << " towards "
                                    << r.dir.x << " " << r.dir.y << " " << r.dir.z << ", t from "
                                    << r.t_min << " to " << r.t_max << ": " << hits[i].t);
    ASSERT_TRUE(same(closest(world, r), hits[i]));
    ASSERT_TRUE(same(by_sixteen[i], hits[i]));
    ASSERT_EQ(blocked[i] != 0, bool(hits[i]));
    ASSERT_EQ(occluded(world, r), bool(hits[i]));
    if (hits[i]) {
      const bool is_room = std::nextafter(r.t_min, kInf) < r.t_max;
      ASSERT_TRUE(hits[i].t > r.t_min || !is_room);
      ASSERT_LT(hits[i].t, r.t_max);
    } else {
      ASSERT_EQ(hits[i].t, r.t_max);
    }
  }
}

TEST(AnySize, RaysAreToldTheSameAloneAndTogether) {
  Random random(1);
  for (int k = 0; k < 1000; ++k) {
    const Scene scene = scene_of_any_size(random);
    const World world(scene, {.threads = 1});
    expect_one_answer(world, rays_of_any_size(random));
    if (HasFatalFailure())
      return;
  }
}

/// A scene, and the same a power of two times as large.
struct Scaled {
  Scene scene = empty_scene();
  void add(Random& random, float by) {
    const auto number = [&](double lo, double hi) {
      return by * static_cast<float>(random.in(lo, hi));
    };
    const auto point = [&] { return Float3{number(-1, 1), number(-1, 1), number(-1, 1)}; };
    const Float3 a = point();
    scene.geometry.spheres.add(a, number(.05, .15), 0);
    const float base = number(.05, .15);
    const Float3 apex = point();
    scene.geometry.cones.add(a, base, apex, number(0, .1), 0);
    const Float3 b = point();
    add_triangle(scene, a, b, point());
  }
};

// Squares of such sizes leave the range of floats.
TEST(AnySize, HitsOfSmallScenesAreThoseOfLargerOnes) {
  for (int power = -58; power >= -108; power -= 1) {
    const float by = std::ldexp(1.f, power);
    Scaled small, large;
    Random one(5), other(5);
    for (int i = 0; i < 60; ++i) {
      small.add(one, by);
      large.add(other, 1);
    }
    const World world(small.scene, {});
    const World truth(large.scene, {});
    Random random(7);
    int hits = 0;
    for (int i = 0; i < 600; ++i) {
      const Float3 p = random.point(3);
      const Float3 d = random.chance(.5) ? random.direction() : minus(random.point(1), p);
      const Hit found = closest(world, {{by * p.x, by * p.y, by * p.z}, d});
      const Hit expected = closest(truth, {p, d});
      hits += bool(expected);
      ASSERT_EQ(found.id, expected.id) << power << ", ray " << i;
      ASSERT_EQ(found.t, expected ? by * expected.t : kInf) << power << ", ray " << i;
    }
    EXPECT_GT(hits, 100);
  }
}

TEST(AnySize, ScenesThatAreTooSmallAreRefused) {
  Scene tiny = empty_scene();
  add_triangle(tiny, {0, 0, 0}, {1e-36f, 0, 0}, {0, 1e-36f, 0});
  EXPECT_THROW(World(tiny, {}), std::invalid_argument);
  EXPECT_THROW(World::estimate(tiny, {}), std::invalid_argument);
  add_triangle(tiny, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const World world(tiny, {});
  EXPECT_EQ(closest(world, {{0, 0, 1}, {0, 0, -1}}).id, 0u);
}

// A sliver 1e12 times as long as wide, seen from beside it: t of double says that it lies ahead,
// its normal that it lies behind.
TEST(AnySize, ASliverThatLiesBehindIsNotMetInCompany) {
  Scene scene = empty_scene();
  add_triangle(scene,
               {0.598012447f, 0.921534836f, 0.92414248f},
               {8.9999999e+11f, 0.875056505f, 0.389583707f},
               {-0.485225707f, -0.249398977f, 0.48641026f});
  const World world(scene, {});
  const Ray beside{.org = {1e9f, 0.0214590598f, 0.600406528f},
                   .dir = {0.859199524f, 0.429385185f, -0.580328882f},
                   .t_min = 0.593969524f};
  Ray elsewhere = beside;
  elsewhere.t_min = 0;
  for (const std::size_t place : {0, 1, 7, 8, 15}) {
    std::vector<Ray> rays(16, elsewhere);
    rays[place] = beside;
    std::vector<Hit> hits(16);
    closest(world, rays, hits, {.packet = 16});
    EXPECT_FALSE(hits[place]) << place << ": " << hits[place].t;
  }
  EXPECT_FALSE(closest(world, beside));
}

// A floor right before the ray, and a ball 1e8 times as far, to which rays from afar are brought.
TEST(AnySize, APlaneInFrontOfWhatIsFarAwayIsMetWhereItIs) {
  Scene floor = empty_scene();
  floor.geometry.planes.add({0, -1, 0}, {0, 1, 0}, 0);
  Scene mask_and = floor;
  mask_and.geometry.spheres.add({3e8f, 0, 0}, 1, 0);
  const World alone(floor, {});
  const World world(mask_and, {});
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i)
    rays.push_back(
        {.org = random.point(.5), .dir = {1, static_cast<float>(random.in(-1, -.01)), 0}});
  std::vector<Hit> hits(rays.size());
  closest(world, rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit truth = closest(alone, rays[i]);
    ASSERT_TRUE(same(hits[i], truth)) << hits[i].t << " not " << truth.t;
    ASSERT_TRUE(same(closest(world, rays[i]), truth));
  }
}

}  // namespace
}  // namespace grelha::test
