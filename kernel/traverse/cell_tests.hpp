#pragma once
// Tests of rays that have nothing in common, at the contents of cells: one ray against blocks of
// primitives (SIMD over primitives), or pairs of rays and triangles that may meet, side by side.
// Rays on their own, each in another cell, fill registers together: a first filter, rays against
// blocks, lists the pairs, and few of its lanes pass.

#include "kernel/traverse/packet.hpp"
#include "kernel/traverse/ray.hpp"

namespace grelha::GRELHA_ISA {

/// Takes the hits of a block in order of index. Returns whether the search is over.
template <bool kAny, class Ray>
inline bool record(Ray r, const HitInterval<Block>& found, const std::uint32_t* ids) {
  unsigned lanes = bits(mask_and(found.some, found.lo <= Block(r.rays.best[r.i])));
  if (lanes == 0)
    return false;
  float lo[kWidth<Block>], hi[kWidth<Block>];
  store(lo, found.lo);
  store(hi, found.hi);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = __builtin_ctz(lanes);
    if (take_hit<kAny>(r, {lo[k], hi[k]}, ids[k])) {
      set_hit(r, {-kInfinity, -kInfinity}, id_of(r));
      return true;
    }
  }
  return false;
}

/// Bits of the boxes from i on that a ray passes through before its search ends; `enter`: t where.
template <class Ray>
[[gnu::always_inline]] inline unsigned hit_boxes_from(Ray r,
                                                      const BlockBoxes& boxes,
                                                      int i,
                                                      Block& enter) {
  const float* const base = r.rays.base;
  enter = Block(r.rays.t_min[r.i]);
  Block leave(r.rays.best[r.i]);
  for (int a = 0; a < 3; ++a) {
    const Block org(r.rays.org[a][r.i]), inverse(r.rays.inverse[a][r.i]);
    const auto t_of_side = [&](int side) __attribute__((always_inline)) {
      const Block at = load<Block>(boxes.side[side] + i);
      return ((base ? at - Block(base[a]) : at) - org) * inverse;
    };
    const int near = static_cast<int>(r.rays.near[a][r.i]);
    clip_to_slab(t_of_side(near), t_of_side(2 * a + 3 - near), enter, leave);
  }
  return bits(enter <= leave);
}

/// Bits of the boxes that a ray passes through before its search ends; `enters`: t where.
template <class Ray>
inline unsigned hit_boxes(Ray r, const BlockBoxes& boxes, float (&enters)[kBlock]) {
  unsigned hit = 0;
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    Block enter;
    hit |= hit_boxes_from(r, boxes, i, enter) << i;
    store(enters + i, enter);
  }
  return hit;
}

/// Bits of the eight blocks from `at` on (a multiple of eight) that lie in [first, end).
inline unsigned blocks_between(std::uint32_t at, std::uint32_t first, std::uint32_t end) {
  constexpr unsigned kAll = (1u << kBlock) - 1;
  const unsigned from = first > at ? kAll << (first - at) : kAll;
  return end - at < kBlock ? from & ~(kAll << (end - at)) & kAll : from & kAll;
}

/// A ray and triangles of a block from i on.
template <class Ray>
struct BlockSource {
  Ray r;
  const TriangleBlock* block;
  int i;
  RayAndTriangle<Block> operator()() const {
    const int k = static_cast<int>(r.rays.axis[r.i]);
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const float* const base = r.rays.base;
    const auto corner = [&](const float(&v)[3][kBlock]) {
      const Vec3<Block> at{load<Block>(v[kx] + i), load<Block>(v[ky] + i), load<Block>(v[k] + i)};
      return base ? at - Vec3<Block>{Block(base[kx]), Block(base[ky]), Block(base[k])} : at;
    };
    return {{Block(r.rays.org[kx][r.i]), Block(r.rays.org[ky][r.i]), Block(r.rays.org[k][r.i])},
            {Block(r.rays.dir[kx][r.i]), Block(r.rays.dir[ky][r.i]), Block(r.rays.dir[k][r.i])},
            {corner(block->a), corner(block->b), corner(block->c)}};
  }
  float frame_error() const { return r.rays.frame_error; }
  ExactRay given(int) const { return r.rays.given.ray(r.i); }
  double shift(int) const { return r.rays.given.shift_of(r.i); }
  bool is_filtered(int k) const { return r.rays.is_filtered(r.i, block->id[i + k]); }
  void take_vertices(int k, float (&to)[3][3]) const {
    for (int a = 0; a < 3; ++a) {
      to[0][a] = block->a[a][i + k];
      to[1][a] = block->b[a][i + k];
      to[2][a] = block->c[a][i + k];
    }
  }
};

