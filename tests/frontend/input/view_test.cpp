// Tests views that options make of a scene's own, and that they print as they were.
#include "frontend/input/view.hpp"

#include <filesystem>
#include <numbers>

#include "frontend/input/read_scene.hpp"
#include "grelha/query.hpp"
#include "grelha/render.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/parsing.hpp"
#include "tests/support/random.hpp"
#include "tests/support/reading.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

using oracle::Real;
using oracle::V;

const std::string kTorus = GRELHA_SOURCE_DIR "/scenes/data/torus.ply";

SceneFile read(const std::string& path) {
  return read_scene(path, [](const std::string&) {});
}

/// A view's azimuth and elevation around its up direction, and distance, in long double.
struct Place {
  Place(const Camera& c, const V& pole, const V& front) {
    const V back = V(c.eye) - V(c.at);
    distance = length(back);
    elevation = std::asin(dot(back, pole) / distance);
    azimuth = std::atan2(dot(back, cross(pole, front)), dot(back, front));
  }
  Real azimuth, elevation, distance;
};

/// Around any axis, by any angles: the eye goes that far, and the distance stays. Floats of the eye
/// are off by an eps of its coordinates, seen from `at`.
TEST(Orbit, GoesAroundThePointLookedAt) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    View view;
    view.camera.at = random.point(1);
    view.camera.up = random.direction();
    view.camera.eye = at(view.camera.at, random.log_in(.1, 10), random.direction());
    if (!camera_is_valid(view.camera))
      continue;
    const V pole = oracle::unit(V(view.camera.up));
    const V back = V(view.camera.eye) - V(view.camera.at);
    const V front = oracle::unit(back - dot(back, pole) * pole);
    const Place before(view.camera, pole, front);
    const double degree = 180 / std::numbers::pi;
    ViewOptions options;
    const double least = -89 - double(before.elevation) * degree,
                 most = 89 - double(before.elevation) * degree;
    options.orbit = {random.in(-400, 400), random.in(least, most), 1};
    const View seen = changed(view, options, {});
    const Place after(seen.camera, pole, front);
    const Real bound = 8 * oracle::kEps * (1 + length(V(view.camera.at)) / before.distance) /
                       std::cos(after.elevation);
    const Real turned = std::remainder(after.azimuth - Real(options.orbit->azimuth_deg) / degree,
                                       2 * std::numbers::pi_v<Real>);
    EXPECT_LE(std::abs(turned), bound) << "seed " << seed;
    EXPECT_LE(
        std::abs(after.elevation - before.elevation - Real(options.orbit->elevation_deg) / degree),
        bound)
        << "seed " << seed;
    EXPECT_LE(std::abs(after.distance / before.distance - 1), bound) << "seed " << seed;
    const V right = oracle::unit(cross(V(seen.camera.up), V(seen.camera.eye) - V(seen.camera.at)));
    EXPECT_LE(std::abs(dot(right, pole)), bound) << "the horizon is level, seed " << seed;
  }
}

/// Over a pole, where the up direction itself lies along the view, the picture only turns on.
TEST(Orbit, CrossesThePoles) {
  View view;
  view.camera.eye = {0, 0, 3};
  for (const double elevation : {90., -90., 180., 270.}) {
    ViewOptions options;
    options.orbit = {0, elevation, 1};
    const Camera c = changed(view, options, {}).camera;
    const double sine = elevation == 90 ? 1 : elevation == 180 ? 0 : -1;
    EXPECT_EQ(c.eye, (Float3{0, float(3 * sine), elevation == 180 ? -3.f : 0.f})) << elevation;
    EXPECT_TRUE(camera_is_valid(c));
  }
  ViewOptions turn;
  turn.orbit = {360, 0, 1};
  EXPECT_EQ(changed(view, turn, {}).camera.eye, view.camera.eye);
}

TEST(Orbit, ZoomDividesTheAngleOrTheHeight) {
  View view;
  ViewOptions options;
  options.orbit = {0, 0, 4};
  EXPECT_EQ(changed(view, options, {}).camera.angle_deg, 45. / 4);
  options.orthographic_height = 6;
  EXPECT_EQ(changed(view, options, {{}, 2}).camera.orthographic_height, 3)
      << "6 in the file is 12 in a scene of twice its size";
}

