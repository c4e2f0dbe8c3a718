#include "perf/embree.hpp"

#ifdef GRELHA_EMBREE

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "kernel/grid/view.hpp"
#include "perf/embree_api.hpp"
#include "perf/embree_planes.hpp"

namespace grelha::perf {
namespace {

/// Denormals count as zero while Embree works, as its manual recommends; Grelha's own arithmetic
/// does not allow it.
class FlushDenormals {
#if defined(__SSE__)
 public:
  FlushDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | 0x8040);
  }
  ~FlushDenormals() {
    _mm_setcsr(before_);
  }

 private:
  unsigned before_;
#endif
};

template <int kWidth>
using Wide = std::conditional_t<kWidth == 8, RTCRayHit8, RTCRayHit16>;

class Built final : public EmbreeScene {
 public:
  Built(const Scene& scene, RTCSceneFlags flags, RTCBuildQuality quality, bool by_objects = false)
      : device_(rtcNewDevice("threads=1")), quality_(quality) {
    if (!device_)
      throw std::runtime_error("Embree makes no device");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
    // only a scene of two levels, LOW, refits the trees of its geometries
    rtcSetSceneBuildQuality(scene_,
                            quality == RTC_BUILD_QUALITY_REFIT ? RTC_BUILD_QUALITY_LOW : quality);
    const Geometry& g = scene.geometry;
    const auto planes = static_cast<std::uint32_t>(g.planes.size());
    const auto spheres = static_cast<std::uint32_t>(g.spheres.size());
    const auto triangles = static_cast<std::uint32_t>(g.triangles.size());
    add_planes(g);
    add_spheres(g.spheres, planes);
    for (const Object& o :
         by_objects&& are_all(g) ? g.objects : std::vector<Object>{{0, triangles}})
      add_triangles(g.triangles, o, planes + spheres);
    add_cones(g.cones, planes + spheres + triangles);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
      throw std::runtime_error("Embree refuses the scene");
  }
  ~Built() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Built(const Built&) = delete;
  Built& operator=(const Built&) = delete;

  void trace(const RayBuffer& rays, bool any, const EmbreeMode& mode) override {
    t_.resize(rays.size());
    primitive_.resize(rays.size());
    geometry_.resize(rays.size());
    const FlushDenormals flush;
    EmbreeHint hint(mode.coherent);
    any_ = any;
    if (mode.width == 8)
      return wide<8>(rays, hint);
    if (mode.width == 16)
      return wide<16>(rays, hint);
    single(rays, hint);
  }

  Answers answers() const override {
    Answers a;
    if (any_) {
      for (const float t : t_)
        a.blocked.push_back(t == -__builtin_inff());
      return a;
    }
    a.t = t_;
    a.id.assign(t_.size(), kNoPrimitive);
    for (std::size_t i = 0; i < t_.size(); ++i)
      if (geometry_[i] != RTC_INVALID_GEOMETRY_ID)
        a.id[i] = first_[geometry_[i]] +
                  (geometry_[i] == plane_geometry_ ? primitive_[i] / 2 : primitive_[i]);
    return a;
  }

  void move(const Scene& scene, std::size_t object) override {
    moved_.clear();
    if (spheres_ && object == kAll) {
      put_spheres(scene.geometry.spheres, vertices_of(spheres_));
      moved_.push_back(spheres_);
    }
    for (std::size_t i = 0; i < meshes_.size(); ++i)
      if (object == kAll || object == i) {
        put_vertices(scene.geometry.triangles, meshes_[i], vertices_of(meshes_[i].geometry));
        moved_.push_back(meshes_[i].geometry);
      }
  }

  void commit() override {
    for (const RTCGeometry g : moved_) {
      rtcUpdateGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(g);
    }
    rtcCommitScene(scene_);
  }