/// Callers count rows.
template <bool kAny, class Ray>
[[gnu::noinline]] bool test_block(Ray r, const TriangleBlock& block) {
  const Shear<Block> shear{Block(r.rays.shear[0][r.i]),
                           Block(r.rays.shear[1][r.i]),
                           Block(r.rays.shear[2][r.i]),
                           Block(r.rays.frame_error)};
  const Block t_min(r.rays.t_min[r.i]);
  const std::uint32_t before = id_of(r);
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const BlockSource<Ray> with{r, &block, i};
    if (record<kAny>(
            r, intersect_triangle(with, shear, t_min, Block(r.rays.best[r.i])), block.id + i))
      return true;
  }
  if constexpr (std::is_same_v<Ray, SingleRay>) {
    if (id_of(r) != before)
      r.rays.block = &block;
  } else if (!kAny && id_of(r) != before) {
    for (int k = 0; k < kBlock; ++k)
      if (block.id[k] == id_of(r))
        keep_hit_fields<Triangle>(r.rays, r.i, triangle_of(block, k));
  }
  return false;
}

/// One ray, for primitives side by side.
template <class Real, class Ray>
[[gnu::always_inline]] inline SimdRays<Real> spread(Ray r) {
  return {.org = {Real(r.rays.org[0][r.i]), Real(r.rays.org[1][r.i]), Real(r.rays.org[2][r.i])},
          .dir = {Real(r.rays.dir[0][r.i]), Real(r.rays.dir[1][r.i]), Real(r.rays.dir[2][r.i])},
          .inv_dd = Real(r.rays.inv_dd[r.i]),
          .inv_length = Real(r.rays.inv_length[r.i]),
          .t_min = Real(r.rays.t_min[r.i]),
          .frame_error = Real(r.rays.frame_error),
          .error_bound = Real(r.rays.error_bound),
          .base = r.rays.base,
          .given = &r.rays.given,
          .first = r.i,
          .step = 0};
}

/// Primitives of one kind side by side, from element i of a list on; `ray` is r, spread. Returns
/// whether the search is over. Callers count rows.
template <bool kAny, class Shape, class Ray>
[[gnu::always_inline]] inline bool test_row(Ray r,
                                            const SimdRays<Block>& ray,
                                            const typename Shape::CellList& list,
                                            std::uint32_t i) {
  const auto row = side_by_side<Shape, Block>(list.fields, i);
  const std::uint32_t before = id_of(r);
  const bool over =
      record<kAny>(r, intersect<Shape>(ray, row, Block(r.rays.best[r.i])), list.id + i);
  if constexpr (!kAny && std::is_same_v<Ray, PacketRay> && kKeepsFields<Shape>)
    if (id_of(r) != before)
      for (std::uint32_t k = i; k < i + kWidth<Block>; ++k)
        if (list.id[k] == id_of(r))
          keep_hit_fields<Shape>(r.rays, r.i, one_of<Shape>(list.fields, k));
  return over;
}

/// Primitives of one kind in one cell. Reading past its end tests those of the next, which costs
/// nothing and is never wrong: a hit is a hit.
template <bool kAny, class Shape, class Ray, class Counts>
[[gnu::always_inline]] inline bool test_list(Ray r,
                                             const typename Shape::CellList& list,
                                             std::size_t cell,
                                             Counts& n) {
  const SimdRays<Block> ray = spread<Block>(r);
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Block>) {
    count_rows<Shape>(n, 1, kWidth<Block>);
    if (test_row<kAny, Shape>(r, ray, list, i))
      return true;
  }
  return false;
}

