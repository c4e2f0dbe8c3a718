#pragma once
// All hits of one ray, in order.

#include <vector>

#include "grelha/query.hpp"
#include "kernel/query/prepared_ray.hpp"

namespace grelha {

/// True if a ray with this filter hits a primitive.
inline bool passes(const Filter& filter, std::uint32_t id) {
  return id != filter.skip && (filter.masks.empty() || (filter.masks[id] & filter.mask) != 0);
}

/// Finds all hits of one ray. It reuses its memory for the next one.
class HitList {
 public:
  HitList(const World& world, const Filter& filter) : world_(world.impl()), filter_(filter) {}

  /// The hits of a ray, in order of the exact t, then of id.
  const std::vector<Hit>& find(const Ray& ray);

  // For walk_scene(), which comes to some primitives more than once.
  static constexpr bool kInAnyOrder = true;
  bool block(const scalar::Single&, const TriangleBlock& block);
  bool arrays(const scalar::Single&, const CellLists& lists, std::size_t cell);

 private:
  /// One crossing: the first of a primitive beyond `t_min`.
  struct Crossing {
    std::uint32_t id;
    std::uint32_t original;  ///< see CopyTable
    double t_min, lo, hi;
  };
  ExactRay ray_from(double t_min) const;
  void add_crossings(std::uint32_t id);
  void add_crossings(std::uint32_t id, std::uint32_t copy);
  bool is_before(const Crossing& a, const Crossing& b) const;

  const World::Impl& world_;
  const Filter& filter_;
  ExactRay ray_{};
  std::vector<std::uint32_t> ids_;
  std::vector<Crossing> crossings_;
  std::vector<Hit> hits_;
};

}  // namespace grelha
