#include <algorithm>

#include "grelha/owning_world.hpp"
#include "grelha/query.hpp"
#include "perf/programs/programs.hpp"

namespace grelha::perf::by_grelha {

// program: ambient occlusion
std::vector<float> ambient_occlusion(const Mesh& mesh) {
  const auto triangles = triangles_of<std::uint32_t>(mesh.faces, mesh.vertices.size());
  const Scene scene = scene_of(PointArray(mesh.vertices), triangles);
  const World world(scene, {.threads = 1});
  std::vector<Ray> rays;
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const SurfacePoint at = surface_at(world, face, mesh.center(face));
    for (std::size_t k = 0; k < kRaysPerFace; ++k) {
      const Float3 dir = at.normal + .999f * on_sphere(rays.size());
      rays.push_back({at.start(dir), dir});
    }
  }
  std::vector<std::uint8_t> blocked(rays.size());
  occluded(world, rays, blocked);
  std::vector<float> open(mesh.faces.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    open[i / kRaysPerFace] += blocked[i] ? 0 : 1.f / kRaysPerFace;
  return open;
}

// program: picking
static Picked pick(const World& world, const Mesh& mesh, Float3 eye, Float3 dir) {
  std::uint32_t id = kNoPrimitive;
  float t = 0, u = 0, v = 0;
  closest(world, Rays::of({&eye, 1}, {&dir, 1}), {.t = &t, .id = &id, .u = &u, .v = &v});
  if (id == kNoPrimitive)
    return {};
  const float weights[] = {1 - u - v, u, v};
  const auto nearest = std::max_element(weights, weights + 3) - weights;
  return {id, mesh.faces[id][static_cast<std::size_t>(nearest)], eye + t * dir};
}

// program: path tracer
static float radiance(const World& world, Ray ray, std::uint64_t number) {
  float weight = 1;
  for (int bounce = 0; bounce < kBounces; ++bounce, weight *= kAlbedo) {
    const Hit hit = closest(world, ray);
    if (!hit)
      return weight;
    const SurfacePoint at = surface(world, ray, hit);
    const Float3 normal = dot(at.normal, ray.dir) < 0 ? at.normal : -1 * at.normal;
    const Float3 dir = normal + .999f * on_sphere(number * kBounces + bounce);
    ray = {at.start(dir), dir};
  }
  return 0;
}

std::vector<float> path_trace(const Mesh& mesh, const View& view) {
  const auto triangles = triangles_of<std::uint32_t>(mesh.faces, mesh.vertices.size());
  const Scene scene = scene_of(PointArray(mesh.vertices), triangles);
  const World world(scene, {.threads = 1});
  std::vector<float> pixels(view.width * view.height);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = radiance(world, {view.eye, view.toward(i % view.width, i / view.width)}, i);
  return pixels;
}

// end
std::vector<Picked> pick(const Mesh& mesh, const View& view, std::size_t clicks) {
  const auto triangles = triangles_of<std::uint32_t>(mesh.faces, mesh.vertices.size());
  const Scene scene = scene_of(PointArray(mesh.vertices), triangles);
  const World world(scene, {.threads = 1});
  std::vector<Picked> picked;
  for (std::size_t i = 0; i < clicks; ++i) {
    const std::size_t pixel = i * 7919 % (view.width * view.height);
    const Float3 dir = view.toward(pixel % view.width, pixel / view.width);
    picked.push_back(pick(world, mesh, view.eye, dir));
  }
  return picked;
}

}  // namespace grelha::perf::by_grelha
