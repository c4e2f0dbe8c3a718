// One picture: the same bits for every number of threads, instruction set, packet size, mailbox,
// density and grid, and however often it was stopped.
#include <cstring>
#include <sstream>

#include "frontend/nff/nff_reader.hpp"
#include "grelha/render.hpp"
#include "kernel/picture/picture.hpp"
#include "scenes/generators.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

struct Picture {
  Scene scene;
  Camera camera;
};

Picture generated(const char* name, int size) {
  std::ostringstream text;
  scenes::find_generator(name)->write(text, {size, false, ""});
  SceneFile file = read_nff(std::string(name) + ".nff", text.str(), [](const std::string&) {});
  return {std::move(file.scene), file.camera};
}

/// Every kind and every effect at once: glass of both sorts, mirrors, highlights, smooth normals,
/// emission, lights on all sides.
Picture mixture() {
  Picture p;
  Scene& s = p.scene = random_mixture(12, 240);
  s.materials.resize(6);
  s.materials[1].mirror = {.8f, .7f, .9f};
  s.materials[1].specular = {.5f, .5f, .5f};
  s.materials[1].shine = 40;
  s.materials[2].transmission = .9f;
  s.materials[2].ior = 1.5f;
  s.materials[2].fresnel = true;
  s.materials[3].transmission = .7f;
  s.materials[3].ior = 1.2f;
  s.materials[3].mirror = {.2f, .3f, .2f};
  s.materials[4].emission = {.3f, .2f, .1f};
  s.materials[4].diffuse = {.2f, .5f, .9f};
  s.materials[5].diffuse = {.4f, .4f, .2f};
  s.materials[5].specular = {1, 1, 1};
  s.materials[5].shine = 7.3f;
  Random random(1);
  for (auto* m : {&s.geometry.spheres.material,
                  &s.geometry.triangles.material,
                  &s.geometry.cones.material,
                  &s.geometry.planes.material})
    for (std::uint32_t& i : *m)
      i = random.below(6);
  Triangles& t = s.geometry.triangles;
  for (std::size_t i = 0; i < t.vertex_count(); ++i) {
    const Float3 n = random.chance(.2) ? Float3{} : random.direction();
    t.nx.push_back(n.x);
    t.ny.push_back(n.y);
    t.nz.push_back(n.z);
    t.red.push_back(static_cast<float>(random.in(0, 1)));
    t.green.push_back(static_cast<float>(random.in(0, 1)));
    t.blue.push_back(static_cast<float>(random.in(0, 1)));
  }
  s.lights = {
      {{3, 4, 5}, {.6f, .6f, .6f}}, {{-4, 2, 1}, {.3f, .1f, .2f}}, {{0, 0, 0}, {.2f, .4f, .1f}}};
  s.background = {.08f, .36f, .57f};
  p.camera.eye = {.3f, .5f, 3.5f};
  p.camera.at = {0, 0, 0};
  return p;
}

class Determinism : public testing::TestWithParam<const char*> {
 protected:
  static Picture make() {
    const std::string name = GetParam();
    Picture p = name == "mixture" || name == "parallel" ? mixture()
                : name == "mount"                       ? generated("mount", 4)
                                                        : generated(GetParam(), 2);
    if (name == "parallel")
      p.camera.orthographic_height = 4;
    p.camera.width = 67;
    p.camera.height = 43;  // no multiple of tile, strip, packet or register
    return p;
  }
};

std::size_t differing(const Image& a, const Image& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    n += std::bit_cast<std::uint32_t>(a.rgb[i]) != std::bit_cast<std::uint32_t>(b.rgb[i]);
  return n;
}

struct Built {
  std::string name;
  World world;
};

std::vector<Built> builds(const Scene& scene) {
  std::vector<Built> out;
  out.push_back({"no grid", World(scene, {.grid = false})});
  for (const float density : {0.f, .5f, 3.f})
    out.push_back({"density " + std::to_string(density), World(scene, {.density = density})});
  return out;
}

