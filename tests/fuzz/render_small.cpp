#include "tests/fuzz/render_small.hpp"

#include <cstring>

#include "frontend/commands/report.hpp"
#include "frontend/input/effects.hpp"
#include "frontend/jobs/identity.hpp"
#include "grelha/render.hpp"

namespace grelha::fuzz {
namespace {

constexpr int kSide = 8;

/// Returns the estimated cost of a picture: primitives times the rays that each hit point may
/// trace.
std::size_t cost_of(const Scene& scene) {
  const Geometry& g = scene.geometry;
  return (g.spheres.size() + g.triangles.size() + g.cones.size() + g.planes.size()) *
         (1 + scene.lights.size());
}

Effects some_effects(Choices& choices) {
  Effects e;
  e.samples = 1 + int(choices.below(3));
  e.seed = std::uint32_t(choices.below(3));
  if (choices.below(4) == 0)
    e.shadows = Effects::Shadows{false, .25f, 1 + int(choices.below(2))};
  if (choices.below(6) == 0)
    e.shadows = Effects::Shadows{true, 0, 1};
  if (choices.below(6) == 0)
    e.lens = Effects::Lens{3, 0, 0};
  if (choices.below(6) == 0)
    e.glossy = Effects::Glossy{.2f, int(choices.below(3))};
  if (choices.below(8) == 0)
    e.adaptive = {true, .1f, 2};
  return e;
}

/// Options that change no bit of a picture.
struct Way {
  BuildOptions build;
  std::string_view isa = "scalar";
  int packet = 1;
  bool mailbox = false;
};

Way some_way(Choices& choices) {
  constexpr float kDensities[] = {0, .35f, 3};
  constexpr int kPackets[] = {1, 16, 64, 256};
  Way way;
  way.build.density = choices.of(kDensities);
  way.packet = choices.of(kPackets);
  way.mailbox = choices.below(4) != 0;
  std::vector<std::string_view> names;
  for (const Isa& isa : isas())
    if (isa.is_supported)
      names.push_back(isa.name);
  way.isa = names[choices.below(names.size())];
  return way;
}

Image picture(const SceneFile& file, RenderOptions options, Way way) {
  way.build.threads = options.threads = 1;
  options.isa = way.isa;
  options.packet = way.packet;
  options.mailbox = way.mailbox;
  const World world(file.scene, way.build);
  promise(!info_text("scene", file, {}, world.grids()).empty() &&
              !info_json(file, {}, world.grids()).empty(),
          "info says something");
  RenderStats stats;
  return render(world, file.camera, options, stats);
}

}  // namespace

void render_small(SceneFile file, Choices choices) {
  constexpr std::size_t kMostAlone = 50000, kMostTwice = 4000;
  const std::size_t cost = cost_of(file.scene);
  if (cost > kMostAlone)
    return;
  scene_digest(file);
  RenderOptions options;
  Effects effects = some_effects(choices);
  if (!effects.adaptive.on && choices.below(8) == 0) {
    options.refine.samples = kSide * kSide * 12;
    effects.samples.reset();  // the most of a pixel, then
  }
  apply_effects(effects, file, options);
  file.camera.width = file.camera.height = kSide;
  options.depth = 1 + int(choices.below(5));
  const Image image = picture(file, options, some_way(choices));
  if (cost > kMostTwice)
    return;
  Way plain;
  plain.build.grid = false;
  const Image other = picture(file, options, plain);
  promise(std::memcmp(image.rgb.data(), other.rgb.data(), image.rgb.size() * sizeof(float)) == 0,
          "the same bits by every way of rendering");
}

}  // namespace grelha::fuzz
