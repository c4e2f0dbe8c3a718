#include "frontend/commands/first_hits.hpp"

#include <cmath>

#include "kernel/scene/frame.hpp"
#include "grelha/query.hpp"

namespace grelha {
namespace {

/// The rays of one row of pixels, as the kernel's camera_rays() sends them.
void aim(const FrameView& frame, int y, std::vector<Ray>& rays) {
  const float sy = .5f * float(frame.height) - (float(y) + .5f);
  for (std::size_t x = 0; x < rays.size(); ++x) {
    const float sx = (float(x) + .5f) - .5f * float(frame.width);
    float d[3];
    for (int k = 0; k < 3; ++k)
      d[k] = (frame.forward[k] + sx * frame.right[k]) + sy * frame.up[k];
    const float length = std::sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
    rays[x].org = {frame.eye[0], frame.eye[1], frame.eye[2]};
    rays[x].dir = {d[0] / length, d[1] / length, d[2] / length};
  }
}

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
  const FrameView frame = make_frame(camera);
  std::vector<Ray> rays(std::size_t(frame.width));
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
    aim(frame, y, rays);
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