/// The scans beside the project, and the torus in it.
std::vector<std::string> meshes() {
  std::vector<std::string> all{kTorus};
  for (const char* name : {"bunny10k.ply", "armadillo.ply", "horse.ply", "screwdriver.ply"})
    if (const std::string path = GRELHA_SHARED_SCENES "/ply/" + std::string(name);
        std::filesystem::exists(path))
      all.push_back(path);
  return all;
}

/// What hits of the camera's rays look like, without the light that the material gives off itself.
/// Faces seen at less than 15 degrees are left out: cos 75 times the fill is .06.
float darkest(const SceneFile& file, const World& world, const View& view) {
  RenderOptions options;
  options.lighting = view.lighting;
  RenderStats stats;
  const Image image = render(world, view.camera, options, stats);
  float least = 1;
  std::vector<Ray> rays(std::size_t(view.camera.width));
  for (int y = 0; y < view.camera.height; ++y) {
    camera_rays(view.camera, y, rays);
    for (std::size_t x = 0; x < rays.size(); ++x) {
      const Ray& ray = rays[x];
      const Hit hit = closest(world, ray);
      if (!hit || std::abs(dot(surface(world, ray, hit).shading, ray.dir)) < .26f)
        continue;
      const float* const pixel = image.row(y) + 3 * x;
      least = std::min({least, pixel[0], pixel[1], pixel[2]});
    }
  }
  EXPECT_LT(least, 1) << "nothing is seen of " << file.counts.ply << " faces";
  return least;
}

/// From 26 directions around a mesh no face is darker than .05: the lights follow.
TEST(MadeUpLights, FollowTheCamera) {
  for (const std::string& path : meshes()) {
    SceneFile file = read(path);
    file.scene.materials.at(0).emission = {};
    const World world(file.scene, {});
    View view = view_of(file);
    view.camera.width = view.camera.height = 64;
    float stay = 1;
    for (int direction = 0; direction < 27; ++direction) {
      const double x = direction % 3 - 1, y = direction / 3 % 3 - 1, z = direction / 9 - 1;
      const double d = length(V(view.camera.eye) - V(view.camera.at));
      const double n = std::sqrt(x * x + y * y + z * z);
      if (n == 0)
        continue;
      const Float3 at = view.camera.at;
      ViewOptions options;
      options.eye = {at.x + d * x / n, at.y + d * y / n, at.z + d * z / n};
      options.up = {0, x == 0 && z == 0 ? 0. : 1., x == 0 && z == 0 ? 1. : 0.};
      EXPECT_GT(darkest(file, world, changed(view, options, {})), .05f)
          << path << " from " << x << ' ' << y << ' ' << z;
      options.lights_follow = false;
      stay = std::min(stay, darkest(file, world, changed(view, options, {})));
    }
    EXPECT_EQ(stay, 0) << "some face is dark where they stay with the mesh";
  }
}

/// How far hits reach to the sides and upward, of the half of a picture.
std::pair<double, double> filled(const World& world, const Camera& c) {
  double across = 0, upward = 0;
  std::vector<Ray> rays(std::size_t(c.width));
  for (int y = 0; y < c.height; ++y) {
    camera_rays(c, y, rays);
    for (int x = 0; x < c.width; ++x)
      if (closest(world, rays[std::size_t(x)])) {
        across = std::max(across, std::abs(2. * x + 1 - c.width) / c.width);
        upward = std::max(upward, std::abs(2. * y + 1 - c.height) / c.height);
      }
  }
  return {across, upward};
}

/// Seen all around and in any format, a bare mesh never leaves the picture.
TEST(MadeUpCamera, FitsAllAround) {
  for (const std::string& path : meshes()) {
    SceneFile file = read(path);
    const World world(file.scene, {});
    for (const auto& [width, height] : {std::pair{48, 48}, {24, 72}, {80, 40}}) {
      View view = view_of(file);
      view.camera.width = width;
      view.camera.height = height;
      const auto expect_fit = [&](const ViewOptions& options, double least) {
        const auto [across, upward] = filled(world, changed(view, options, {}).camera);
        EXPECT_LE(std::max(across, upward), .95) << path << ' ' << width << 'x' << height;
        EXPECT_GT(std::max(across, upward), least) << "it is not lost in it either";
      };
      expect_fit({}, .5);
      for (const double elevation : {-110., -50., 0., 40.})
        for (double azimuth = 0; azimuth < 360; azimuth += 45) {
          ViewOptions options;
          options.orbit = {azimuth, elevation, 1};
          expect_fit(options, .15);
        }
    }
  }
}

