// Where lamps out of focus may show.
#include "kernel/marks/glows.hpp"

#include "kernel/scene/frame.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kSide = 32;  ///< pixels
constexpr double kFocus = 10;

Camera camera_with_lens(float aperture) {
  Camera c;
  c.eye = {0, 0, 0};
  c.at = {0, 0, -1};
  c.up = {0, 1, 0};
  c.width = c.height = kSide;
  c.angle_deg = 40;
  c.aperture = aperture;
  c.focus = kFocus;
  return c;
}

/// From a place of the lens through one of the picture, as frame.hpp says.
struct LensRay {
  double x, y;  ///< pixels
  Float3 org, dir;
};
LensRay lens_ray(const FrameView& f, Random& random) {
  LensRay r{random.in(0, kSide), random.in(0, kSide), {}, {}};
  double u[2];
  do {
    u[0] = random.in(-1, 1);
    u[1] = random.in(-1, 1);
  } while (u[0] * u[0] + u[1] * u[1] > 1);
  float org[3], dir[3];
  for (int a = 0; a < 3; ++a) {
    const double on_lens = u[0] * double{f.lens_right[a]} + u[1] * double{f.lens_up[a]};
    const double through = double{f.forward[a]} + (r.x - .5 * kSide) * double{f.right[a]} +
                           (.5 * kSide - r.y) * double{f.up[a]};
    org[a] = static_cast<float>(double{f.eye[a]} + on_lens);
    dir[a] = static_cast<float>(double{f.focus} * through - on_lens);
  }
  r.org = {org[0], org[1], org[2]};
  r.dir = {dir[0], dir[1], dir[2]};
  return r;
}

/// Adds a lamp of a kind around a place.
void add_lamp(Scene& s, Random& random, const Float3& at_place, double size) {
  const auto radius = static_cast<float>(size);
  const Float3 end = at(at_place, size * random.log_in(.1, 20), random.direction());
  switch (random.below(3)) {
    case 0:
      s.geometry.spheres.add(at_place, radius, 0);
      break;
    case 1:
      s.geometry.cones.add(at_place, radius, end, radius, 0);
      break;
    default:
      add_triangle(s, at_place, end, at(at_place, size, random.direction()));
  }
}

/// Every ray of the lens that meets a lamp belongs to a pixel that knows how bright it is.
TEST(Glows, AreMarkedWhereALensSpreadsLamps) {
  Random random(1);
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const Camera camera = camera_with_lens(static_cast<float>(random.log_in(1, 3)));
    const FrameView f = make_frame(camera);
    const double way = random.chance(.5) ? random.in(3, 7) : random.in(14, 40);
    const double half = .3 * way;
    const auto bright = static_cast<float>(random.log_in(1.01, 300));
    Scene s;
    s.materials.resize(1);
    s.materials[0].emission = {.5f, bright, .2f};
    const Float3 place{static_cast<float>(random.in(-half, half)),
                       static_cast<float>(random.in(-half, half)),
                       static_cast<float>(-way)};
    add_lamp(s, random, place, random.log_in(.02, .15));
    const World world(s, {});
    const Glows glows(world.impl(), set_up(world, camera, {}), 0);
    RayList rays;
    std::vector<LensRay> of;
    for (int k = 0; k < 20000; ++k) {
      of.push_back(lens_ray(f, random));
      rays.add(of.back().org, of.back().dir);
    }
    const Answers answers = trace(best_variant(), world, rays, {}, Query::kClosest);
    int lost = 0;
    for (std::size_t k = 0; k < rays.size(); ++k)
      if (answers.id[k] != kNoPrimitive) {
        const float told = glows.brightest(static_cast<int>(of[k].x), static_cast<int>(of[k].y));
        lost += told < bright || told > 2 * bright;
        ++met;
      }
    EXPECT_EQ(lost, 0);
  }
  EXPECT_GT(met, 2000);
}

int marked(const Scene& s, const Camera& camera, double least) {
  const World world(s, {});
  const Glows glows(world.impl(), set_up(world, camera, {}), least);
  int n = 0;
  for (int p = 0; p < kSide * kSide; ++p)
    n += glows.brightest(p % kSide, p / kSide) > 0;
  return n;
}

/// What is dim, in focus or spread too thin is none; nor is anything without a lens.
TEST(Glows, AreOnlyThoseThatMatter) {
  Scene s;
  s.materials.resize(1);
  s.materials[0].emission = {10, 10, 10};
  s.geometry.spheres.add({0, 0, -20}, .05f, 0);
  const Camera camera = camera_with_lens(1);
  EXPECT_GT(marked(s, camera, 0), 10);
  // .05 of a lens that is .5 wide at the lamp, seen from half as far, is a hundredth of its area
  EXPECT_GT(marked(s, camera, .09), 10);
  EXPECT_EQ(marked(s, camera, .11), 0);
  EXPECT_EQ(marked(s, camera_with_lens(0), 0), 0);
  Scene dim = s;
  dim.materials[0].emission = {1, 1, 1};
  EXPECT_EQ(marked(dim, camera, 0), 0);
  Scene sharp = s;
  sharp.geometry = {};
  sharp.geometry.spheres.add({0, 0, -10}, .05f, 0);
  EXPECT_EQ(marked(sharp, camera, 0), 0);
}

}  // namespace
}  // namespace grelha::test