 private:
  /// A geometry of triangles, and the range of their vertices.
  struct Mesh {
    RTCGeometry geometry;
    std::uint32_t first, end;
  };
  static bool are_all(const Geometry& g) {
    std::size_t sum = 0;
    for (const Object& o : g.objects)
      sum += o.triangle_count;
    return sum == g.triangles.size();
  }
  static float* vertices_of(RTCGeometry g) {
    return static_cast<float*>(rtcGetGeometryBufferData(g, RTC_BUFFER_TYPE_VERTEX, 0));
  }
  static void put_spheres(const Spheres& s, float* v) {
    for (std::size_t i = 0; i < s.size(); ++i) {
      *v++ = s.x[i];
      *v++ = s.y[i];
      *v++ = s.z[i];
      *v++ = std::abs(s.radius[i]);
    }
  }
  static void put_vertices(const Triangles& t, const Mesh& mesh, float* v) {
    for (std::size_t i = mesh.first; i < mesh.end; ++i) {
      *v++ = t.x[i];
      *v++ = t.y[i];
      *v++ = t.z[i];
    }
  }
  void attach(RTCGeometry g, std::uint32_t first) {
    rtcSetGeometryBuildQuality(g, quality_);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene_, g);
    rtcReleaseGeometry(g);
    first_.push_back(first);
  }
  static void* room(
      RTCGeometry g, RTCBufferType type, RTCFormat format, std::size_t stride, std::size_t count) {
    return rtcSetNewGeometryBuffer(g, type, 0, format, stride, count);
  }

  void add_planes(const Geometry& scene) {
    const Planes& p = scene.planes;
    if (p.size() == 0)
      return;
    const Range all = range_of(scene);
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const v =
        static_cast<float*>(room(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12, 4 * p.size()));
    auto* const index =
        static_cast<unsigned*>(room(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 12, 2 * p.size()));
    for (std::size_t i = 0; i < p.size(); ++i) {
      put_square(square_on_plane(p, i, all), kPlaneReach * std::max(all.width(), 1e-3), v + 12 * i);
      const auto base = static_cast<unsigned>(4 * i);
      const unsigned corners[6] = {base, base + 1, base + 2, base, base + 2, base + 3};
      std::copy(corners, corners + 6, index + 6 * i);
    }
    plane_geometry_ = static_cast<unsigned>(first_.size());
    attach(g, 0);
  }

  void add_spheres(const Spheres& s, std::uint32_t first) {
    if (s.size() == 0)
      return;
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    put_spheres(
        s, static_cast<float*>(room(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16, s.size())));
    attach(g, first);
    spheres_ = g;  // the scene keeps it alive
  }

  void add_triangles(const Triangles& t, const Object& o, std::uint32_t first) {
    if (o.triangle_count == 0)
      return;
    const std::size_t begin = o.first_triangle, end = begin + o.triangle_count;
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    Mesh mesh{g, ~0u, 0};
    for (const auto* const corner : {&t.a, &t.b, &t.c})
      for (std::size_t i = begin; i < end; ++i) {
        mesh.first = std::min(mesh.first, (*corner)[i]);
        mesh.end = std::max(mesh.end, (*corner)[i] + 1);
      }
    const std::size_t vertices = mesh.end - mesh.first;
    put_vertices(
        t,
        mesh,
        static_cast<float*>(room(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 12, vertices)));
    auto* index = static_cast<unsigned*>(
        room(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 12, o.triangle_count));
    for (std::size_t i = begin; i < end; ++i)
      for (const auto* const corner : {&t.a, &t.b, &t.c})
        *index++ = (*corner)[i] - mesh.first;
    attach(g, first + o.first_triangle);
    meshes_.push_back(mesh);
  }

  void add_cones(const Cones& c, std::uint32_t first) {
    if (c.size() == 0)
      return;
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
    auto* v =
        static_cast<float*>(room(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 16, 2 * c.size()));
    auto* const index =
        static_cast<unsigned*>(room(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, 4, c.size()));
    for (std::size_t i = 0; i < c.size(); ++i) {
      *v++ = c.base_x[i];
      *v++ = c.base_y[i];
      *v++ = c.base_z[i];
      *v++ = std::abs(c.base_radius[i]);
      *v++ = c.apex_x[i];
      *v++ = c.apex_y[i];
      *v++ = c.apex_z[i];
      *v++ = std::abs(c.apex_radius[i]);
      index[i] = static_cast<unsigned>(2 * i);
    }
    attach(g, first);
  }

  // Fields that are equal for all rays are set once, because Embree does not write to them. Embree
  // loads origin and direction as vectors; scalar stores would stall these loads.
  void single(const RayBuffer& r, EmbreeHint& hint) {
    using Four [[gnu::vector_size(16)]] = float;
    RTCRayHit hit;
    RTCRay& ray = hit.ray;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Four org{r.ox[i], r.oy[i], r.oz[i], r.t_min[i]}, dir{r.dx[i], r.dy[i], r.dz[i], 0};
      std::memcpy(&ray.org_x, &org, sizeof org);  // tnear is the fourth
      std::memcpy(&ray.dir_x, &dir, sizeof dir);  // and time
      ray.tfar = r.t_max[i];
      if (any_) {
        occlude(scene_, hint, ray);
      } else {
        hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        intersect(scene_, hint, hit);
        primitive_[i] = hit.hit.primID;
        geometry_[i] = hit.hit.geomID;
      }
      t_[i] = ray.tfar;
    }
  }

  template <int kWidth>
  void wide(const RayBuffer& r, EmbreeHint& hint) {
    alignas(64) int valid[kWidth];
    std::fill(valid, valid + kWidth, -1);
    Wide<kWidth> hit;
    auto& ray = hit.ray;
    std::memset(ray.time, 0, sizeof ray.time);
    std::memset(ray.mask, 0xFF, sizeof ray.mask);
    std::memset(ray.id, 0, sizeof ray.id);
    std::memset(ray.flags, 0, sizeof ray.flags);
    const auto group = [&](std::size_t i, std::size_t bytes) {
      std::memcpy(ray.org_x, &r.ox[i], bytes);
      std::memcpy(ray.org_y, &r.oy[i], bytes);
      std::memcpy(ray.org_z, &r.oz[i], bytes);
      std::memcpy(ray.dir_x, &r.dx[i], bytes);
      std::memcpy(ray.dir_y, &r.dy[i], bytes);
      std::memcpy(ray.dir_z, &r.dz[i], bytes);
      std::memcpy(ray.tnear, &r.t_min[i], bytes);
      std::memcpy(ray.tfar, &r.t_max[i], bytes);
      if (any_) {
        occlude(valid, scene_, hint, ray);
      } else {
        std::memset(hit.hit.geomID, 0xFF, sizeof hit.hit.geomID);
        std::memset(hit.hit.instID, 0xFF, sizeof hit.hit.instID);
        intersect(valid, scene_, hint, hit);
        std::memcpy(&primitive_[i], hit.hit.primID, bytes);
        std::memcpy(&geometry_[i], hit.hit.geomID, bytes);
      }
      std::memcpy(&t_[i], ray.tfar, bytes);
    };
    std::size_t i = 0;
    for (; i + kWidth <= r.size(); i += kWidth)
      group(i, kWidth * sizeof(float));
    if (i == r.size())
      return;
    for (std::size_t k = 0; k < kWidth; ++k)
      valid[k] = i + k < r.size() ? -1 : 0;
    group(i, (r.size() - i) * sizeof(float));
  }

  RTCDevice device_;
  RTCScene scene_;
  RTCBuildQuality quality_;
  RTCGeometry spheres_ = nullptr;
  std::vector<Mesh> meshes_;
  std::vector<RTCGeometry> moved_;
  std::vector<std::uint32_t> first_;  ///< of Grelha's ids, by Embree's geometry
  unsigned plane_geometry_ = RTC_INVALID_GEOMETRY_ID;
  bool any_ = false;
  std::vector<float> t_;
  std::vector<std::uint32_t> primitive_, geometry_;
};

}  // namespace