/// The plainest: scalar, one thread, one ray, no grid.
Image plainest(const std::vector<Built>& worlds,
               const Camera& camera,
               RenderOptions o,
               RenderStats& stats,
               SampleMaps* maps = nullptr) {
  o.threads = 1;
  o.packet = 1;
  o.isa = "scalar";
  o.mailbox = false;
  return render(worlds.front().world, camera, o, stats, maps);
}

void expect_same_rays(const RayCounts& a, const RayCounts& b) {
  EXPECT_EQ(a.primary, b.primary);
  EXPECT_EQ(a.shadow, b.shadow);
  EXPECT_EQ(a.reflection, b.reflection);
  EXPECT_EQ(a.refraction, b.refraction);
}

void expect_one_picture(const std::vector<Built>& worlds, const Camera& camera, RenderOptions o) {
  RenderStats first;
  SampleMaps maps;
  const Image wanted = plainest(worlds, camera, o, first, &maps);
  for (const Built& built : worlds)
    for (const Variant* v : variants()) {
      if (!v->is_supported())
        continue;
      for (const int packet : {1, 16, 64, 256})
        for (const bool mailbox : {true, false})
          for (const int threads : {1, 2, 7}) {
            if (threads != 2 && (packet == 1 || !mailbox))
              continue;  // threads do not see the packet: the rest is covered
            o.threads = threads;
            o.packet = packet;
            o.mailbox = mailbox;
            o.isa = v->name;
            RenderStats stats;
            SampleMaps found;
            const Image image = render(built.world, camera, o, stats, &found);
            SCOPED_TRACE(testing::Message()
                         << built.name << ", " << v->name << ", packet " << packet << ", mailbox "
                         << mailbox << ", " << threads << " threads");
            ASSERT_EQ(differing(image, wanted), 0u);
            ASSERT_EQ(found.samples, maps.samples);
            ASSERT_EQ(found.error, maps.error);
            expect_same_rays(stats.rays, first.rays);
          }
    }
}

TEST_P(Determinism, OnePictureForEveryWayOfTracing) {
  const Picture p = make();
  expect_one_picture(builds(p.scene), p.camera, {});
}

/// Multiplies all lengths by `scale`, a power of two.
Picture scaled_by(const Picture& picture, double scale) {
  Picture p{placed(picture.scene, scale, {}), picture.camera};
  for (Light& light : p.scene.lights)
    for (Float3* v : {&light.position, &light.edge1, &light.edge2})
      *v = scaled(*v, scale);
  p.camera.eye = scaled(p.camera.eye, scale);
  p.camera.at = scaled(p.camera.at, scale);
  p.camera.aperture *= scale;
  p.camera.orthographic_height *= scale;
  p.camera.focus *= scale;
  return p;
}

/// Scaling by a power of two changes only exponents, also of computed numbers, unless products of
/// lengths overflow or underflow. A triangle's depth is a product of three lengths, so sizes from
/// 1e-10 to 1e11 must give the same picture.
TEST_P(Determinism, AtEverySize) {
  const Picture p = make();
  RenderStats stats;
  const Image wanted = render(World(p.scene, {}), p.camera, {}, stats);
  for (const int power : {-30, -12, 12, 30}) {
    const Picture q = scaled_by(p, std::ldexp(1., power));
    EXPECT_EQ(differing(render(World(q.scene, {}), q.camera, {}, stats), wanted), 0u)
        << "times 2^" << power;
  }
}

/// Lights of a picture in place of the scene's make the picture of a World that has them.
TEST_P(Determinism, InOtherLights) {
  Picture p = make();
  const World world(p.scene, {});
  RenderOptions options;
  options.lighting = Lighting{
      {{{1, 5, 2}, {.7f, .8f, .9f}, {1, 0, 0}, {0, 0, 1}}, {{-3, 2, 4}, {.2f, 0, .1f}, {}, {}}},
      {.4f, .3f, .2f}};
  p.scene.lights = options.lighting->lights;
  p.scene.background = options.lighting->background;
  for (const bool by_error : {false, true}) {
    options.sampling.samples = 4;
    options.refine.samples = by_error ? 40'000 : 0;
    RenderOptions plain = options;
    plain.lighting.reset();
    RenderStats stats;
    EXPECT_EQ(differing(render(world, p.camera, options, stats),
                        render(World(p.scene, {}), p.camera, plain, stats)),
              0u);
    options.lighting->lights.erase(options.lighting->lights.begin());  // an area light
    p.scene.lights = options.lighting->lights;
  }
}

