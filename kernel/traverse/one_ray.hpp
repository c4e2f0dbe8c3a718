#pragma once
// One ray by itself through a whole scene, without a packet.

#include "kernel/traverse/trace.hpp"

namespace grelha::GRELHA_ISA {

/// As test_infinite(Packet&). Returns whether the search is over.
template <bool kAny>
[[gnu::always_inline]] inline bool test_infinite(const SceneView& scene, Single& r) {
  const GeometryView& g = scene.geometry;
  bool over = false;
  InfiniteShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::Arrays& all = g.of<Shape>();
    for (std::uint32_t i = 0; !over && i < all.count; ++i) {
      const HitInterval<float> found = intersect<Shape>(
          spread<float>(SingleRay{r}), broadcast<Shape, float>(all.fields, i), *r.best);
      over = found.some &&
             take_hit<kAny>(SingleRay{r}, {found.lo, found.hi}, g.ids.begin(Shape::kKind) + i);
    }
  });
  return over;
}

/// What a walk does with the primitives it comes to: tests for the closest hit of its ray, or for
/// any. A walk can be given others that have these functions, which return whether it is over.
template <bool kAny>
struct HitTests {
  static constexpr bool kInAnyOrder = kAny;  ///< of grids
  [[gnu::always_inline]] static bool block(Single& r, const TriangleBlock& block) {
    return test_block<kAny>(SingleRay{r}, block);
  }
  [[gnu::always_inline]] static bool arrays(Single& r, const CellLists& lists, std::size_t cell) {
    NoCounts n;
    return test_arrays<kAny>(SingleRay{r}, lists, cell, n);
  }
};

/// The triangles of one cell of a grid, as far as the ray passes the boxes of their blocks.
template <class Tests>
inline bool visit_triangles(Single& r, const GridView& g, std::uint32_t cell, Tests& tests) {
  const Triangle::CellList& list = g.lists.of<Triangle>();
  const std::uint32_t first = list.first[cell];
  const std::uint32_t end = list.first[cell + 1];
  float enters[kBlock];
  for (std::uint32_t at = first / kBlock * kBlock; at < end; at += kBlock) {
    const TriangleBlock* const blocks = list.blocks + list.block_at(at);
    for (unsigned passed = hit_boxes(SingleRay{r}, list.boxes[at / kBlock], enters) &
                           blocks_between(at, first, end);
         passed != 0;
         passed &= passed - 1) {
      const unsigned k = static_cast<unsigned>(__builtin_ctz(passed));
      // a hit found since may be nearer
      if (enters[k] <= *r.best && tests.block(r, blocks[k]))
        return true;
    }
  }
  return false;
}

/// How far a leap goes at least: it finds its position anew, and single steps are sooner. Calls
/// took 2 to 4 % longer with 2, up to 5 % with 4 and up to 12 % with 6.
inline constexpr int kLeastLeap = 3;

/// Takes one ray through a grid, cell by cell, until a hit ends it or the grid does.
template <class Tests>
inline void walk_one(const GridView& g, Single& r, Tests& tests) {
  CellDda walk(g);
  if (!walk.start(r))
    return;
  const bool triangles = g.lists.of<Triangle>().first;
  const bool arrays = holds_arrays(g.lists);
  // no more planes than there are, whatever rounding does
  for (int left = g.n[0] + g.n[1] + g.n[2] + 3; left > 0; --left) {
    const int distance = walk.distance();
    const auto cell = static_cast<std::uint32_t>(walk.cell());
    if (distance == 0 && ((triangles && visit_triangles(r, g, cell, tests)) ||
                          (arrays && tests.arrays(r, g.lists, cell))))
      return;
    if (!(distance >= kLeastLeap ? walk.leap(distance - 1, *r.best) : walk.step(*r.best)))
      return;
  }
}

/// As search_far().
template <class Tests>
[[gnu::noinline]] void walk_one_far(const GridView& g, Single& r, Tests& tests) {
  Entry to;
  if (!enter_far(g, r, 0, to))
    return;
  Single moved = r;
  for (int a = 0; a < 3; ++a)
    *moved.org[a] = to.org[a];
  *moved.t_min = begin_from(*r.t_min, to.shift);
  *moved.best = round_t_up(*r.best, to.shift);
  *moved.low = round_t_down(*r.low, to.shift);
  static_cast<RayFrame&>(moved) = grid_frame(r, g, &to.shift);
  walk_one(in_grid_frame(g), moved, tests);
  const std::uint32_t id = id_of(*moved.id);
  if (id == id_of(*r.id))
    return;
  r.block = moved.block;
  if (*moved.best == -kInfinity)  // any hit
    set_hit(SingleRay{r}, {-kInfinity, -kInfinity}, id);
  else
    set_hit(SingleRay{r},
            {round_t_down(*moved.low, -to.shift), round_t_up(*moved.best, -to.shift)},
            id);
}

