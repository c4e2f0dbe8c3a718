// The camera's frame and the rays through pixel centres, against long double.
#define GRELHA_ISA scalar
#include "kernel/shade/strip.hpp"

#include <memory>
#include <numbers>

#include "kernel/scene/shading_view.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using oracle::V;

struct Frame {
  V forward, right, up;  ///< right and up one pixel long at distance 1
  explicit Frame(const Camera& c)
      : forward(oracle::unit(V(c.at) - V(c.eye))), right(forward), up(forward) {
    const oracle::Real pixel =
        2 * std::tan(c.angle_deg * std::numbers::pi_v<oracle::Real> / 360) / c.height;
    right = oracle::unit(cross(forward, V(c.up)));
    up = pixel * cross(right, forward);
    right = pixel * right;
  }
  V through(const Camera& c, int x, int y) const {
    return oracle::unit(forward + (x + .5L - .5L * c.width) * right +
                        (.5L * c.height - (y + .5L)) * up);
  }
};

Camera random_camera(Random& random) {
  Camera c;
  const double size = random.log_in(1e-3, 1e3);
  c.eye = random.point(size);
  c.at = at(c.eye, size * random.log_in(.1, 10), random.direction());
  c.up = scaled(random.direction(), random.log_in(1e-3, 1e3));
  c.angle_deg = random.in(1, 170);
  c.width = 1 + static_cast<int>(random.below(300));
  c.height = 1 + static_cast<int>(random.below(300));
  return c;
}

/// A frame's vectors are computed in double and rounded once: 1 eps of the vector's length in each
/// component.
TEST(Camera, FrameIsTheExactOneRounded) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const Camera c = random_camera(random);
    if (!camera_is_valid(c))
      continue;
    const FrameView f = make_frame(c);
    const Frame exact(c);
    const auto expect_near = [&](const float(&got)[3], const V& wanted, const char* what) {
      const oracle::Real bound = 1.01L * oracle::kEps * length(wanted);
      ASSERT_LE(std::abs(got[0] - wanted.x), bound) << what << ", seed " << seed;
      ASSERT_LE(std::abs(got[1] - wanted.y), bound) << what << ", seed " << seed;
      ASSERT_LE(std::abs(got[2] - wanted.z), bound) << what << ", seed " << seed;
    };
    expect_near(f.forward, exact.forward, "forward");
    expect_near(f.right, exact.right, "right");
    expect_near(f.up, exact.up, "up");
    EXPECT_EQ(Float3({f.eye[0], f.eye[1], f.eye[2]}), c.eye);
  }
}

/// A direction is a sum of three vectors whose lengths are at most that of the whole (they stand at
/// right angles): each component takes 3 roundings of its terms, 2 of the sums, and normalising 5
/// more; under 12 eps together.
TEST(Camera, RaysGoThroughPixelCentres) {
  const auto batch = std::make_unique<Batch>();
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    const Camera c = random_camera(random);
    if (!camera_is_valid(c))
      continue;
    const Frame exact(c);
    const int x0 = static_cast<int>(random.below(static_cast<std::uint32_t>(c.width))),
              y0 = static_cast<int>(random.below(static_cast<std::uint32_t>(c.height)));
    const int x1 = std::min(x0 + kTile, c.width), y1 = std::min(y0 + kStripRows, c.height);
    int n = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        batch->rays.org.x[n] = static_cast<float>(x);
        batch->rays.org.y[n++] = static_cast<float>(y);
      }
    scalar::camera_rays(make_frame(c), {.batch = batch.get()}, n, true);
    for (int i = 0; i < n; ++i) {
      const int x = x0 + i % (x1 - x0), y = y0 + i / (x1 - x0);
      const V got{batch->rays.dir.x[i], batch->rays.dir.y[i], batch->rays.dir.z[i]};
      ASSERT_LE(length(got - exact.through(c, x, y)), 12 * oracle::kEps)
          << "seed " << seed << ", pixel " << x << ' ' << y;
    }
  }
}

/// Rays of an orthographic camera have its direction and start on the plane across it at the eye:
/// each component takes 2 roundings of its terms and 2 of the sums, of lengths up to the eye's and
/// the picture's.
TEST(Camera, ParallelRaysStartOnThePlaneOfTheEye) {
  const auto batch = std::make_unique<Batch>();
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    Camera c = random_camera(random);
    c.orthographic_height = random.log_in(1e-3, 1e3);
    if (!camera_is_valid(c))
      continue;
    const V forward = oracle::unit(V(c.at) - V(c.eye));
    const V right = oracle::unit(cross(forward, V(c.up))), up = cross(right, forward);
    const oracle::Real pixel = oracle::Real(c.orthographic_height) / c.height;
    const int x = static_cast<int>(random.below(static_cast<std::uint32_t>(c.width))),
              y = static_cast<int>(random.below(static_cast<std::uint32_t>(c.height)));
    batch->rays.org.x[0] = static_cast<float>(x);
    batch->rays.org.y[0] = static_cast<float>(y);
    scalar::camera_rays(make_frame(c), {.batch = batch.get()}, 1, true);
    const Rows3 &org = batch->rays.org, &dir = batch->rays.dir;
    const V across = pixel * (x + .5L - .5L * c.width) * right,
            upward = pixel * (.5L * c.height - (y + .5L)) * up;
    ASSERT_LE(length(V{dir.x[0], dir.y[0], dir.z[0]} - forward), 12 * oracle::kEps) << seed;
    ASSERT_LE(length(V{org.x[0], org.y[0], org.z[0]} - (V(c.eye) + across + upward)),
              6 * oracle::kEps * (length(V(c.eye)) + length(across) + length(upward)))
        << "seed " << seed;
  }
}

