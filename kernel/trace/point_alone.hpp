#pragma once
// Rays that go to a point, each by itself through the lists of its tile (SIMD over primitives).
// As where rays walk grids by themselves (kernel/walk/abreast.hpp) each phase goes through a list
// that the phase before it made, and few branches depend on one ray.

#include "kernel/trace/listed.hpp"
#include "kernel/walk/single.hpp"

namespace grelha::GRELHA_ISA {

/// One ray and one triangle.
template <class Ray>
struct RayAndCorners {
  const Ray* r;
  const Triangle::Fields<float>* triangle;
  RayAndTriangle<float> operator()() const {
    const int k = axis_of(*r);
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const auto corner = [&](const float(&v)[3]) { return Vec3<float>{v[kx], v[ky], v[k]}; };
    return {
        {tested_org(*r, kx), tested_org(*r, ky), tested_org(*r, k)},
        {direction(*r, kx), direction(*r, ky), direction(*r, k)},
        {corner(triangle->corner[0]), corner(triangle->corner[1]), corner(triangle->corner[2])}};
  }
};

inline Triangle::Fields<float> triangle_at(const Triangle::Arrays& t, std::uint32_t i) {
  Triangle::Fields<float> triangle;
  for (int k = 0; k < 3; ++k)
    for (int a = 0; a < 3; ++a)
      triangle.corner[k][a] = t.vertex[a][t.corner[k][i]];
  return triangle;
}

/// One ray against one primitive: whether it is in the way.
template <class Ray>
inline void test_alone(Triangle, const GeometryView& g, Ray& r, std::uint32_t i, std::uint32_t id) {
  const Triangle::Fields<float> triangle = triangle_at(g.of<Triangle>(), i);
  const Shear<float> shear{shear_of(r, 0), shear_of(r, 1), shear_of(r, 2)};
  float t = 0;
  if (hit_triangle<true>(
          RayAndCorners<Ray>{&r, &triangle}, shear, tested_t_min(r), tested_best(r), t))
    take_hit<true>(r, t, id);
}
template <class Shape, class Ray>
inline void test_alone(Shape, const GeometryView& g, Ray& r, std::uint32_t i, std::uint32_t id) {
  float t = 0;
  if (meet(spread<Ray, float>(r), broadcast<Shape, float>(g.of<Shape>().fields, i), t))
    take_hit<true>(r, t, id);
}

/// Rays of a packet that look into tiles alone.
class LoneSearch {
 public:
  LoneSearch(const GeometryView& geometry,
             const PointGridView& grid,
             Packet<InFloat>& p,
             const std::uint32_t* leaves,
             Counters& n)
      : geometry_(geometry), grid_(grid), p_(p), leaves_(leaves), n_(n) {}

  /// Adds lanes of the group whose first ray is `first`: they look into `tiles`.
  [[gnu::always_inline]] void add(const LaneWords& tiles,
                                  const SearchPlaces& at,
                                  int first,
                                  unsigned lanes) {
    const Chosen chosen(lanes);
    chosen.store(ray_ + count_, counted_words<Lanes>(static_cast<std::uint32_t>(first)));
    chosen.store(tile_ + count_, tiles);
    chosen.store(x_ + count_, at.x);
    chosen.store(y_ + count_, at.y);
    chosen.store(depth_ + count_, at.depth);
    count_ += chosen.count();
  }

  void run() {
    if (grid_.outlines)
      search<kOutlineList>(grid_.outlines);
    if (grid_.boxes)
      search<kBoxList>(grid_.boxes);
  }

 private:
  static constexpr int kRow = kPacket + kWidth<Lanes>;
  static constexpr int kMost = 512;  ///< primitives that are due at once

  bool searches(std::uint32_t ray) const { return p_.best[ray] > p_.t_min[ray]; }

  /// All rays through their lists of a kind, a block of each at a time.
  template <int kKind, class Listed>
  void search(const Listed* blocks) {
    int going = 0;
    for (int k = 0; k < count_; ++k) {
      const TileLists* const tile = grid_.tiles + tile_[k];
      which_[going] = static_cast<std::uint32_t>(k);
      first_[going] = tile[0].first[kKind];
      end_[going] = tile[1].first[kKind];
      going += (first_[going] < end_[going]) & searches(ray_[k]);
    }
    while (going > 0)
      going = search_blocks(blocks, going);
  }

