#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "grelha/all_hits.hpp"
#include "kernel/query/filters.hpp"
#include "kernel/query/hit_list.hpp"
#include "kernel/query/lists.hpp"

namespace grelha {
namespace {

/// Gathers the triangles that one ray crosses, edges and vertices decided by simulation of
/// simplicity.
class CrossingList {
 public:
  CrossingList(const World& world, const Ray& ray, const Filter& filter)
      : scene_(world.impl().view), filter_(filter), given_(ray), prepared_(scene_, ray) {
    if (!prepared_.valid)
      return;
    ray_ = prepared_.exact();
    walk_scene(scene_, prepared_.single, *this);
    std::sort(found_.begin(), found_.end(), [](const CrossedTriangle& a, const CrossedTriangle& b) {
      return a.id < b.id;
    });
    // a triangle may stand in several cells
    const auto same = [](const CrossedTriangle& a, const CrossedTriangle& b) {
      return a.id == b.id;
    };
    found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
    apply_filter();
  }

  // For walk_scene().
  static constexpr bool kInAnyOrder = true;
  bool block(const scalar::Single&, const TriangleBlock& block) {
    for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i)
      take(block.id[i], scalar::triangle_of(block, i));
    return false;
  }
  bool arrays(const scalar::Single&, const CellLists&, std::size_t) { return false; }

  std::size_t count() const { return found_.size(); }

  /// In the order in which the ray crosses them.
  std::vector<Crossing> in_order() {
    std::stable_sort(
        found_.begin(), found_.end(), [this](const CrossedTriangle& a, const CrossedTriangle& b) {
          return is_before(a, b);
        });
    std::vector<Crossing> crossings;
    for (const CrossedTriangle& f : found_)
      crossings.push_back(
          {scalar::strictly_between(t_of(f), given_.t_min, given_.t_max), f.id, enters(f)});
    return crossings;
  }

 private:
  struct CrossedTriangle {
    std::uint32_t id;
    Triangle::Fields<float> triangle;
    double lo, hi;  ///< t lies between, in multiples of the prepared ray's unit
  };

  void take(std::uint32_t id, const Triangle::Fields<float>& triangle) {
    const scalar::HitInterval<double> bound = scalar::bound_triangle(ray_, triangle.corner);
    if (!bound.some || bound.lo >= ray_.t_max)
      return;
    const bool is_sure = bound.sure && bound.hi < ray_.t_max;
    if (is_sure)
      found_.push_back({id, triangle, bound.lo, bound.hi});
    else if (crosses_beside(ray_, triangle.corner))
      found_.push_back({id, triangle, -kNoEnd, kNoEnd});
  }

  /// Replaces originals by themselves and their copies, as far as these pass.
  void apply_filter() {
    if (scene_.copies.count == 0 && filter_.skip == kNoPrimitive && filter_.masks.empty())
      return;
    std::vector<CrossedTriangle> all;
    const auto add = [&](CrossedTriangle f, std::uint32_t id) {
      f.id = id;
      if (passes(filter_, id))
        all.push_back(f);
    };
    const CopyTable& copies = scene_.copies;
    for (const CrossedTriangle& f : found_) {
      add(f, f.id);
      for (std::uint32_t i = copies.begin(f.id); copies.has(i, f.id); ++i)
        add(f, copies.pair[i].copy);
    }
    found_ = std::move(all);
  }

  bool is_before(const CrossedTriangle& a, const CrossedTriangle& b) const {
    if (a.hi < b.lo || b.hi < a.lo)
      return a.hi < b.lo;
    const int order = order_beside(ray_, a.triangle.corner, b.triangle.corner);
    return order != 0 ? order < 0 : a.id < b.id;
  }

  float t_of(const CrossedTriangle& f) const {
    const ExactRay ray = prepared_.given(ray_);
    float t = 0;
    if (!scalar::round_plane_t(ray, f.triangle.corner, t))
      t = cross_plane_of(ray, f.triangle.corner).rounded() + 0.f;  // no zero is -0
    return t;
  }
  bool enters(const CrossedTriangle& f) const { return crosses_front(ray_, f.triangle.corner); }

  static constexpr double kNoEnd = std::numeric_limits<double>::infinity();

  const SceneView& scene_;
  const Filter& filter_;
  Ray given_;
  PreparedRay prepared_;
  ExactRay ray_{};
  std::vector<CrossedTriangle> found_;
};

}  // namespace

std::vector<Crossing> crossings(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  return CrossingList(world, ray, filter).in_order();
}

CrossingLists crossings(const World& world, const Rays& rays, const QueryOptions& options) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  CrossingLists lists;
  list_each(rays.count, options, lists.offset, lists.crossings, [&](std::size_t i) {
    return CrossingList(world, ray_of(rays, i), filter_of(rays, options, i)).in_order();
  });
  return lists;
}

std::size_t count_crossings(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  return CrossingList(world, ray, filter).count();
}

void count_crossings(const World& world,
                     const Rays& rays,
                     std::uint32_t* counts,
                     const QueryOptions& options) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  if (!counts && rays.count > 0)
    throw std::invalid_argument("count_crossings: expected an array of counts, found null");
  each_run(rays.count, options, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      counts[i] = static_cast<std::uint32_t>(
          CrossingList(world, ray_of(rays, i), filter_of(rays, options, i)).count());
  });
}

}  // namespace grelha