/// Bits of the blocks of triangles outside of grids whose boxes a ray does not surely pass by: see
/// kOutsideSlack. Rays whose direction is not as given pass none surely.
inline unsigned near_outside(const SceneView& scene, const Single& r) {
  const float least = min_advance(*r.dir[0], *r.dir[1], *r.dir[2]);
  bool known = *r.t_min >= 0;
  for (int a = 0; a < 3; ++a)
    known = known && magnitude(*r.dir[a]) >= least;
  unsigned near = known ? 0 : ~0u;
  for (int i = 0; known && i < kBlock; i += kWidth<Block>) {
    Block enter(*r.t_min), leave(*r.best);
    for (int a = 0; a < 3; ++a) {
      const Block org(*r.org[a]), inverse(*r.inverse[a]);
      const auto t_of_side = [&](int side) __attribute__((always_inline)) {
        return (load<Block>(scene.outside_boxes.side[side] + i) - org) * inverse;
      };
      const int side = static_cast<int>(*r.near[a]);
      clip_to_slab(t_of_side(side), t_of_side(2 * a + 3 - side), enter, leave);
    }
    near |= bits(enter <= leave * Block(kOutsideSlack) + Block(kOutsideUnderflow)) << i;
  }
  return near;
}

/// Takes one ray to the primitives that lie in no grid.
template <class Tests>
inline bool visit_outside(const SceneView& scene, Single& r, Tests& tests) {
  const CellLists& lists = scene.outside;
  const Triangle::CellList& triangles = lists.of<Triangle>();
  const unsigned near = triangles.first ? near_outside(scene, r) : 0;
  for (std::uint32_t i = 0; triangles.first && i < triangles.first[1]; ++i)
    if ((i >= kBlock || (near >> i & 1) != 0) && tests.block(r, triangles.blocks[i]))
      return true;
  return holds_arrays(lists) && tests.arrays(r, lists, 0);
}

/// Takes one ray to all primitives that are not infinite.
template <class Tests>
inline void walk_scene(const SceneView& scene, Single& r, Tests& tests) {
  if (scene.outside.of<Sphere>().first)
    r.error_bound = error_bound_in(scene, take_vec<float>(r.org, 0));
  if (visit_outside(scene, r, tests))
    return;
  each_grid<Tests::kInAnyOrder>(scene, r, [&](const GridView& g) {
    r.error_bound = g.error_bound;
    if (starts_near(g, take_vec<float>(r.org, 0)))
      walk_one(g, r, tests);
    else
      walk_one_far(g, r, tests);
  });
}

/// t of a ray's hit, rounded once, in the units of `ray`; of a triangle from the corners that the
/// test read, which are close in memory. `known` holds t, or is empty.
inline float t_of(const Single& r, const ExactRay& ray, const CrossingSpan& known) {
  const GeometryView& g = *r.geometry;
  const std::uint32_t id = id_of(*r.id);
  if (r.block && g.ids.has(PrimitiveKind::kTriangle, id)) {
    int lane = 0;
    for (int k = 1; k < kBlock; ++k)
      lane = r.block->id[k] == id ? k : lane;
    const Triangle::Fields<float> met = triangle_of(*r.block, lane);
    float t;
    if (r.block->id[lane] == id && round_plane_t(ray, met.corner, t))
      return t;
  }
  return rounded_t(g, ray, id, known);
}

/// The closest hit of a ray, or with kAny any hit: its t must not be used then.
template <bool kAny>
inline Hit trace_one(const SceneView& scene, const Ray& ray, const RayFilter* filter = nullptr) {
  const bool any_triangles = scene.geometry.of<Triangle>().count > 0;
  Single r;
  if (!prepare(r, ray, any_triangles))
    return {ray.t_max, kNoPrimitive};
  r.geometry = &scene.geometry;
  r.filter = filter;
  HitTests<kAny> tests;
  if (!test_infinite<kAny>(scene, r))
    walk_scene(scene, r, tests);
  const std::uint32_t id = id_of(*r.id);
  if (kAny || id == kNoPrimitive)
    return {ray.t_max, id};
  const ExactRay caller_ray = r.given.ray(0).in_units_of(1 / static_cast<double>(*r.unit));
  const CrossingSpan span = *r.unit == 1 ? CrossingSpan{*r.low, *r.best} : CrossingSpan{};
  return {strictly_between(t_of(r, caller_ray, span), ray.t_min, ray.t_max), id};
}

}  // namespace grelha::GRELHA_ISA