TEST_P(Determinism, AtEveryDepth) {
  const Picture p = make();
  const std::vector<Built> worlds = builds(p.scene);
  std::uint64_t last = 0;
  // Glass sends two rays a hit: the longest path is as long as its doubling allows, and 40 where
  // there are mirrors alone.
  const std::string name = GetParam();
  for (const int depth : {1, 2, name == "balls" ? 40 : name == "mount" ? 16 : 8}) {
    RenderStats first;
    const Image wanted = plainest(worlds, p.camera, {.depth = depth}, first);
    EXPECT_GE(first.rays.total(), last);
    last = first.rays.total();
    for (const Variant* v : variants()) {
      if (!v->is_supported())
        continue;
      for (const int packet : {16, 64, 256}) {
        RenderOptions o;
        o.depth = depth;
        o.threads = 2;
        o.packet = packet;
        o.isa = v->name;
        RenderStats stats;
        const Image image = render(worlds[1].world, p.camera, o, stats);
        ASSERT_EQ(differing(image, wanted), 0u)
            << v->name << ", packet " << packet << ", depth " << depth;
        expect_same_rays(stats.rays, first.rays);
      }
    }
  }
}

/// A crop of odd sizes is the same picture only if no pixel depends on its tile: seen by rendering
/// thin and small ones.
TEST_P(Determinism, AtOddSizes) {
  Picture p = make();
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 43}, {67, 1}, {9, 17}, {8, 8}, {65, 7}}) {
    p.camera.width = w;
    p.camera.height = h;
    const std::vector<Built> worlds = builds(p.scene);
    RenderStats first;
    const Image wanted = plainest(worlds, p.camera, {}, first);
    EXPECT_EQ(first.rays.primary, static_cast<std::uint64_t>(w * h));
    for (const int threads : {1, 7}) {
      RenderOptions o;
      o.threads = threads;
      RenderStats stats;
      EXPECT_EQ(differing(render(worlds[1].world, p.camera, o, stats), wanted), 0u)
          << w << 'x' << h << ", " << threads << " threads";
    }
  }
}

TEST_P(Determinism, ShowsSomething) {
  const Picture p = make();
  RenderStats stats;
  const Image image = render(World(p.scene, {}), p.camera, {}, stats);
  std::size_t lit = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    ASSERT_TRUE(std::isfinite(image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2]));
    lit += image.rgb[i] != p.scene.background.x;
  }
  EXPECT_GT(lit, 67u * 43 / 4);
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         Determinism,
                         testing::Values("balls", "mount", "mixture", "parallel"),
                         [](const auto& p) { return std::string(p.param); });

/// How samples are spent, on a picture of all effects; refine.samples are of one pixel.
struct Method {
  const char* name;
  RenderOptions options;
};
void PrintTo(const Method& m, std::ostream* out) {
  *out << m.name;
}

