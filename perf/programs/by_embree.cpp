#ifdef GRELHA_EMBREE

#include <algorithm>
#include <cstring>

#include "perf/embree_api.hpp"
#include "perf/programs/programs.hpp"

namespace grelha::perf::by_embree {

/// The offset of origins and the least t that keep rays from the surface that they leave.
constexpr float kEpsilon = 1e-4f;

/// A robust scene and its device, released together.
struct Built {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);

  explicit Built(const Mesh& mesh) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const vertices = rtcSetNewGeometryBuffer(
        triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.vertices.size());
    std::memcpy(vertices, mesh.vertices.data(), 12 * mesh.vertices.size());
    void* const faces = rtcSetNewGeometryBuffer(
        triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.faces.size());
    std::memcpy(faces, mesh.faces.data(), 12 * mesh.faces.size());
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcCommitScene(scene);
  }
  ~Built() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

static RTCRayHit ray_of(Float3 org, Float3 dir, float t_min) {
  RTCRayHit ray{};
  ray.ray = {
      org.x, org.y, org.z, t_min, dir.x, dir.y, dir.z, 0, __builtin_inff(), 0xFFFFFFFF, 0, 0};
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return ray;
}

// program: ambient occlusion
std::vector<float> ambient_occlusion(const Mesh& mesh) {
  const Built built(mesh);
  EmbreeHint hint(false);
  alignas(32) int valid[8];
  std::fill_n(valid, 8, -1);
  std::vector<float> open(mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto& [a, b, c] = mesh.faces[face];
    const Float3 p = mesh.vertices[a];
    const Float3 normal = normalized(cross(mesh.vertices[b] - p, mesh.vertices[c] - p));
    const Float3 org = mesh.center(face);
    for (std::size_t first = 0; first < kRaysPerFace; first += 8) {
      RTCRay8 rays{};
      for (std::size_t k = 0; k < 8; ++k) {
        const Float3 dir = normal + .999f * on_sphere(face * kRaysPerFace + first + k);
        rays.org_x[k] = org.x;
        rays.org_y[k] = org.y;
        rays.org_z[k] = org.z;
        rays.dir_x[k] = dir.x;
        rays.dir_y[k] = dir.y;
        rays.dir_z[k] = dir.z;
        rays.tnear[k] = kEpsilon;
        rays.tfar[k] = __builtin_inff();
        rays.mask[k] = 0xFFFFFFFF;
      }
      occlude(valid, built.scene, hint, rays);
      for (const float t : rays.tfar)
        open[face] += t < 0 ? 0 : 1.f / kRaysPerFace;
    }
  }
  return open;
}

// program: picking
static Picked pick(const Built& built, const Mesh& mesh, Float3 eye, Float3 dir) {
  EmbreeHint hint(false);
  RTCRayHit ray = ray_of(eye, dir, 0);
  intersect(built.scene, hint, ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return {};
  const float weights[] = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
  const auto nearest = std::max_element(weights, weights + 3) - weights;
  return {ray.hit.primID,
          mesh.faces[ray.hit.primID][static_cast<std::size_t>(nearest)],
          eye + ray.ray.tfar * dir};
}

// program: path tracer
static float radiance(const Built& built, Float3 org, Float3 dir, std::uint64_t number) {
  EmbreeHint hint(false);
  float weight = 1;
  for (int bounce = 0; bounce < kBounces; ++bounce, weight *= kAlbedo) {
    RTCRayHit ray = ray_of(org, dir, kEpsilon);
    intersect(built.scene, hint, ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
      return weight;
    org = org + ray.ray.tfar * dir;
    Float3 normal = normalized({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z});
    normal = dot(normal, dir) < 0 ? normal : -1 * normal;
    dir = normal + .999f * on_sphere(number * kBounces + bounce);
  }
  return 0;
}

std::vector<float> path_trace(const Mesh& mesh, const View& view) {
  const Built built(mesh);
  std::vector<float> pixels(view.width * view.height);
  for (std::size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = radiance(built, view.eye, view.toward(i % view.width, i / view.width), i);
  return pixels;
}

// end
std::vector<Picked> pick(const Mesh& mesh, const View& view, std::size_t clicks) {
  const Built built(mesh);
  std::vector<Picked> picked;
  for (std::size_t i = 0; i < clicks; ++i) {
    const std::size_t pixel = i * 7919 % (view.width * view.height);
    const Float3 dir = view.toward(pixel % view.width, pixel / view.width);
    picked.push_back(pick(built, mesh, view.eye, dir));
  }
  return picked;
}

}  // namespace grelha::perf::by_embree

#endif