/// What callers get is what pictures are made of.
TEST(Camera, RaysForCallersAreThoseOfPictures) {
  const auto batch = std::make_unique<Batch>();
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    Camera c = random_camera(random);
    c.orthographic_height = seed % 2 == 0 ? 0 : random.log_in(1e-3, 1e3);
    if (!camera_is_valid(c))
      continue;
    std::vector<Ray> row(static_cast<std::size_t>(c.width));
    const int y = static_cast<int>(random.below(static_cast<std::uint32_t>(c.height)));
    camera_rays(c, y, row);
    for (std::size_t x = 0; x < row.size(); ++x) {
      batch->rays.org.x[x] = static_cast<float>(x);
      batch->rays.org.y[x] = static_cast<float>(y);
    }
    scalar::camera_rays(make_frame(c), {.batch = batch.get()}, c.width, true);
    const Rows3 &org = batch->rays.org, &dir = batch->rays.dir;
    for (std::size_t x = 0; x < row.size(); ++x) {
      ASSERT_EQ(row[x].org, (Float3{org.x[x], org.y[x], org.z[x]})) << "seed " << seed;
      ASSERT_EQ(row[x].dir, (Float3{dir.x[x], dir.y[x], dir.z[x]})) << "seed " << seed;
    }
  }
}

/// A white square seen head on: pixels whose centres lie on it are white, all others black; also
/// off the square format.
TEST(Camera, PictureStandsUpright) {
  Scene scene = empty_scene();
  scene.materials[0] = {};
  scene.materials[0].emission = {1, 1, 1};
  add_triangle(scene,
               {0, 0, 0},
               {3, 0, 0},
               {3, 2, 0});  // right and above the middle: [0, 3] x [0, 2] of [-3, 3] x [-2, 2]
  add_triangle(scene, {0, 0, 0}, {3, 2, 0}, {0, 2, 0});
  const World world(scene, {});
  Camera c;
  c.eye = {0, 0, 2};
  c.at = {0, 0, 0};
  c.up = {0, 5, 0};
  c.angle_deg = 90;
  for (const auto& [w, h] : {std::pair{30, 20}, {15, 10}, {31, 21}, {3, 2}}) {
    c.width = w;
    c.height = h;
    RenderStats stats;
    const Image image = render(world, c, {}, stats);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        // where the centre meets z = 0
        const double px = (x + .5 - w / 2.) * 4 / h, py = (h / 2. - y - .5) * 4 / h;
        // on the square's very edge
        if (px == 0 || py == 0)
          continue;
        EXPECT_EQ(image.row(y)[3 * x], px > 0 && py > 0 && px < 3 ? 1.f : 0.f)
            << w << 'x' << h << ", pixel " << x << ' ' << y;
      }
    EXPECT_EQ(stats.rays.primary, static_cast<std::uint64_t>(w * h));
  }
}

TEST(Camera, RefusesWhatCannotSee) {
  const Camera good;
  EXPECT_TRUE(camera_is_valid(good));
  const auto refused = [&](auto change) {
    Camera c;
    change(c);
    EXPECT_FALSE(camera_is_valid(c));
    Scene scene = empty_scene();
    RenderStats stats;
    EXPECT_THROW(render(World(scene, {}), c, {}, stats), std::invalid_argument);
  };
  refused([](Camera& c) { c.at = c.eye; });
  refused([](Camera& c) { c.up = {0, 0, 0}; });
  refused([](Camera& c) { c.up = {0, 0, -3}; });
  refused([](Camera& c) { c.eye.x = kNaN; });
  refused([](Camera& c) { c.at.y = kInf; });
  refused([](Camera& c) { c.up.z = -kInf; });
  refused([](Camera& c) { c.angle_deg = 0; });
  refused([](Camera& c) { c.angle_deg = 180; });
  refused([](Camera& c) { c.angle_deg = std::nan(""); });
  refused([](Camera& c) { c.width = 0; });
  refused([](Camera& c) { c.height = -1; });
}

TEST(RenderOptions, RefusesWhatItCannotDo) {
  const Scene scene = random_mixture(1, 30);
  const World world(scene, {});
  RenderStats stats;
  const auto refused = [&](const RenderOptions& o) {
    EXPECT_THROW(render(world, {}, o, stats), std::invalid_argument);
  };
  RenderOptions o;
  o.depth = 0;
  refused(o);
  o.depth = 100000;
  refused(o);
  o = {};
  o.packet = 8;
  refused(o);
  o = {};
  for (const double weight : {-1e-9, 1.001, std::nan("")}) {
    o.min_weight = weight;
    refused(o);
    o = {};
  }
  o.threads = -1;
  refused(o);
  o = {};
  o.isa = "mmx";
  refused(o);
  o = {};
  for (const Isa& isa : isas())
    if (isa.compiled && !isa.is_supported) {
      o.isa = isa.name;
      refused(o);
    }
}

TEST(RenderOptions, ProgressCanStop) {
  const Scene scene = random_mixture(1, 30);
  const World world(scene, {});
  Camera c;
  c.eye = {0, 0, 4};
  c.width = 16;
  c.height = 160;
  RenderOptions o;
  o.threads = 1;
  std::vector<double> shares;
  o.progress = [&](double share) {
    shares.push_back(share);
    return shares.size() < 3;
  };
  RenderStats stats;
  render(world, c, o, stats);
  EXPECT_EQ(shares, (std::vector<double>{.05, .1, .15}));
  EXPECT_EQ(stats.rays.primary, 3u * 8 * 16);
}

}  // namespace
}  // namespace grelha::test
