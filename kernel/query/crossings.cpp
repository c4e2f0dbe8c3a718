#include <algorithm>
#include <vector>

#include "grelha/query.hpp"
#include "kernel/traverse/one_ray.hpp"
#include "kernel/grid/world_impl.hpp"

namespace grelha {
namespace {

using scalar::Single;

/// The triangles that one ray crosses.
class Crossings {
 public:
  Crossings(const SceneView& scene, Single& r) : ray_(r.given.ray(0)), t_max_(r.best) {
    if (const Triangle::CellList& list = scene.outside.of<Triangle>(); list.first)
      for (std::uint32_t i = 0; i < list.first[1]; ++i)
        look(list.blocks[i]);
    for (int g = 0; g < scene.grid_count; ++g)
      if (scene.grids[g].lists.of<Triangle>().first)
        walk(scene.grids[g], r);
    std::sort(ids_.begin(), ids_.end());
  }

  /// Number of primitives; one that stands in several cells counts once.
  std::size_t count() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < ids_.size(); ++i)
      count += i == 0 || ids_[i] != ids_[i - 1] ? 1 : 0;
    return count;
  }

 private:
  void walk(const GridView& g, Single& r) {
    if (scalar::starts_near(g, r.org)) {
      walk_cells(g, r);
      return;
    }
    scalar::Entry to;
    if (!scalar::enter_far(g, r.org, r.dir, r.t_min, r.best, to))
      return;
    Single moved = r;
    for (int a = 0; a < 3; ++a)
      moved.org[a] = to.org[a];
    moved.t_min = scalar::begin_from(r.t_min, to.shift);
    moved.best = scalar::round_t_up(r.best, to.shift);
    moved.base = g.lo_f;
    walk_cells(scalar::in_grid_frame(g), moved);
  }

  void walk_cells(const GridView& g, const Single& r) {
    scalar::CellDda cells(g);
    if (!cells.start(r))
      return;
    const Triangle::CellList& list = g.lists.of<Triangle>();
    do {
      if (cells.distance() == 0)
        look(list, static_cast<std::uint32_t>(cells.cell()), r);
    } while (cells.step(r.best));
  }

  void look(const Triangle::CellList& list, std::uint32_t cell, const Single& r) {
    const std::uint32_t first = list.first[cell];
    const std::uint32_t end = list.first[cell + 1];
    float enters[kBlock];
    for (std::uint32_t at = first / kBlock * kBlock; at < end; at += kBlock) {
      const unsigned passed = scalar::hit_boxes(r, list.boxes[at / kBlock], enters) &
                              scalar::blocks_between(at, first, end);
      scalar::each_bit(passed, [&](int k) { look(list.blocks[list.block_at(at) + k]); });
    }
  }

  void look(const TriangleBlock& block) {
    for (int i = 0; i < kBlock && block.id[i] != kNoPrimitive; ++i)
      if (crosses(scalar::triangle_of(block, i)))
        ids_.push_back(block.id[i]);
  }

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
  scalar::Vec3<float> dir{ray.dir.x, ray.dir.y, ray.dir.z};
  float t_min = ray.t_min;
  float t_max = ray.t_max;
  const float unit = scalar::length_unit(dir);
  if (unit != 1) {
    dir = {dir.x / unit, dir.y / unit, dir.z / unit};
    scalar::count_in(unit, t_min, t_max);
  }
  Single r;
  if (!prepare(r, {ray.org.x, ray.org.y, ray.org.z}, dir, t_min, t_max, true))
    return 0;
  return Crossings(scene, r).count();
}

}  // namespace grelha
