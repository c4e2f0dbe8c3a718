#include <limits>
#include <vector>

#include "grelha/all_hits.hpp"
#include "kernel/query/lists.hpp"
#include "kernel/shapes/hit.hpp"

namespace grelha {
namespace {

/// The triangles that a ray crosses, edges and vertices decided by simulation of simplicity.
class CrossingList : public ListedRay {
 public:
  using ListedRay::ListedRay;
  static constexpr Wanted kWanted = Wanted::kTriangles;

  std::uint32_t count(std::span<const Candidate> candidates) {
    std::uint32_t sum = 0;
    for (const Candidate& c : candidates)
      if (crosses(c))
        each_passing(c.id, [&](std::uint32_t) { ++sum; });
    return sum;
  }

  /// In the order in which the ray crosses them.
  void find(std::span<const Candidate> candidates, std::vector<Crossing>& crossings) {
    found_.clear();
    for (const Candidate& c : candidates) {
      if (!crosses(c))
        continue;
      CrossedTriangle one{c.id, c, -kNoEnd, kNoEnd};
      double lo = 0;
      double hi = 0;
      if (c.sure > 0 && bound_plane(c, lo, hi)) {
        one.lo = lo;
        one.hi = hi;
      }
      each_passing(c.id, [&](std::uint32_t id) {
        one.id = id;
        found_.push_back(one);
      });
    }
    sort_crossings(found_, [this](const CrossedTriangle& a, const CrossedTriangle& b) {
      return is_before(a, b);
    });
    for (const CrossedTriangle& f : found_)
      crossings.push_back({t_of(f), f.id, is_crossed_inwards(scaled(), corners(f).corner)});
  }

 private:
  struct CrossedTriangle {
    std::uint32_t id;
    Candidate original;
    double lo, hi;  ///< t lies between
  };
  static Triangle::Fields<float> corners(const CrossedTriangle& f) {
    return scalar::triangle_of(*f.original.block, f.original.index);
  }

  bool crosses(const Candidate& c) {
    return c.block &&
           (c.sure > 0 || crosses_perturbed(scaled(), scalar::triangle_of(*c.block, c.index)));
  }

  bool is_before(const CrossedTriangle& a, const CrossedTriangle& b) {
    if (a.hi < b.lo || b.hi < a.lo)
      return a.hi < b.lo;
    const int order = order_perturbed(scaled(), corners(a).corner, corners(b).corner);
    return order != 0 ? order < 0 : a.id < b.id;
  }

  float t_of(const CrossedTriangle& f) {
    return rounded(scaled(), f.lo, f.hi, [&](const ExactRay& ray) {
      const Triangle::Fields<float> triangle = corners(f);
      float t = 0;
      return scalar::round_plane_t(ray, triangle.corner, t)
                 ? t
                 : cross_plane_of(ray, triangle.corner).rounded();
    });
  }

  static constexpr double kNoEnd = std::numeric_limits<double>::infinity();
  std::vector<CrossedTriangle> found_;
};

}  // namespace

std::vector<Crossing> crossings(const World& world, const Ray& ray, const Filter& filter) {
  return list_one<CrossingList, Crossing>(world, ray, filter);
}

CrossingLists crossings(const World& world, const Rays& rays, const QueryOptions& options) {
  CrossingLists lists;
  list_each<CrossingList>(world, rays, options, lists.offset, lists.crossings);
  return lists;
}

std::size_t count_crossings(const World& world, const Ray& ray, const Filter& filter) {
  std::uint32_t count = 0;
  Rays one = Rays::of({&ray, 1});
  one.skip = &filter.skip;
  one.mask = &filter.mask;
  count_crossings(world, one, &count, {.mask = filter.masks});
  return count;
}

void count_crossings(const World& world,
                     const Rays& rays,
                     std::uint32_t* counts,
                     const QueryOptions& options) {
  count_each<CrossingList>(world, rays, counts, options, "count_crossings");
}

}  // namespace grelha
