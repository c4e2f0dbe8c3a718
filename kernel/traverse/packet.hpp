#pragma once
// A packet: rays side by side that walk grids and are tested against primitives.

#include "grelha/stats.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/traverse/ray_group.hpp"
#include "kernel/traverse/slab.hpp"
#include "kernel/traverse/tolerances.hpp"

namespace grelha::GRELHA_ISA {

/// Most rays in a packet. A word has a bit for each group of lanes.
inline constexpr int kPacket = kWidth<VFloat> == 1 ? 64 : 256;
inline constexpr int kMostFields = 9;  ///< those of a triangle; see kKeepsFields
inline constexpr float kGreatest = 0x1.fffffep127f;

/// Rows of floats that are to be read or written soon. Asked for line by line, with work between,
/// they come without being waited for: the first cache waits for few lines at once.
class Prefetcher {
 public:
  void clear() { count_ = 0; }
  void add(const void* row) { row_[count_++] = static_cast<const float*>(row); }
  /// Asks for the lines that begin with float i of each row. Inlined by force: the compiler takes a
  /// function that only asks for one that does nothing.
  [[gnu::always_inline]] void prefetch_row(int i) const {
    if (i % kLine == 0)
      for (int k = 0; k < count_; ++k)
        __builtin_prefetch(row_[k] + i);
  }

 private:
  static constexpr int kLine = 16;
  const float* row_[10];  ///< eight of rays, two of hits
  int count_ = 0;
};

/// How packets of a size fared in a stream: tells whether to try the next one together.
class FrustumStats {
 public:
  /// If most packets fell apart, one in 16 is tried all the same.
  bool should_try() { return sum_ >= 0 || ++left_out_ % 16 == 0; }
  /// `saved`: the share of its rays' ways that the packet went together.
  void record(float saved) {
    // trying costs as much as a fifth of the rays' ways (measured)
    sum_ += static_cast<int>(10 * saved) - 2;
    sum_ = sum_ > kMost ? kMost : sum_ < -kMost ? -kMost : sum_;
  }

 private:
  static constexpr int kMost = 24;
  int sum_ = 0;
  unsigned left_out_ = 0;
};

/// Tells whether rays that pass a block's box are worth counting: not where most times they were
/// too many to be tested one by one.
class SingleRayStats {
 public:
  bool should_try() { return sum_ > 0 || ++left_out_ % 16 == 0; }
  void record(bool were_few) {
    sum_ += were_few ? 1 : -1;
    sum_ = sum_ > kMost ? kMost : sum_ < -kMost ? -kMost : sum_;
  }

 private:
  static constexpr int kMost = 8;
  int sum_ = 1;
  unsigned left_out_ = 0;
};

/// Up to kPacket rays. best <= t_min switches a ray off, as it is between `size` and the end of the
/// last group of lanes.
struct Packet : RayGroup<kPacket> {
  alignas(64) float start[kPacket];          ///< t from which a grid is still to be searched
  int group_axis[kPacket / kWidth<VFloat>];  ///< the axis all rays of a group share, or -1
  int size, groups;
  std::uint64_t live;  ///< bit g: group g has a ray that still searches
  bool has_units;      ///< `unit`, `given_t_min` and `given_t_max` are set
  bool has_slabs;      ///< `inverse` and `near` are set
  /// Fields of the primitive that a ray hits, as for_each_field() has them, if this is hit_field_id
  alignas(64) float hit_field[kMostFields][kPacket];
  alignas(64) float hit_field_id[kPacket];
  Prefetcher ahead;  ///< sources of the next packet's rays, and targets of this one's answers
  FrustumStats small_stats, middle_stats, large_stats;  ///< of packets of up to 16, 64 and 256
  SingleRayStats single_ray_stats;
};

/// Least size of a direction's components. A smaller one crosses no plane across its axis on any
/// way that counts; with this in its place, no NaN appears.
template <class Real>
inline Real min_advance(const Real& x, const Real& y, const Real& z) {
  return Real(kMinAdvance) * max_abs(max_abs(x, y), z);
}

/// Three components of lanes i, i + 1, ...
template <class Real, class Number, int kRays>
[[gnu::always_inline]] inline Vec3<Real> take_vec(const Number (&v)[3][kRays], int i) {
  return {
      take<Real>(v[0] + i),
      take<Real>(v[1] + i),
      take<Real>(v[2] + i),
  };
}
inline VFloat min_advance(const Packet& p, int i) {
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  return min_advance(d.x, d.y, d.z);
}

/// Fills the last group: its unused elements repeat the last ray, switched off.
inline void fill_up(Packet& p) {
  for (int i = p.size; i < p.groups * kWidth<VFloat>; ++i) {
    for (int a = 0; a < 3; ++a) {
      p.org[a][i] = p.org[a][p.size - 1];
      p.dir[a][i] = p.dir[a][p.size - 1];
    }
    p.t_min[i] = 0;
    p.best[i] = -kInfinity;
  }
}

/// Squares of directions up to this have no inverse in float.
inline constexpr float kNoInverse = 0x1p-128f;
/// Squared lengths of directions that are traced as they are. With others products of t, lengths of
/// directions and sizes of primitives, from 2^-60 to 2^60, leave what floats can hold.
inline constexpr float kShortest = 0x1p-4f;
inline constexpr float kLongest = 0x1p16f;

/// The powers of two by which directions are divided so that their largest component is in [1, 2);
/// 1 where they are fine as they are, or sound at no length.
template <class Real>
inline Real length_unit(const Vec3<Real>& dir) {
  const Real squared = dot(dir, dir);
  const Mask<Real> fine = mask_and(squared >= Real(kShortest), squared <= Real(kLongest));
  const Mask<Real> sound = mask_and(squared > Real(kNoInverse), squared < Real(kInfinity));
  constexpr int kMantissa = 23;
  const Int<Real> exponent = float_bits(largest(dir)) >> kMantissa;
  return select(and_not(sound, fine), bits_float(Int<Real>(exponent << kMantissa)), Real(1));
}

/// The end of a search by a direction that was divided by `unit`: never so far that t is no float.
inline float finite_end(float unit, float t_max) {
  return t_max == kInfinity && unit < 1 ? kGreatest : t_max;
}
/// Ends of a search in multiples of `unit`, rounded outwards: floats within are sure to be within
/// what the caller gave, and exact tests read that.
inline void count_in(float unit, float& t_min, float& t_max) {
  const double by = unit;
  t_min = round_down(by * t_min);
  t_max = round_up(by * t_max);
}

/// Keeps the ends of searches as the caller gave them.
inline void keep_ends(Packet& p) {
  for (int i = 0; i < p.groups * kWidth<VFloat>; ++i) {
    p.unit[i] = 1;
    p.given_t_min[i] = p.t_min[i];
    p.given_t_max[i] = p.best[i];
  }
  p.has_units = true;
  p.given.t_min = p.given_t_min;
  p.given.t_max = p.given_t_max;
  p.given.unit = p.unit;
}

/// Divides the directions of a group that need it. That changes no bit of an answer but where
/// something left the range of floats.
[[gnu::noinline]] inline void set_length_units(Packet& p, int first) {
  if (!p.has_units)
    keep_ends(p);
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, first);
  const VFloat unit = length_unit(d);
  store(p.unit + first, unit);
  store(p.dir[0] + first, d.x / unit);
  store(p.dir[1] + first, d.y / unit);
  store(p.dir[2] + first, d.z / unit);
  for (int i = first; i < first + kWidth<VFloat>; ++i)
    if (p.unit[i] != 1) {
      p.given_t_max[i] = p.best[i] = finite_end(p.unit[i], p.best[i]);
      count_in(p.unit[i], p.t_min[i], p.best[i]);
    }
}

