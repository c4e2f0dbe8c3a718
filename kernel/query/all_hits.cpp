#include "grelha/all_hits.hpp"

#include <cmath>

#include "kernel/query/lists.hpp"
#include "kernel/shapes/hit.hpp"

namespace grelha {
namespace {

/// Crossings of one primitive count as one where they are within kSameCrossing * t.
constexpr double kSameCrossing = 0x1p-45;

/// The hits of a ray.
class HitList : public ListedRay {
 public:
  using ListedRay::ListedRay;
  static constexpr Wanted kWanted = Wanted::kAll;

  std::uint32_t count(std::span<const Candidate> candidates) {
    std::uint32_t sum = 0;
    Crossing found[2];
    for (const Candidate& c : candidates) {
      const int crossings = c.sure > 0 ? c.sure : find(c.id, found);
      if (crossings > 0)
        each_passing(c.id, [&](std::uint32_t) { sum += static_cast<std::uint32_t>(crossings); });
    }
    return sum;
  }

  /// In order of the exact t, then of id.
  void find(std::span<const Candidate> candidates, std::vector<Hit>& hits) {
    crossings_.clear();
    for (const Candidate& c : candidates) {
      Crossing found[2];
      const int count = find(c, found);
      for (int k = 0; k < count; ++k)
        each_passing(c.id, [&](std::uint32_t id) {
          crossings_.push_back(found[k]);
          crossings_.back().id = id;
        });
    }
    sort_crossings(crossings_,
                   [this](const Crossing& a, const Crossing& b) { return is_before(a, b); });
    for (const Crossing& c : crossings_) {
      const auto exactly = [&](const ExactRay& ray) {
        return rounded_t(scene_.geometry, ray, c.original);
      };
      hits.push_back({rounded(ray_from(c.t_min), c.lo, c.hi, exactly), c.id});
    }
  }

 private:
  /// One crossing: the first of a primitive beyond `t_min`.
  struct Crossing {
    std::uint32_t id;
    std::uint32_t original;  ///< see CopyTable
    double t_min, lo, hi;
  };

  ExactRay ray_from(double t_min) {
    ExactRay ray = scaled();
    ray.t_min = t_min;
    return ray;
  }

  /// The crossings of one candidate.
  int find(const Candidate& c, Crossing (&to)[2]) {
    to[0] = {c.id, c.id, scaled().t_min, 0, 0};
    if (c.block && c.sure > 0 && bound_plane(c, to[0].lo, to[0].hi))
      return 1;
    return find(c.id, to);
  }
  int find(std::uint32_t id, Crossing (&to)[2]) {
    const GeometryView& g = scene_.geometry;
    // a ray crosses the side of a cone twice at most, a sphere twice, others once
    const bool is_flat =
        g.ids.has(PrimitiveKind::kTriangle, id) || g.ids.has(PrimitiveKind::kPlane, id);
    int count = 0;
    for (double t_min = scaled().t_min; count < (is_flat ? 1 : 2); ++count) {
      const ExactRay ray = ray_from(t_min);
      CrossingBounds found = crossing_bounds(g, ray, id);
      if (!found.some || found.lo >= ray.t_max)
        break;
      if (!found.sure || found.hi >= ray.t_max) {
        const ExactCrossing exact = crossing_of(g, ray, id);
        if (!exact.some() || exact.compare(ray.t_max) >= 0)
          break;
        const double t = exact.estimate();
        found.lo = t - std::abs(t) * 0x1p-49;
        found.hi = t + std::abs(t) * 0x1p-49;
      }
      to[count] = {id, id, t_min, found.lo, found.hi};
      t_min = found.hi + std::abs(found.hi) * kSameCrossing;
    }
    return count;
  }

  bool is_before(const Crossing& a, const Crossing& b) {
    if (a.hi < b.lo || b.hi < a.lo)
      return a.hi < b.lo;
    if (a.original == b.original)
      return a.t_min != b.t_min ? a.t_min < b.t_min : a.id < b.id;
    const GeometryView& g = scene_.geometry;
    const int order = crossing_of(g, ray_from(a.t_min), a.original)
                          .compare(crossing_of(g, ray_from(b.t_min), b.original));
    return order != 0 ? order < 0 : a.id < b.id;
  }

  std::vector<Crossing> crossings_;
};

}  // namespace

std::vector<Hit> all_hits(const World& world, const Ray& ray, const Filter& filter) {
  return list_one<HitList, Hit>(world, ray, filter);
}

void all_hits(const World& world,
              const Ray& ray,
              const std::function<bool(const Hit&)>& visit,
              const Filter& filter) {
  for (const Hit& hit : all_hits(world, ray, filter))
    if (!visit(hit))
      return;
}

HitLists all_hits(const World& world, const Rays& rays, const QueryOptions& options) {
  HitLists lists;
  list_each<HitList>(world, rays, options, lists.offset, lists.hits);
  return lists;
}

void count_hits(const World& world,
                const Rays& rays,
                std::uint32_t* counts,
                const QueryOptions& options) {
  count_each<HitList>(world, rays, counts, options, "count_hits");
}

}  // namespace grelha
