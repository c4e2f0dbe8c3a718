#pragma once
// Everything that one ray may hit: a walk through all grids that no hit ends.

#include "kernel/grid/world_impl.hpp"
#include "kernel/traverse/one_ray.hpp"

namespace grelha {

/// A ray whose direction has a length that tests can work with; t counts multiples of single.unit.
struct PreparedRay {
  scalar::Single single;
  bool valid = false;  ///< false: it hits nothing

  PreparedRay(const SceneView& scene, const Ray& ray) : valid(prepare(single, ray, true)) {
    single.geometry = &scene.geometry;
  }
  PreparedRay(const PreparedRay&) = delete;  ///< `single` points into itself
  ExactRay exact() const { return single.given.ray(0); }
  /// Its t in the caller's unit.
  ExactRay given(const ExactRay& ray) const {
    return ray.in_units_of(1 / static_cast<double>(single.unit));
  }
};

/// Calls the visitor for everything in the cells that a ray passes, and for everything in no cell:
/// visit.block(const TriangleBlock&) and visit.primitive(id). Some come more than once.
template <class Visit>
class AlongRay {
 public:
  AlongRay(const SceneView& scene, const PreparedRay& ray, Visit& visit) : visit_(visit) {
    if (!ray.valid)
      return;
    look(scene.outside, 0);
    for (int g = 0; g < scene.grid_count; ++g)
      walk(scene.grids[g], ray.single);
  }

 private:
  void walk(const GridView& g, const scalar::Single& r) {
    if (scalar::starts_near(g, r.org)) {
      walk_cells(g, r);
      return;
    }
    scalar::Entry to;
    if (!scalar::enter_far(g, r.org, r.dir, r.t_min, r.best, to))
      return;
    scalar::Single moved = r;
    for (int a = 0; a < 3; ++a)
      moved.org[a] = to.org[a];
    moved.t_min = scalar::begin_from(r.t_min, to.shift);
    moved.best = scalar::round_t_up(r.best, to.shift);
    moved.base = g.lo_f;
    walk_cells(scalar::in_grid_frame(g), moved);
  }

  void walk_cells(const GridView& g, const scalar::Single& r) {
    scalar::CellDda cells(g);
    if (!cells.start(r))
      return;
    do {
      if (cells.distance() == 0)
        look(g, static_cast<std::uint32_t>(cells.cell()), r);
    } while (cells.step(r.best));
  }

  void look(const GridView& g, std::uint32_t cell, const scalar::Single& r) {
    const Triangle::CellList& list = g.lists.of<Triangle>();
    if (list.first) {
      const std::uint32_t first = list.first[cell];
      const std::uint32_t end = list.first[cell + 1];
      float enters[kBlock];
      for (std::uint32_t at = first / kBlock * kBlock; at < end; at += kBlock) {
        const unsigned hit = scalar::hit_boxes(r, list.boxes[at / kBlock], enters) &
                             scalar::blocks_between(at, first, end);
        scalar::each_bit(hit, [&](int k) { visit_.block(list.blocks[list.block_at(at) + k]); });
      }
    }
    look_at_arrays(g.lists, cell);
  }

  void look(const CellLists& lists, std::uint32_t cell) {
    if (const Triangle::CellList& list = lists.of<Triangle>(); list.first)
      for (std::uint32_t i = list.first[cell]; i < list.first[cell + 1]; ++i)
        visit_.block(list.blocks[i]);
    look_at_arrays(lists, cell);
  }

  void look_at_arrays(const CellLists& lists, std::uint32_t cell) {
    ArrayShapes::for_each([&]<class Shape>() {
      const typename Shape::CellList& list = lists.of<Shape>();
      for (std::uint32_t i = list.first ? list.first[cell] : 0;
           list.first && i < list.first[cell + 1];
           ++i)
        visit_.primitive(list.id[i]);
    });
  }

  Visit& visit_;
};

}  // namespace grelha
