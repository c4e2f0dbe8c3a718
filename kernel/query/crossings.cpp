#include <algorithm>
#include <vector>

#include "grelha/all_hits.hpp"
#include "kernel/query/along_ray.hpp"
#include "kernel/query/options.hpp"
#include "kernel/query/runs.hpp"

namespace grelha {
namespace {

/// Gathers the triangles that one ray crosses, edges and vertices decided by simulation of
/// simplicity.
class Crossings {
 public:
  Crossings(const ExactRay& ray, double t_max) : ray_(ray), t_max_(t_max) {}

  void primitive(std::uint32_t) {}
  void block(const TriangleBlock& block) {
    for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i)
      if (crosses(scalar::triangle_of(block, i)))
        ids_.push_back(block.id[i]);
  }
  /// Number of triangles; one that stands in several cells counts once.
  std::size_t count() {
    std::sort(ids_.begin(), ids_.end());
    return static_cast<std::size_t>(std::unique(ids_.begin(), ids_.end()) - ids_.begin());
  }

 private:
  bool crosses(const Triangle::Fields<float>& triangle) const {
    const scalar::HitInterval<double> found = scalar::bound_triangle(ray_, triangle.corner);
    if (!found.some || found.lo >= t_max_)
      return false;
    if (found.sure && found.hi < t_max_)
      return true;
    return crosses_beside(ray_, triangle.corner, t_max_);
  }

  ExactRay ray_;
  double t_max_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace

std::size_t count_crossings(const World& world, const Ray& ray) {
  const SceneView& scene = world.impl().view;
  const PreparedRay prepared(scene, ray);
  if (!prepared.valid)
    return 0;
  Crossings crossings(prepared.exact(), prepared.single.best);
  AlongRay(scene, prepared, crossings);
  return crossings.count();
}

bool contains(const World& world, Float3 point) {
  // no axis, plane of a lattice or diagonal of a cube: fewer edges to decide
  constexpr Float3 kDirection{.4375f, .8125f, .3125f};
  return count_crossings(world, {point, kDirection}) % 2 == 1;
}

void contains(const World& world,
              std::span<const Float3> points,
              std::span<std::uint8_t> inside,
              const QueryOptions& options) {
  expect_same_size(points.size(), inside.size(), "points");
  each_run(points.size(), options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      inside[i] = contains(world, points[i]);
  });
}

}  // namespace grelha