std::vector<Method> methods() {
  RenderOptions o;
  o.depth = 4;
  o.sampling.samples = 9;
  std::vector<Method> all;
  const auto add = [&](const char* name, auto change) {
    all.push_back({name, o});
    change(all.back().options);
  };
  add("Sobol", [](RenderOptions&) {});
  add("GlossRays", [](RenderOptions& m) { m.sampling.glossy_rays = 2; });
  add("Jitter", [](RenderOptions& m) { m.sampling.sampler = Sampler::kJitter; });
  add("Random", [](RenderOptions& m) { m.sampling.sampler = Sampler::kRandom; });
  add("Blue", [](RenderOptions& m) { m.sampling.sampler = Sampler::kBlue; });
  o.subdivision = {true, .1f, 2};
  o.sampling.light_rays = 2;
  add("Subdivided", [](RenderOptions& m) { m.sampling.samples = 1; });
  add("SubdividedPoints", [](RenderOptions& m) {
    m.sampling.samples = 3;
    m.sampling.glossy_rays = 2;
  });
  o.subdivision = {};
  o.sampling = {};
  add("ByError", [](RenderOptions& m) { m.refine.error = .05; });
  add("BySamples", [](RenderOptions& m) { m.refine.samples = 24; });
  add("ByErrorWithinLimits", [](RenderOptions& m) {
    m.refine.error = .02;
    m.refine.samples = 60;
    m.refine.most = 128;
    m.refine.refinable = true;
  });
  return all;
}

class Methods : public testing::TestWithParam<Method> {
 protected:
  Methods() {
    camera_.eye = {.3f, .5f, 3.5f};
    camera_.at = {0, 0, 0};
    camera_.aperture = .1;
    camera_.focus = 3;
  }
  void set_size(int width, int height) {
    camera_.width = width;
    camera_.height = height;
    options_.refine.samples *= static_cast<unsigned>(width * height);
  }
  const Scene scene_ = everything();
  Camera camera_;
  RenderOptions options_ = GetParam().options;
};

TEST_P(Methods, OnePictureForEveryWayOfTracing) {
  set_size(29, 19);
  std::vector<Built> worlds;
  worlds.push_back({"no grid", World(scene_, {.grid = false})});
  worlds.push_back({"a dense grid", World(scene_, {.density = 3})});
  expect_one_picture(worlds, camera_, options_);
}

/// Stopped after every few pieces, gone on with by other threads from a copy.
TEST_P(Methods, StoppedAnywhereGoesOnToTheSameBits) {
  set_size(157, 61);
  const World world(scene_, {});
  RenderOptions o = options_;
  RenderStats all, stats;
  SampleMaps wanted, maps;
  const Image whole = render(world, camera_, o, all, &wanted);
  Random random(3);
  int left = 0, stops = 0;
  const auto go_on = [&] { left = 1 + static_cast<int>(random.below(2)); };
  o.progress = [&](double share) {
    EXPECT_GT(left, 0) << "it was told to stop";
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    return --left > 0;
  };
  grelha::Picture kept(camera_, o);
  RayCounts rays;
  for (bool done = false; !done; ++stops) {
    go_on();
    o.threads = 1 + static_cast<int>(random.below(3));
    grelha::Picture copy = kept;
    done = copy.advance(world, camera_, o, stats, &maps, [&] {  // goes on in place now and then
      EXPECT_TRUE(copy.is_valid());
      go_on();
      ++stops;
      return random.chance(.5);
    });
    ASSERT_TRUE(copy.is_valid());
    ASSERT_EQ(copy.is_finished(), done);
    ASSERT_GE(copy.share_done(), kept.share_done());
    kept = std::move(copy);
    rays += stats.rays;
  }
  EXPECT_GE(stops, 4);
  EXPECT_EQ(differing(kept.image(), whole), 0u);
  EXPECT_EQ(maps.samples, wanted.samples);
  EXPECT_EQ(maps.error, wanted.error);
  EXPECT_EQ(stats.error.samples, all.error.samples);
  EXPECT_EQ(stats.error.rounds, all.error.rounds);
  EXPECT_EQ(rays.total(), all.rays.total()) << "nothing twice";
  EXPECT_TRUE(kept.advance(world, camera_, o, stats, &maps)) << "nothing is left to do";
  EXPECT_EQ(stats.rays.total(), 0u);
  EXPECT_EQ(maps.error, wanted.error);
}

INSTANTIATE_TEST_SUITE_P(All, Methods, testing::ValuesIn(methods()), [](const auto& p) {
  return std::string(p.param.name);
});

}  // namespace
}  // namespace grelha::test
