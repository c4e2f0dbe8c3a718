#include "perf/build/embree_build.hpp"

#ifdef GRELHA_EMBREE

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "perf/build/clock.hpp"
#include "perf/embree_api.hpp"

namespace grelha::perf {
namespace {

class Builds final : public EmbreeBuilds {
 public:
  Builds(const Scene& scene, int threads) : threads_(threads) {
    const Geometry& g = scene.geometry;
    for (std::size_t i = 0; i < g.spheres.size(); ++i)
      spheres_.insert(
          spheres_.end(),
          {g.spheres.x[i], g.spheres.y[i], g.spheres.z[i], std::abs(g.spheres.radius[i])});
    const Triangles& t = g.triangles;
    for (std::size_t i = 0; i < t.vertex_count(); ++i)
      vertices_.insert(vertices_.end(), {t.x[i], t.y[i], t.z[i]});
    vertices_.push_back(0);  // it reads four floats at a time
    for (std::size_t i = 0; i < t.size(); ++i)
      indices_.insert(indices_.end(), {t.a[i], t.b[i], t.c[i]});
    geometry_bytes_ = spheres_.size() * sizeof(float) + vertices_.size() * sizeof(float) +
                      indices_.size() * sizeof(indices_[0]);
  }
  Built build(Quality quality) override {
    const auto wanted = quality == Quality::kLow ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    // a device of its own: of all that live, Embree takes the most threads
    device_ = rtcNewDevice(("threads=" + std::to_string(threads_)).c_str());
    bytes_ = 0;
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* sum, ssize_t bytes, bool) {
          __atomic_add_fetch(static_cast<std::int64_t*>(sum), bytes, __ATOMIC_RELAXED);
          return true;
        },
        &bytes_);
    const std::int64_t before = bytes_now();
    const RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, wanted);
    if (!spheres_.empty())
      attach_spheres(scene, wanted);
    if (!indices_.empty())
      attach_triangles(scene, wanted);
    const Clock clock;
    rtcCommitScene(scene);
    const double seconds = clock.seconds();
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
      throw std::runtime_error("Embree refuses the scene");
    const double bytes =
        static_cast<double>(bytes_now() - before) + static_cast<double>(geometry_bytes_);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device_);
    return {seconds, bytes};
  }

 private:
  std::int64_t bytes_now() const { return __atomic_load_n(&bytes_, __ATOMIC_RELAXED); }

  /// Whole elements of so many bytes.
  template <class T>
  static void share(RTCGeometry g,
                    RTCBufferType type,
                    RTCFormat format,
                    const std::vector<T>& data,
                    std::size_t stride) {
    const std::size_t count = data.size() * sizeof(T) / stride;
    rtcSetSharedGeometryBuffer(g, type, 0, format, data.data(), 0, stride, count);
  }

  void attach_spheres(RTCScene scene, RTCBuildQuality quality) {
    const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    share(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres_, 16);
    attach(scene, g, quality);
  }

  void attach_triangles(RTCScene scene, RTCBuildQuality quality) {
    const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    share(g, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices_, 12);
    share(g, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, indices_, 12);
    attach(scene, g, quality);
  }

  static void attach(RTCScene scene, RTCGeometry g, RTCBuildQuality quality) {
    rtcSetGeometryBuildQuality(g, quality);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
  }
  const int threads_;
  RTCDevice device_ = nullptr;
  std::int64_t bytes_ = 0;
  std::size_t geometry_bytes_ = 0;
  std::vector<float> spheres_, vertices_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

bool has_embree() {
  return true;
}
std::unique_ptr<EmbreeBuilds> make_embree_builds(const Scene& scene, int threads) {
  return std::make_unique<Builds>(scene, threads);
}

}  // namespace grelha::perf

#else

namespace grelha::perf {
bool has_embree() {
  return false;
}
std::unique_ptr<EmbreeBuilds> make_embree_builds(const Scene&, int) {
  return nullptr;
}
}  // namespace grelha::perf

#endif