/// How far points reach from the middle of a picture, as shares of its half, in long double.
struct Reach {
  Reach(const Triangles& t, const Camera& c) {
    const V back = oracle::unit(V(c.eye) - V(c.at)), right = oracle::unit(cross(V(c.up), back)),
            up = cross(back, right);
    const Real half = c.orthographic_height > 0
                          ? Real(c.orthographic_height) / 2
                          : std::tan(Real(c.angle_deg) * std::numbers::pi_v<Real> / 360);
    for (std::size_t i = 0; i < t.vertex_count(); ++i) {
      const V p = V(Float3{t.x[i], t.y[i], t.z[i]}) - V(c.eye);
      EXPECT_LT(dot(p, back), 0) << "before the eye";
      const Real size = c.orthographic_height > 0 ? half : -dot(p, back) * half;
      across = std::max(across, std::abs(dot(p, right)) / size * c.height / c.width);
      upward = std::max(upward, std::abs(dot(p, up)) / size);
    }
  }
  Real across = 0, upward = 0;
};

/// A few triangles of any proportions, near the origin or away from it.
SceneFile random_mesh(Random& random) {
  SceneFile file;
  Triangles& t = file.scene.geometry.triangles;
  const Float3 middle = random.point(random.chance(.5) ? 0 : 5);
  const double size[] = {random.log_in(.01, 3), random.log_in(.01, 3), random.log_in(.01, 3)};
  for (std::uint32_t v = 0; v < 12; ++v) {
    t.x.push_back(middle.x + float(random.in(-size[0], size[0])));
    t.y.push_back(middle.y + float(random.in(-size[1], size[1])));
    t.z.push_back(middle.z + float(random.in(-size[2], size[2])));
    if (v % 3 == 0)
      t.a.push_back(v), t.b.push_back(v + 1), t.c.push_back(v + 2), t.material.push_back(0);
  }
  add_default_view(file);
  return file;
}

/// `--up` by `--orbit`, on a turntable, orthographic and in any format: the margin stays, the
/// horizon is level, one zoom serves all sides, and some side fills the picture.
TEST(MadeUpCamera, ShowsAllOfAnyMeshFromAnySide) {
  constexpr Real kMost = .9L + 1e-4L;  // floats of a small mesh away from the origin
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    SceneFile file = random_mesh(random);
    file.camera.width = random.chance(.5) ? 300 : 80 + int(random.below(600));
    file.camera.height = random.chance(.5) ? 300 : 80 + int(random.below(600));
    ViewOptions options;
    if (random.chance(.7)) {
      const Float3 up = random.direction();
      options.up = {up.x, up.y, up.z};
    }
    if (random.chance(.3))
      options.orthographic_height = 0;
    const View own = view_of(file, options);
    const V pole = oracle::unit(V(own.camera.up));
    const auto expect_shown = [&](const View& view) {
      const Camera& c = view.camera;
      const Reach reach(file.scene.geometry.triangles, c);
      EXPECT_LE(std::max(reach.across, reach.upward), kMost) << "seed " << seed;
      EXPECT_LE(std::abs(dot(cross(V(c.up), V(c.eye) - V(c.at)), pole)),
                1e-5L * length(V(c.eye) - V(c.at)))
          << "the horizon is level, seed " << seed;
      return std::max(reach.across, reach.upward);
    };
    expect_shown(changed(own, options, {}));
    const double elevation = random.chance(.3) ? 0 : random.in(-200, 200);
    Real most = 0, nearest = 1e30L, furthest = 0;
    for (double azimuth = 0; azimuth < 360; azimuth += 5) {
      options.orbit = {azimuth, elevation, 1};
      const View view = changed(own, options, {});
      most = std::max(most, expect_shown(view));
      const Real distance = length(V(view.camera.eye) - V(view.camera.at));
      nearest = std::min(nearest, distance);
      furthest = std::max(furthest, distance);
    }
    EXPECT_GT(most, .87L) << "seed " << seed;
    EXPECT_LT(furthest / nearest, 1 + 1e-4L) << "seed " << seed;
  }
}

bool same_camera(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.at == b.at && a.up == b.up && a.angle_deg == b.angle_deg &&
         a.orthographic_height == b.orthographic_height && a.width == b.width &&
         a.height == b.height;
}

