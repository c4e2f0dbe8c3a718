#include "frontend/commands/first_hits.hpp"

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

}  // namespace grelha