/// True if some cell holds primitives in arrays.
inline bool holds_arrays(const CellLists& lists) {
  bool some = false;
  ArrayShapes::for_each([&]<class Shape>() { some = some || lists.of<Shape>().first; });
  return some;
}

/// Tests the primitives in the arrays of one cell.
template <bool kAny, class Ray, class Counts>
[[gnu::noinline]] bool test_arrays(Ray r, const CellLists& lists, std::size_t cell, Counts& n) {
  bool over = false;
  ArrayShapes::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const typename Shape::CellList& list = lists.of<Shape>();
    over = over || (list.first && test_list<kAny, Shape>(r, list, cell, n));
  });
  return over;
}

/// What a search looks for: the closest hit, any hit, or all primitives that a ray may cross.
enum class Find { kClosest, kAny, kAll };

/// Lists a primitive that a ray may cross.
template <class Ray>
[[gnu::always_inline]] inline void list_candidate(Ray r,
                                                  std::uint32_t id,
                                                  const TriangleBlock* block = nullptr,
                                                  int index = 0,
                                                  unsigned sure = 0) {
  CandidateSink& to = *r.rays.candidates;
  if (to.count == to.capacity)
    to.make_room();
  to.items[to.count++] = {block,
                          id,
                          static_cast<std::uint16_t>(r.i),
                          static_cast<std::uint8_t>(index),
                          static_cast<std::uint8_t>(sure)};
}

/// True if floats tell whether a crossing comes before the end of a ray's search. They do not where
/// the end was rounded.
inline bool knows_end(PacketRay r) {
  return r.rays.best[r.i] == kInfinity ||
         (!r.rays.base && (!r.rays.has_units || r.rays.unit[r.i] == 1));
}
inline bool knows_end(SingleRay r) {
  return *r.rays.best == kInfinity || (!r.rays.base && *r.rays.unit == 1);
}

/// Lanes that a ray may cross, and of those the ones that it surely does.
struct ListedLanes {
  unsigned some, sure;
};
[[gnu::always_inline]] inline ListedLanes listed_lanes(const HitInterval<Block>& found,
                                                       const Block& best) {
  return {bits(found.some), bits(mask_and(found.sure, found.hi < best))};
}

/// Lists the triangles of a block that a ray may cross.
template <class Ray>
inline void list_triangles(Ray r, const TriangleBlock& block) {
  const Shear<Block> shear{Block(r.rays.shear[0][r.i]),
                           Block(r.rays.shear[1][r.i]),
                           Block(r.rays.shear[2][r.i]),
                           Block(r.rays.frame_error)};
  const Block best(r.rays.best[r.i]);
  for (int i = 0; i < kBlock; i += kWidth<Block>) {
    const BlockSource<Ray> with{r, &block, i};
    const ListedLanes lanes =
        listed_lanes(bound_triangle<Block>(with(), shear, Block(r.rays.t_min[r.i]), best), best);
    each_bit(lanes.some, [&](int k) {
      if (block.id[i + k] != kNoPrimitive)
        list_candidate(r, block.id[i + k], &block, i + k, (lanes.sure >> k & 1) & knows_end(r));
    });
  }
}