/// Options and lines of NFF that are printed make the same view, to the bit, also in a frame.
TEST(PrintedView, ReadsBackAsItWas) {
  SceneFile file = read(kTorus);
  for (const Frame& frame : {Frame{}, Frame{{4096, -1 << 20, .5}, 1}})
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Random random(seed);
      ViewOptions options;
      options.orbit = {random.in(0, 360), random.in(-60, 60), random.in(.5, 2)};
      if (seed % 3 == 0)
        options.orthographic_height = random.in(1, 2);
      const View view = changed(view_of(file), options, frame);
      const std::vector<std::string> lines = lines_of(view, frame);
      const auto again = std::get<RenderCommand>(parse("render x.ply " + lines.at(0)));
      EXPECT_TRUE(same_camera(changed(view_of(file), again.input.view, frame).camera, view.camera))
          << lines[0];
      if (seed % 3 == 0)
        continue;
      std::string text;
      for (std::size_t i = 1; i < lines.size(); ++i)
        text += lines[i] + '\n';
      ReadOptions in_frame;
      in_frame.frame = frame;
      const SceneFile read = read_nff("x.nff", text, {}, in_frame);
      EXPECT_TRUE(same_camera(read.camera, view.camera)) << text;
      EXPECT_EQ(read.scene.background, view.lighting.background);
      ASSERT_EQ(read.scene.lights.size(), 3u);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(read.scene.lights[i].position, view.lighting.lights[i].position);
        EXPECT_EQ(read.scene.lights[i].color, view.lighting.lights[i].color);
      }
    }
}

TEST(View, OfASceneKeepsItsLights) {
  SceneFile file = read_with_view("l 1 2 3 .5 .5 .5\n" + kFill + "s 0 0 0 1\n").file;
  ViewOptions options;
  options.orbit = {180, 0, 1};
  options.background = {1, .5f, 0};
  apply_view(view_of(file), options, file);
  EXPECT_EQ(file.camera.eye, (Float3{0, 0, -5}));
  EXPECT_EQ(file.scene.lights.at(0).position, (Float3{1, 2, 3}));
  EXPECT_EQ(file.scene.background, (Float3{1, .5f, 0}));
  EXPECT_EQ(lines_of(view_of(file), {}).size(), 2u) << "the lights stand in the file";
  options.lights_follow = true;
  EXPECT_THROW(apply_view(view_of(file), options, file), std::invalid_argument);
}

TEST(View, ACameraThatCannotSeeIsRefused) {
  SceneFile file = read(kTorus);
  const auto message = [&](const char* words) {
    const auto command = std::get<RenderCommand>(parse("render x.ply " + std::string(words)));
    return message_of([&] { changed(view_of(file), command.input.view, {}); });
  };
  EXPECT_EQ(message("--eye 1,2,3 --at 0,0,0"), "");
  EXPECT_NE(message("--eye 1,2,3 --at 1,2,3"), "");
  EXPECT_NE(message("--eye 0,0,3 --at 0,0,0 --up 0,0,1"), "");
  EXPECT_NE(message("--orbit 0,0,.1"), "") << "300 degrees";
  EXPECT_NE(message("--up 0,0,0"), "");
  EXPECT_NE(message("--orthographic auto --eye 1,2,3"), "");
}

TEST(ViewOptions, AreRead) {
  const ViewOptions v =
      std::get<RenderCommand>(parse("render x.ply --eye 1,-2,3e5 --at -.5,0,0 --up 0,0,1 "
                                    "--angle 12.5 --orbit -30,400.5,2 --orthographic 7 "
                                    "--background .5 --lights mesh"))
          .input.view;
  EXPECT_EQ(v.eye, (std::array{1., -2., 3e5}));
  EXPECT_EQ(v.at, (std::array{-.5, 0., 0.}));
  EXPECT_EQ(v.up, (std::array{0., 0., 1.}));
  const auto up = [](const std::string& text) {
    return std::get<RenderCommand>(parse("render x.stl --up=" + text)).input.view.up;
  };
  EXPECT_EQ(up("z"), (std::array{0., 0., 1.}));
  EXPECT_EQ(up("+Z"), up("z"));
  EXPECT_EQ(up("-x"), (std::array{-1., 0., 0.}));
  EXPECT_EQ(std::get<RenderCommand>(parse("render x.stl --up -Y")).input.view.up, up("0,-1,0"));
  EXPECT_EQ(std::get<RenderCommand>(parse("render x --orthographic auto --orbit 180"))
                .input.view.orthographic_height,
            0);
  EXPECT_EQ(v.angle_deg, 12.5);
  EXPECT_EQ(v.orbit->azimuth_deg, -30);
  EXPECT_EQ(v.orbit->elevation_deg, 400.5);
  EXPECT_EQ(v.orbit->zoom, 2);
  EXPECT_EQ(v.orthographic_height, 7);
  EXPECT_EQ(v.background, (Float3{.5f, .5f, .5f}));
  EXPECT_EQ(v.lights_follow, false);
  const auto info = std::get<InfoCommand>(parse("info x.ply --orbit 90,0 --background 1,.5,0"));
  EXPECT_EQ(info.input.view.orbit->zoom, 1);
  EXPECT_EQ(info.input.view.background, (Float3{1, .5f, 0}));
  EXPECT_FALSE(info.input.view.eye || info.input.view.lights_follow);
}

