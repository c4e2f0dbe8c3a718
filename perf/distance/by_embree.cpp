#include "perf/distance/others.hpp"

#if GRELHA_EMBREE
#include <cmath>

#include "kernel/base/vec3.hpp"
#include "perf/embree_api.hpp"

namespace grelha::perf {
namespace {

using Vec = scalar::Vec3<float>;
using scalar::dot;

/// Ericson, Real-Time Collision Detection, 2005, 5.1.5, as Embree's tutorial has it.
Vec closest_on(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
  const Vec ab = b - a, ac = c - a, ap = p - a;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0)
    return a;
  const Vec bp = p - b;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3)
    return b;
  const Vec cp = p - c;
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6)
    return c;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float scale = 1 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

struct Asked {
  const Triangles& t;
  Vec at;
  std::uint32_t id;
};

bool look(RTCPointQueryFunctionArguments* args) {
  Asked& asked = *static_cast<Asked*>(args->userPtr);
  const Triangles& t = asked.t;
  const auto corner = [&](std::uint32_t v) { return Vec{t.x[v], t.y[v], t.z[v]}; };
  const std::uint32_t i = args->primID;
  RTCPointQuery& q = *args->query;
  const Vec p{q.x, q.y, q.z};
  const Vec at = closest_on(p, corner(t.a[i]), corner(t.b[i]), corner(t.c[i]));
  const float distance = scalar::length(at - p);
  if (!(distance < q.radius))
    return false;
  q.radius = distance;
  asked.at = at;
  asked.id = i;
  return true;
}

class Tree : public OtherTree {
 public:
  explicit Tree(const Triangles& t)
      : t_(t), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const v = static_cast<float*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), t.x.size()));
    auto* const c = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), t.size()));
    for (std::size_t i = 0; i < t.x.size(); ++i) {
      v[3 * i] = t.x[i];
      v[3 * i + 1] = t.y[i];
      v[3 * i + 2] = t.z[i];
    }
    for (std::size_t i = 0; i < t.size(); ++i) {
      c[3 * i] = t.a[i];
      c[3 * i + 1] = t.b[i];
      c[3 * i + 2] = t.c[i];
    }
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene_, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(scene_);
  }
  ~Tree() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void closest(std::span<const Float3> points, std::span<ClosestPoint> found) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      RTCPointQuery q{points[i].x, points[i].y, points[i].z, 0, INFINITY};
      Asked asked{t_, {}, kNoPrimitive};
      rtcPointQuery(scene_, &q, &context, look, &asked);
      found[i] = {{asked.at.x, asked.at.y, asked.at.z}, q.radius, asked.id};
    }
  }

 private:
  const Triangles& t_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace

std::unique_ptr<OtherTree> make_embree_tree(const Triangles& t) {
  return std::make_unique<Tree>(t);
}

}  // namespace grelha::perf
#else
namespace grelha::perf {
std::unique_ptr<OtherTree> make_embree_tree(const Triangles&) {
  return nullptr;
}
}  // namespace grelha::perf
#endif
