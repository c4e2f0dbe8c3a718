// Tests the identity of a picture: the digest of its scene, and the settings that its pixels depend
// on.
#include <sstream>
#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/jobs/identity.hpp"
#include "frontend/nff/nff_reader.hpp"
#include "scenes/generators.hpp"

#include <gtest/gtest.h>

namespace grelha::test {
namespace {

TEST(Identity, DigestIsAsItEverWas) {
  SceneFile file;
  file.scene.geometry.spheres.add({1, 2, 3}, .5f, 0);
  file.scene.materials.resize(1);
  file.scene.lights.resize(1);
  EXPECT_EQ(scene_digest(file), "6e4745191fd0407733d7548d5b6c0043");
}

TEST(Identity, KnowsAnotherScene) {
  std::ostringstream text;
  scenes::find_generator("balls")->write(text, {2, false, ""});
  const SceneFile file = read_nff("balls", text.str(), [](const std::string&) {});
  const std::string digest = scene_digest(file);
  const auto changed = [&](auto change) {
    SceneFile other = file;
    change(other);
    return scene_digest(other) != digest;
  };
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.geometry.spheres.x[3] += .001f; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.geometry.spheres.material[3] ^= 1; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.geometry.planes.nz[0] = .5f; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.materials[0].shine += 1; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.materials[0].fresnel ^= true; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.lights[0].edge2.x = 1; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.scene.background.y += .1f; }));
  EXPECT_TRUE(changed([](SceneFile& f) {
    Triangles& t = f.scene.geometry.triangles;
    t.red = t.green = t.blue = {.5f};
  }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.camera.eye.z += .1f; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.camera.angle_deg += .1; }));
  EXPECT_TRUE(changed([](SceneFile& f) { f.camera.orthographic_height = 1; }));
  EXPECT_TRUE(changed([](SceneFile& f) {
    auto& s = f.scene.geometry.spheres;  // a number that ends one array begins the next
    s.y.insert(s.y.begin(), s.x.back());
    s.x.pop_back();
  }));
  EXPECT_FALSE(changed([](SceneFile& f) { f.scene.geometry.objects.push_back({}); }));
}

TEST(Identity, NamesAllThatPixelsDependOn) {
  RenderCommand command;
  Camera camera;
  const std::string plain = settings_text(command, camera);
  const auto words = [&](auto change) {
    RenderCommand c;
    Camera k;
    change(c, k);
    return difference(settings_text(c, k), plain, "a");
  };
  EXPECT_EQ(words([](RenderCommand&, Camera& k) { k.width = 7; }),
            "size=7x512, a has size=512x512");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) {
              c.render.sampling.samples = 2;
              c.render.sampling.seed = 4;
            }),
            "samples=2 seed=4, a has samples=1 seed=0");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.sampling.sampler = Sampler::kJitter; }),
            "sampler=jitter, a has sampler=sobol");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.depth = 6; }), "depth=6, a has depth=5");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.min_weight = 0; }),
            "min-weight=0, a has min-weight=6.103515625e-05");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.refine.error = .01; }),
            "error=0.01 no samples=, a has samples=1 no error=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.refine.seconds = 2.5; }),
            "time=2.5 no samples=, a has samples=1 no time=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.refine.samples = 7; }),
            "time=samples:7 no samples=, a has samples=1 no time=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) {
              c.render.refine.error = .01;
              c.render.refine.most = 64;
            }),
            "error=0.01 samples=64, a has samples=1 no error=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) {
              c.render.subdivision = {true, .1f, 2};
            }),
            "adaptive=0.1,2, a has no adaptive=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.effects.shadows = Effects::Shadows{true}; }),
            "shadows=hard, a has no shadows=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) { c.render.sampling.light_rays = 3; }),
            "light-rays=3, a has no light-rays=");
  EXPECT_EQ(words([](RenderCommand&, Camera& k) {
              k.aperture = .1;
              k.focus = 2;
            }),
            "aperture=0.1 focus=2, a has no aperture= no focus=");
  EXPECT_EQ(words([](RenderCommand& c, Camera&) {
              c.effects.glossy = {.5f, 2};
              c.render.sampling.glossy_rays = 2;
            }),
            "roughness=0.5 gloss-rays=2, a has no roughness= no gloss-rays=");
  RenderCommand other;
  other.render.threads = 3;
  other.render.isa = "sse2";
  other.render.packet = 16;
  EXPECT_EQ(settings_text(other, camera), plain);
}

TEST(Identity, PrintsNothingOfAFileAsItStands) {
  const std::string long_word = "depth=" + std::string(1000, '5'),
                    cut = "depth=" + std::string(34, '5') + "...";
  EXPECT_EQ(difference("\x1b[2Jseed=\a1 " + long_word, "seed=1", "a"),
            "?[2Jseed=?1 " + cut + " no seed=, a has seed=1 no ?[2Jseed= no depth=");
  std::string many;
  for (int i = 0; i < 1000; ++i)
    many += " w" + std::to_string(i) + "=1";
  EXPECT_EQ(difference(many, "w0=1", "a"),
            "w1=1 w2=1 w3=1 w4=1 w5=1 w6=1 w7=1 w8=1 ..., a has no w1= no w2= no w3= no w4= no w5= "
            "no w6= no w7= no w8= ...");
}

}  // namespace
}  // namespace grelha::test