TEST(ViewOptions, ThatCannotBeAreRefused) {
  const auto error = [](const char* words) {
    return error_of("render x.ply " + std::string(words));
  };
  EXPECT_EQ(error("--eye 1,2"), "--eye: expected X,Y,Z, found \"1,2\"");
  EXPECT_EQ(error("--at 1,2,nan"), "--at: expected numbers X,Y,Z within 1e18, found \"nan\"");
  EXPECT_EQ(error("--angle 180"), "--angle: expected degrees between 0 and 180, found \"180\"");
  EXPECT_EQ(error("--orbit 1,2,3,4"),
            "--orbit: expected AZIMUTH, AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ZOOM, "
            "found \"1,2,3,4\"");
  EXPECT_EQ(error("--orbit 1,2,0"), "--orbit: expected a zoom of .001 to 1000, found \"0\"");
  EXPECT_EQ(error("--orbit 1e9,2"), "--orbit: expected degrees, at most 100 turns, found \"1e9\"");
  EXPECT_EQ(error("--orthographic 0"),
            "--orthographic: expected auto, or a height above 0 and up to 1e18, found \"0\"");
  EXPECT_EQ(error("--up zz"), "--up: expected X,Y,Z, or an axis such as z or -y, found \"zz\"");
  EXPECT_EQ(error("--at 1e18,-1e18,0 --orthographic 1e18 --points 1e18 --shadows random:1e18"),
            "no error");
  EXPECT_EQ(error("--background 1,2"),
            "--background: expected R,G,B, #rrggbb or a name such as white, found \"1,2\"");
  EXPECT_EQ(error("--lights eye"), "--lights: expected one of camera, mesh, found \"eye\"");
}

TEST(ViewOptions, BackgroundInBytesOrLight) {
  const auto view = [](const char* text) {
    return std::get<RenderCommand>(test::parse("render a --background " + std::string(text)))
        .input.view;
  };
  EXPECT_EQ(view("1,.5,0").background, (Float3{1, .5f, 0}));
  EXPECT_FALSE(view("1,.5,0").background_is_encoded);
  EXPECT_EQ(view("2").background, (Float3{2, 2, 2}));
  for (const char* const red : {"#f00", "#F00", "#ff0000", "red", "Red"}) {
    EXPECT_EQ(view(red).background, (Float3{1, 0, 0})) << red;
    EXPECT_TRUE(view(red).background_is_encoded);
  }
  EXPECT_EQ(view("#336699").background, (Float3{.2f, .4f, .6f}));
  EXPECT_EQ(view("#369").background, (Float3{.2f, .4f, .6f}));
  EXPECT_EQ(view("white").background, (Float3{1, 1, 1}));
  const auto warnings = [&](const char* text) {
    std::string lines;
    warn_of_background("s", view(text), [&](const std::string& line) { lines += line; });
    return lines;
  };
  EXPECT_EQ(warnings("255,255,0"),
            "s: warning: --background 255,255,0 is 255 times as bright as white, which is 1; "
            "#rrggbb takes bytes");
  for (const char* const usual : {"1,1,1", "1.5", "0", "#ffffff", "white"})
    EXPECT_EQ(warnings(usual), "") << usual;
  // where colours are light, the picture encodes them again
  EXPECT_NEAR(with_background(view("#336699"), true).background->x, .0331048, 1e-6);
  EXPECT_EQ(with_background(view("#336699"), false).background->x, .2f);
  EXPECT_EQ(with_background(view(".2,0,0"), true).background->x, .2f);
}

}  // namespace
}  // namespace grelha::test