  /// Each against its next block. Returns how many go on to another.
  template <class Listed>
  [[gnu::noinline]] int search_blocks(const Listed* blocks, int going) {
    due_ = 0;
    int left = 0;
    for (int j = 0; j < going; ++j) {
      const std::uint32_t k = which_[j];
      const std::uint32_t first = first_[j];
      const std::uint32_t end = end_[j];
      const bool all_near = look(blocks[first / kBlock], k, first, end);
      const std::uint32_t next = (first / kBlock + 1) * kBlock;
      which_[left] = k;
      first_[left] = next;
      end_[left] = end;
      left += all_near & (next < end);
      if (due_ >= kMost)
        settle();
    }
    settle();
    int going_on = 0;
    for (int j = 0; j < left; ++j) {
      which_[going_on] = which_[j];
      first_[going_on] = first_[j];
      end_[going_on] = end_[j];
      prefetch(blocks + first_[j] / kBlock);
      going_on += searches(ray_[which_[j]]);
    }
    return going_on;
  }

  /// Looks at a block of a list. Returns whether all of it is near enough to be met.
  template <class Listed>
  [[gnu::always_inline]] bool look(const Listed& b,
                                   std::uint32_t k,
                                   std::uint32_t first,
                                   std::uint32_t end) {
    ++n_.outline_rows;
    const std::uint32_t ray = ray_[k];
    const TilePlace at{x_[k], y_[k], depth_[k]};
    const unsigned listed = blocks_between(first / kBlock * kBlock, first, end);
    unsigned maybe[kBlock / kWidth<Block>];
    unsigned surely = 0;
    unsigned near = 0;
    for (int i = 0; i < kBlock; i += kWidth<Block>) {
      const MetPrimitives met = met_primitives(at, b, i);
      const auto starts_on = Words<Block>(load_words<Block>(b.id + i) == leaves_[ray]);
      const unsigned may = bits(but_not(met.maybe, mask_of(starts_on))) & listed >> i;
      maybe[i / kWidth<Block>] = may;
      surely |= (may & bits(met.surely)) << i;
      near |= bits(met.near) << i;
    }
    block(ray, b, surely);
    for (int i = 0; i < kBlock; i += kWidth<Block>)
      take(ray, b, i, surely != 0 ? 0 : maybe[i / kWidth<Block>]);
    return (surely == 0) & ((near & listed) == listed);
  }

  /// Notes that a ray is blocked where it surely meets something.
  template <class Listed>
  [[gnu::always_inline]] void block(std::uint32_t ray, const Listed& b, unsigned surely) {
    const float by = bits_of(b.id[__builtin_ctz(surely | 1u << (kBlock - 1))]);
    p_.best[ray] = surely != 0 ? -kInfinity : p_.best[ray];
    p_.id[ray] = surely != 0 ? by : p_.id[ray];
  }

  /// Those of a block that a ray is to be tested against.
  template <class Listed>
  [[gnu::always_inline]] void take(std::uint32_t ray, const Listed& b, int i, unsigned primitives) {
    const Chosen chosen(primitives);
    chosen.store(due_id_ + due_, load_words<Block>(b.id + i));
    const Words<Block> rays = Words<Block>{} + ray;
    store_words(due_ray_ + due_, rays);
    due_ += chosen.count();
  }

  void settle() {
    for (int j = 0; j < due_; ++j) {
      PacketRay<InFloat> r{p_, static_cast<int>(due_ray_[j])};
      if (!searches(due_ray_[j]))
        continue;
      prepare(r.i / kWidth<Lanes>);
      visit_shape(FiniteShapes{}, geometry_.ids, due_id_[j], [&]<class Shape>(std::uint32_t i) {
        ++n_.tests[kNumber<Shape>];
        test_alone(Shape{}, geometry_, r, i, due_id_[j]);
      });
    }
    due_ = 0;
  }

  /// Makes the rays of a group ready for tests.
  void prepare(int group) {
    const std::uint64_t bit = std::uint64_t{1} << group;
    if ((prepared_ & bit) == 0)
      prepare_to_test(p_, group, true);
    prepared_ |= bit;
  }

  const GeometryView& geometry_;
  const PointGridView& grid_;
  Packet<InFloat>& p_;
  const std::uint32_t* leaves_;  ///< [rays] what each starts on, or kNoPrimitive
  Counters& n_;
  int count_ = 0;
  int due_ = 0;
  std::uint64_t prepared_ = 0;  ///< groups
  alignas(64) std::uint32_t ray_[kRow];
  alignas(64) std::uint32_t tile_[kRow];
  alignas(64) float x_[kRow];
  alignas(64) float y_[kRow];
  alignas(64) float depth_[kRow];
  std::uint32_t which_[kRow];
  std::uint32_t first_[kRow];
  std::uint32_t end_[kRow];
  alignas(64) std::uint32_t due_ray_[kMost + kBlock];
  alignas(64) std::uint32_t due_id_[kMost + kBlock];
};

}  // namespace grelha::GRELHA_ISA