/// Lists the primitives of a kind in a cell that a ray may cross.
template <class Shape, class Ray>
inline void list_rows(Ray r, const typename Shape::CellList& list, std::size_t cell) {
  const Wanted wanted = r.rays.candidates->wanted;
  if (wanted == Wanted::kTriangles)
    return;
  const SimdRays<Block> ray = spread<Block>(r);
  const std::uint32_t end = list.first[cell + 1];
  for (std::uint32_t i = list.first[cell]; i < end; i += kWidth<Block>) {
    const auto row = side_by_side<Shape, Block>(list.fields, i);
    const unsigned left = end - i;
    const unsigned there = left < kWidth<Block> ? (1u << left) - 1u : (1u << kWidth<Block>)-1u;
    unsigned some = there;
    if constexpr (requires { may_intersect(ray, row); })
      some &= bits(may_intersect(ray, row));
    if (some == 0)
      continue;
    unsigned one = 0;
    unsigned both = 0;
    if constexpr (Shape::kKind == PrimitiveKind::kSphere) {
      if (wanted == Wanted::kTrianglesAndSpheresAround) {
        some &= bits(may_start_inside(ray, row));
      } else {
        const SphereCrossings<Block> found = count_crossings(ray, row, Block(r.rays.best[r.i]));
        some &= bits(found.some);
        one = bits(found.one);
        both = bits(found.both);
      }
    } else if (wanted == Wanted::kTrianglesAndSpheresAround) {
      return;
    }
    each_bit(some, [&](int k) {
      const unsigned sure = knows_end(r) ? (one >> k & 1) + 2 * (both >> k & 1) : 0;
      list_candidate(r, list.id[i + static_cast<unsigned>(k)], nullptr, 0, sure);
    });
  }
}

/// Lists pairs of the rays of a packet and the triangles of a grid, and tests them.
template <Find kFind>
class PairTests {
 public:
  PairTests(const GridView& g, Packet& p) : blocks_(g.lists.template of<Triangle>().blocks), p_(p) {
    if (g.lists.template of<Triangle>().first && !p.base)
      each_live_group(p, [&](int i, int) { set_sheared_rays(g, i); });
  }

  /// Lists the triangles of a block that a ray is not sure to miss.
  [[gnu::always_inline]] void add(std::uint32_t ray, std::uint32_t block) {
    for (int i = 0; i < kBlock; i += kWidth<Block>) {
      const CompressMask selected(p_.base ? crossed_in_frame(ray, blocks_[block], i)
                                          : crossed(sheared_[ray], blocks_[block], i));
      store_words(ray_ + count_, Words<Block>{} + ray);
      selected.store(triangle_ + count_,
                     counted_words<Block>(block * kBlock + static_cast<unsigned>(i)));
      count_ += selected.count();
    }
    if (count_ >= kMost)
      test();
  }

  /// Tests the listed pairs.
  [[gnu::noinline]] void test() {
    for (int first = 0; first < count_; first += kWidth<Block>)
      test_pairs(first, count_ - first < kWidth<Block> ? count_ - first : kWidth<Block>);
    count_ = 0;
  }

 private:
  static constexpr int kMost = 512;

  /// A ray as the filter sees it: in the order of its axes.
  struct ShearedRay {
    float org[3], shear[2];
    float error;            ///< of an edge function, over the largest sheared coordinate
    std::uint32_t axis[3];  ///< of coordinates in a block, the longest last
  };

  /// S + Z of bound_triangle() is at most three times the farthest distance along an axis, and S
  /// the largest sheared coordinate: kEdgeError u S (S + Z) is at most 97 u S times that distance.
  [[gnu::always_inline]] void set_sheared_rays(const GridView& g, int i) {
    constexpr float kError = 97 * 0x1p-24f;
    static_assert(kError > 3 * kEdgeError * 0x1p-24);
    VFloat far(0);
    for (int a = 0; a < 3; ++a) {
      const VFloat o = load<VFloat>(p_.org[a] + i);
      far = max(far, max_abs(VFloat(g.lo_f[a]) - o, VFloat(g.hi_f[a]) - o));
    }
    alignas(64) float error[kWidth<VFloat>];
    store(error, far * VFloat(kError));
    for (int r = i; r < i + kWidth<VFloat>; ++r) {
      ShearedRay& to = sheared_[r];
      const int k = static_cast<int>(p_.axis[r]);
      const int axis[3] = {kNextAxis[k], kPreviousAxis[k], k};
      for (int a = 0; a < 3; ++a) {
        to.org[a] = p_.org[axis[a]][r];
        to.axis[a] = static_cast<std::uint32_t>(axis[a]);
      }
      to.shear[0] = p_.shear[0][r];
      to.shear[1] = p_.shear[1][r];
      to.error = error[r - i];
    }
  }

