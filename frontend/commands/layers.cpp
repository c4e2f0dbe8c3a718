#include "frontend/commands/layers.hpp"

#include <algorithm>

#include "grelha/query.hpp"

namespace grelha {
namespace {

/// Turns a normal towards the side that the ray comes from.
Float3 facing(const Float3& normal, const Float3& direction) {
  const float cosine = (normal.x * direction.x + normal.y * direction.y) + normal.z * direction.z;
  return cosine > 0 ? Float3{-normal.x, -normal.y, -normal.z} : normal;
}

}  // namespace

Layers first_hits(const World& world,
                  const Camera& camera,
                  const Frame& frame_of_scene,
                  const LayerChoice& wanted) {
  std::vector<Ray> rays(std::size_t(camera.width));
  std::vector<Hit> hits(rays.size());
  const std::size_t pixels = rays.size() * std::size_t(camera.height);
  Layers layers;
  if (wanted.depth)
    layers.depth.reserve(pixels);
  if (wanted.normal)
    layers.normal.reserve(3 * pixels);
  if (wanted.id)
    layers.id.reserve(pixels);
  for (int y = 0; y < camera.height; ++y) {
    camera_rays(camera, y, rays);
    closest(world, rays, hits);
    for (std::size_t x = 0; x < rays.size(); ++x) {
      const Hit& hit = hits[x];
      if (wanted.depth)
        layers.depth.push_back(static_cast<float>(hit.t / frame_of_scene.scale));
      if (wanted.id)
        layers.id.push_back(hit.id);
      if (!wanted.normal)
        continue;
      const Ray& ray = rays[x];
      const Float3 n = hit ? facing(surface(world, ray, hit).shading, ray.dir) : Float3{};
      layers.normal.insert(layers.normal.end(), {n.x, n.y, n.z});
    }
  }
  return layers;
}

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
