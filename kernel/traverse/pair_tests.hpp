#pragma once
// Pairs of a ray and a triangle that may meet, tested side by side: rays on their own, each in
// another cell, fill registers together. A first filter, rays against blocks of triangles, lists
// the pairs; few of its lanes pass, so that full tests of whole blocks would waste most of theirs.

#include "kernel/traverse/single_tests.hpp"

namespace grelha::GRELHA_ISA {

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
    float error;             ///< of an edge function, over the largest sheared coordinate
    std::uint32_t place[3];  ///< of coordinates in a block
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
        to.place[a] = static_cast<std::uint32_t>(axis[a]);
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
      const Block z = Block(r.org[2]) - load<Block>(v[r.place[2]] + i);
      x = (Block(r.org[0]) - load<Block>(v[r.place[0]] + i)) - Block(r.shear[0]) * z;
      y = (Block(r.org[1]) - load<Block>(v[r.place[1]] + i)) - Block(r.shear[1]) * z;
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
    bool leaves_out(int k) const {
      return tests->p_.leaves_out(tests->ray(pair(k)), tests->id(pair(k)));
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