  /// Bits of triangles of a block, from i on, that a ray is not sure to miss.
  [[gnu::always_inline]] static unsigned crossed(const ShearedRay& r,
                                                 const TriangleBlock& block,
                                                 int i) {
    const auto sheared = [&](const float(&v)[3][kBlock], Block& x, Block& y)
        __attribute__((always_inline)) {
      const Block z = Block(r.org[2]) - load<Block>(v[r.axis[2]] + i);
      x = (Block(r.org[0]) - load<Block>(v[r.axis[0]] + i)) - Block(r.shear[0]) * z;
      y = (Block(r.org[1]) - load<Block>(v[r.axis[1]] + i)) - Block(r.shear[1]) * z;
    };
    Block ax, ay, bx, by, cx, cy;
    sheared(block.a, ax, ay);
    sheared(block.b, bx, by);
    sheared(block.c, cx, cy);
    const Block u = cx * by - cy * bx;
    const Block v = ax * cy - ay * cx;
    const Block w = bx * ay - by * ax;
    const Block size = max_abs(max_abs(max_abs(ax, ay), max_abs(bx, by)), max_abs(cx, cy));
    const Block error = size * Block(r.error) + Block(static_cast<float>(kUnderflow<float>));
    return bits(min(max(max(u, v), w), Block(0) - min(min(u, v), w)) <= error);
  }
  /// The same of a ray in the frame of a grid.
  [[gnu::always_inline]] unsigned crossed_in_frame(std::uint32_t ray,
                                                   const TriangleBlock& block,
                                                   int i) {
    const PacketRay r{p_, static_cast<int>(ray)};
    const Shear<Block> shear{Block(p_.shear[0][ray]),
                             Block(p_.shear[1][ray]),
                             Block(p_.shear[2][ray]),
                             Block(p_.frame_error)};
    const EdgeFunctions<Block> edge(BlockSource<PacketRay>{r, &block, i}(), shear);
    return bits(edge.may_cross());
  }

  /// Rays and triangles side by side, in the order of the rays' axes.
  struct Pairs {
    alignas(64) float corner[3][3][kWidth<Block>];
    alignas(64) float org[3][kWidth<Block>];
    alignas(64) float dir[3][kWidth<Block>];
    alignas(64) float shear[3][kWidth<Block>];
    alignas(64) float t_min[kWidth<Block>], best[kWidth<Block>];
  };
  /// Hands them to the test, and again where floats cannot decide.
  struct PairSource {
    const PairTests* tests;
    const Pairs* pairs;
    int first, last;  ///< of those listed; lanes behind it repeat it

    RayAndTriangle<Block> operator()() const {
      const Pairs& of = *pairs;
      const auto at = [](const float(&v)[3][kWidth<Block>]) {
        return Vec3<Block>{load<Block>(v[0]), load<Block>(v[1]), load<Block>(v[2])};
      };
      return {at(of.org), at(of.dir), {at(of.corner[0]), at(of.corner[1]), at(of.corner[2])}};
    }
    int pair(int k) const { return first + k < last ? first + k : last; }
    float frame_error() const { return tests->p_.frame_error; }
    ExactRay given(int k) const { return tests->p_.given.ray(tests->ray(pair(k))); }
    double shift(int k) const { return tests->p_.given.shift_of(tests->ray(pair(k))); }
    bool is_filtered(int k) const {
      return tests->p_.is_filtered(tests->ray(pair(k)), tests->id(pair(k)));
    }
    void take_vertices(int k, float (&to)[3][3]) const {
      const Triangle::Fields<float> t = tests->triangle(pair(k));
      __builtin_memcpy(to, t.corner, sizeof to);
    }
  };