/// Prepares directions and switches off rays with a NaN, an infinity, no direction or no way.
[[gnu::always_inline]] inline void check_rays(Packet& p, int i) {
  Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  VFloat dd = dot(d, d);
  const VFloat t_max = load<VFloat>(p.best + i);
  const Mask<VFloat> searches = next_above(load<VFloat>(p.t_min + i)) < t_max;
  store(p.best + i, select(searches, t_max, VFloat(-kInfinity)));
  if (any(mask_or(dd<VFloat(kShortest), dd> VFloat(kLongest)))) [[unlikely]] {
    set_length_units(p, i);
    d = take_vec<VFloat>(p.dir, i);
    dd = dot(d, d);
  }
  const Vec3<VFloat> o = take_vec<VFloat>(p.org, i);
  // NaN and infinity times zero are NaN
  const Mask<VFloat> finite = ((o.x + o.y) + (o.z + dd)) * VFloat(0) == VFloat(0);
  const Mask<VFloat> sound = mask_and(finite, dd > VFloat(kNoInverse));
  store(p.best + i, select(sound, load<VFloat>(p.best + i), VFloat(-kInfinity)));
}

/// The axis along which each ray of a group goes most.
[[gnu::always_inline]] inline void set_axes(Packet& p, int i, int group) {
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  const VFloat x = magnitude(d.x);
  const VFloat y = magnitude(d.y);
  const VFloat z = magnitude(d.z);
  const VFloat y_or_z = select(y >= z, VFloat(1), VFloat(2));
  const VFloat axis = select(mask_and(x >= y, x >= z), VFloat(0), y_or_z);
  store(p.axis + i, axis);
  p.group_axis[group] = none(axis != VFloat(p.axis[i])) ? static_cast<int>(p.axis[i]) : -1;
}

/// Kinds whose fields a packet keeps of what its rays hit: those of few fields.
template <class Shape>
inline constexpr bool kKeepsFields = Shape::kFinite &&
                                     sizeof(typename Shape::template Fields<float>) <=
                                         sizeof(float) * kMostFields;

/// Keeps the fields of the primitive that a ray hits: t is rounded from them, and need not fetch
/// them from the caller's arrays.
template <class Shape>
inline void keep_hit_fields(Packet& p, int i, const typename Shape::template Fields<float>& met) {
  int row = 0;
  Shape::for_each_field([&](const float& x) { p.hit_field[row++][i] = x; }, met);
  p.hit_field_id[i] = p.id[i];
}

/// Sets `inverse` and `near` of the rays from i on, for tests of boxes.
inline void set_slabs(Packet& p, int i) {
  const VFloat least = min_advance(p, i);
  for (int a = 0; a < 3; ++a) {
    const VFloat d = load<VFloat>(p.dir[a] + i);
    const VFloat inverse = VFloat(1) / with_advance(d, least);
    const auto low = static_cast<float>(a);
    store(p.inverse[a] + i, inverse);
    store_words(p.near[a] + i, to_words(select(inverse < VFloat(0), VFloat(low + 3), VFloat(low))));
  }
}

/// Runs `test(i)` for the first lane i of every live group.
template <class Test>
[[gnu::always_inline]] inline void each_live_group(const Packet& p, const Test& test) {
  for (std::uint64_t left = p.live; left != 0; left &= left - 1) {
    const int g = __builtin_ctzll(left);
    test(g * kWidth<VFloat>, g);
  }
}

/// Sets `inverse` and `near` of all groups, unless that is done: packets that stay together need
/// neither.
inline void need_slabs(Packet& p) {
  for (int g = 0; !p.has_slabs && g < p.groups; ++g)
    set_slabs(p, g * kWidth<VFloat>);
  p.has_slabs = true;
}

}  // namespace grelha::GRELHA_ISA