std::string embree_name() {
  const RTCDevice device = rtcNewDevice("threads=1");
  const auto part = [&](RTCDeviceProperty of) {
    return static_cast<int>(rtcGetDeviceProperty(device, of));
  };
  char name[64];
  std::snprintf(name,
                sizeof name,
                "Embree %d.%d.%d",
                part(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                part(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                part(RTC_DEVICE_PROPERTY_VERSION_PATCH));
  rtcReleaseDevice(device);
  return name;
}
std::vector<EmbreeMode> embree_modes() {
  return {{"single", 1, false},
          {"8 coherent", 8, true},
          {"8 incoherent", 8, false},
          {"16 coherent", 16, true},
          {"16 incoherent", 16, false}};
}
std::unique_ptr<EmbreeScene> make_embree_scene(const Scene& scene, bool robust) {
  return std::make_unique<Built>(
      scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM);
}
std::unique_ptr<EmbreeScene> make_moving_embree_scene(const Scene& scene, MovingScene how) {
  constexpr RTCBuildQuality kQuality[] = {
      RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_REFIT};
  const auto flags =
      how == MovingScene::kMedium
          ? RTC_SCENE_FLAG_ROBUST
          : static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
  return std::make_unique<Built>(scene, flags, kQuality[static_cast<int>(how)], true);
}

}  // namespace grelha::perf

#else

namespace grelha::perf {
std::string embree_name() {
  return {};
}
std::vector<EmbreeMode> embree_modes() {
  return {};
}
std::unique_ptr<EmbreeScene> make_embree_scene(const Scene&, bool) {
  return nullptr;
}
std::unique_ptr<EmbreeScene> make_moving_embree_scene(const Scene&, MovingScene) {
  return nullptr;
}
}  // namespace grelha::perf

#endif