  std::uint32_t id(int pair) const {
    return blocks_[triangle_[pair] / kBlock].id[triangle_[pair] % kBlock];
  }
  int ray(int pair) const { return static_cast<int>(ray_[pair]); }
  Triangle::Fields<float> triangle(int pair) const {
    return triangle_of(blocks_[triangle_[pair] / kBlock],
                       static_cast<int>(triangle_[pair] % kBlock));
  }

  [[gnu::always_inline]] void load_pair(int pair, int j, Pairs& to) const {
    const int r = ray(pair);
    const int k = static_cast<int>(p_.axis[r]);
    const int axis[3] = {kNextAxis[k], kPreviousAxis[k], k};
    const TriangleBlock& block = blocks_[triangle_[pair] / kBlock];
    const unsigned i = triangle_[pair] % kBlock;
    for (int a = 0; a < 3; ++a) {
      const float base = p_.base ? p_.base[axis[a]] : 0.f;
      to.corner[0][a][j] = block.a[axis[a]][i] - base;
      to.corner[1][a][j] = block.b[axis[a]][i] - base;
      to.corner[2][a][j] = block.c[axis[a]][i] - base;
      to.org[a][j] = p_.org[axis[a]][r];
      to.dir[a][j] = p_.dir[axis[a]][r];
      to.shear[a][j] = p_.shear[a][r];
    }
    to.t_min[j] = p_.t_min[r];
    to.best[j] = p_.best[r];
  }

  /// Tests `some` pairs from `first` on.
  [[gnu::always_inline]] void test_pairs(int first, int some) {
    Pairs pairs;
    const PairSource source{this, &pairs, first, first + some - 1};
    for (int j = 0; j < kWidth<Block>; ++j)
      load_pair(source.pair(j), j, pairs);
    const Shear<Block> shear{load<Block>(pairs.shear[0]),
                             load<Block>(pairs.shear[1]),
                             load<Block>(pairs.shear[2]),
                             Block(p_.frame_error)};
    const Block best = load<Block>(pairs.best);
    if constexpr (kFind == Find::kAll) {
      list(first,
           some,
           listed_lanes(bound_triangle<Block>(source(), shear, load<Block>(pairs.t_min), best),
                        best));
      return;
    }
    const HitInterval<Block> found =
        intersect_triangle(source, shear, load<Block>(pairs.t_min), best);
    const unsigned lanes = bits(mask_and(found.some, found.lo <= best)) & ((1u << some) - 1u);
    if (lanes == 0)
      return;
    float lo[kWidth<Block>], hi[kWidth<Block>];
    store(lo, found.lo);
    store(hi, found.hi);
    each_bit(lanes, [&](int k) { take(first + k, {lo[k], hi[k]}); });
  }

  [[gnu::always_inline]] void list(int first, int some, const ListedLanes& lanes) {
    each_bit(lanes.some & ((1u << some) - 1u), [&](int k) {
      const PacketRay r{p_, ray(first + k)};
      const std::uint32_t triangle = triangle_[first + k];
      const unsigned sure = (lanes.sure >> k & 1) & knows_end(r);
      list_candidate(
          r, id(first + k), blocks_ + triangle / kBlock, static_cast<int>(triangle % kBlock), sure);
    });
  }

  void take(int pair, const CrossingSpan& t) {
    constexpr bool kAny = kFind == Find::kAny;
    const PacketRay r{p_, ray(pair)};
    if (take_hit<kAny>(r, t, id(pair)))
      set_hit(r, {-kInfinity, -kInfinity}, id_of(r));
    else if (!kAny && id_of(r) == id(pair))
      keep_hit_fields<Triangle>(p_, r.i, triangle(pair));
  }

  const TriangleBlock* blocks_;
  Packet& p_;
  int count_ = 0;
  ShearedRay sheared_[kPacket];
  alignas(64) std::uint32_t ray_[kMost + 2 * kBlock];
  alignas(64) std::uint32_t triangle_[kMost + 2 * kBlock];
};

}  // namespace grelha::GRELHA_ISA
