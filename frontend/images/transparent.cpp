#include "frontend/images/transparent.hpp"

#include <algorithm>

namespace grelha {
namespace {

/// A second picture takes few rays: those of the camera alone.
constexpr double kShareOfLight = .9;

/// Progress of a part of the work.
std::function<bool(double)> part_of(const std::function<bool(double)>& all,
                                    double from,
                                    double share) {
  if (!all)
    return {};
  return [=](double done) { return all(from + share * done); };
}

}  // namespace

Image render_transparent(const World& world,
                         const Camera& camera,
                         const RenderOptions& options,
                         RenderStats& stats,
                         Alpha& alpha) {
  RenderOptions light = options, misses = options;
  light.progress = part_of(options.progress, 0, kShareOfLight);
  misses.progress = part_of(options.progress, kShareOfLight, 1 - kShareOfLight);
  misses.misses = true;
  Image image = render(world, camera, light, stats);
  RenderStats ignored;
  const Image missed = render(world, camera, misses, ignored);
  const Float3& b = options.lighting->background;
  const float background[] = {b.x, b.y, b.z};
  alpha.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float m = missed.rgb[i];
    alpha[i / 3] = 1 - m;
    // sums are rounded: where nothing is hit nothing may remain
    image.rgb[i] = m < 1 ? std::max(0.f, image.rgb[i] - m * background[i % 3]) : 0;
  }
  return image;
}

}  // namespace grelha
