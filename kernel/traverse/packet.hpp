#pragma once
// A packet: rays side by side that walk grids and are tested against primitives; how the hits of
// rays, in packets and alone, are taken; and t of hits, rounded once: in double, side by side, and
// exactly where doubles cannot decide which float is nearest.

#include "grelha/stats.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/traverse/ray.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha::GRELHA_ISA {

/// Most rays in a packet. A word has a bit for each group of lanes.
inline constexpr int kPacket = kWidth<VFloat> == 1 ? 64 : 256;
inline constexpr int kMostFields = 9;  ///< those of a triangle; see kKeepsFields

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

/// Keeps the ends of searches as the caller gave them.
inline void save_intervals(Packet& p) {
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
[[gnu::noinline]] inline void set_direction_scales(Packet& p, int first) {
  if (!p.has_units)
    save_intervals(p);
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, first);
  const VFloat unit = direction_scale(d);
  store(p.unit + first, unit);
  store(p.dir[0] + first, d.x / unit);
  store(p.dir[1] + first, d.y / unit);
  store(p.dir[2] + first, d.z / unit);
  for (int i = first; i < first + kWidth<VFloat>; ++i)
    if (p.unit[i] != 1) {
      p.given_t_max[i] = p.best[i] = finite_end(p.unit[i], p.best[i]);
      scale_interval(p.unit[i], p.t_min[i], p.best[i]);
    }
}

/// Prepares directions and switches off rays with a NaN, an infinity, no direction or no way.
[[gnu::always_inline]] inline void check_rays(Packet& p, int i) {
  Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  VFloat dd = dot(d, d);
  const VFloat t_max = load<VFloat>(p.best + i);
  const Mask<VFloat> searches = next_above(load<VFloat>(p.t_min + i)) < t_max;
  store(p.best + i, select(searches, t_max, VFloat(-kInfinity)));
  if (any(mask_or(dd<VFloat(kMinSquaredLength), dd> VFloat(kMaxSquaredLength)))) [[unlikely]] {
    set_direction_scales(p, i);
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

/// Counts tests of a kind; those of a kind without a counter are not counted.
template <class Shape>
[[gnu::always_inline]] inline void count_tests(TraceCounts& n, unsigned tests) {
  if constexpr (Shape::kKind == PrimitiveKind::kSphere)
    n.tests.sphere += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kTriangle)
    n.tests.triangle += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kCone)
    n.tests.cone += tests;
  else if constexpr (Shape::kKind == PrimitiveKind::kPlane)
    n.tests.plane += tests;
}

/// Replaces TraceCounts when no caller asks for them: clearing these took up to a twentieth of a
/// call for one ray.
struct NoCounts {};

/// Counts the rows of primitives that a ray is tested against.
template <class Shape>
inline void count_rows(TraceCounts& n, int rows, int width) {
  n.rows.primitives += static_cast<unsigned>(rows);
  count_tests<Shape>(n, static_cast<unsigned>(rows * width));
}
template <class Shape>
inline void count_rows(NoCounts&, int, int) {}

/// Takes a hit that floats cannot tell from ray i's hit so far, `held`, or from the end of its
/// search: returns which counts, or kNoPrimitive, and `span` of the first one.
[[gnu::noinline, gnu::cold]] inline std::uint32_t resolve_tie(
    const RayFrame& frame, int i, std::uint32_t held, std::uint32_t id, CrossingSpan& span) {
  const ExactRay ray = frame.given.ray(i);
  const double shift = frame.given.shift_of(i);
  if (held != kNoPrimitive && meet_on_axis(*frame.geometry, ray, id, held))
    return id < held ? id : held;  // `span` holds t of both
  if (held != kNoPrimitive)
    return is_closest(*frame.geometry, ray, id, held, shift, span) ? id : held;
  if (!is_before_end(*frame.geometry, ray, id))
    return kNoPrimitive;
  span = crossing_span(*frame.geometry, ray, id, shift);
  return id;
}

/// Takes one hit. Returns whether the search is over (kAny and something was hit).
template <bool kAny, class Ray>
[[gnu::always_inline]] inline bool take_hit(Ray r, const CrossingSpan& t, std::uint32_t id) {
  if (!(t.lo <= r.rays.best[r.i]))
    return false;
  if (const RayFilter* const filter = r.rays.filter) [[unlikely]] {
    id = filter->passing_copy(r.i, id);
    if (id == kNoPrimitive)
      return false;
  }
  CrossingSpan first = t;
  if (!(t.hi < r.rays.low[r.i])) {
    if (id == id_of(r))
      return false;
    id = resolve_tie(r.rays, r.i, id_of(r), id, first);
    if (id == kNoPrimitive)
      return false;
  }
  set_hit(r, first, id);
  return kAny;
}

/// The same of a ray of a packet, which with kAny stops searching.
template <bool kAny>
[[gnu::noinline]] void take_hit(Packet& p, int i, const CrossingSpan& t, std::uint32_t id) {
  const PacketRay r{p, i};
  if (take_hit<kAny>(r, t, id))
    set_hit(r, {-kInfinity, -kInfinity}, id_of(r));
}

/// The rays from i on, as tests read them.
[[gnu::always_inline]] inline SimdRays<VFloat> simd_rays(const Packet& p, int i) {
  return {.org = take_vec<VFloat>(p.org, i),
          .dir = take_vec<VFloat>(p.dir, i),
          .inv_dd = load<VFloat>(p.inv_dd + i),
          .inv_length = load<VFloat>(p.inv_length + i),
          .t_min = load<VFloat>(p.t_min + i),
          .frame_error = VFloat(p.frame_error),
          .error_bound = VFloat(p.error_bound),
          .base = p.base,
          .given = &p.given,
          .first = i,
          .step = 1};
}

/// Precomputes what tests read of the directions from i on.
[[gnu::always_inline]] inline void set_directions(Packet& p, int i, bool any_triangles) {
  const Vec3<VFloat> d = take_vec<VFloat>(p.dir, i);
  const VFloat inv_dd = VFloat(1) / dot(d, d);
  store(p.inv_dd + i, inv_dd);
  store(p.inv_length + i, inverse_length(d, inv_dd));
  if (!any_triangles)
    return;
  const Vec3<VFloat> q = permute_axes(load<VFloat>(p.axis + i), d);
  store(p.shear[0] + i, q.x / q.z);
  store(p.shear[1] + i, q.y / q.z);
  store(p.shear[2] + i, VFloat(1) / q.z);
}

/// Completes a packet whose org, dir, t_min, best and size are set.
inline void prepare(Packet& p, const GeometryView& geometry, bool any_triangles) {
  constexpr int w = kWidth<VFloat>;
  p.geometry = &geometry;
  p.error_bound = kInfinity;
  p.given = {{p.org[0], p.org[1], p.org[2]}, {p.dir[0], p.dir[1], p.dir[2]}, p.t_min, p.best};
  p.groups = (p.size + w - 1) / w;
  p.live = ~std::uint64_t{0} >> (64 - p.groups);
  p.has_units = false;
  p.has_slabs = false;
  fill_up(p);
  for (int g = 0; g < p.groups; ++g) {
    const int i = g * w;
    p.ahead.prefetch_row(i);
    store(p.id + i, VFloat(bits_of(kNoPrimitive)));
    store(p.hit_field_id + i, VFloat(bits_of(kNoPrimitive)));
    check_rays(p, i);
    store(p.low + i, load<VFloat>(p.best + i));
    if (any_triangles)
      set_axes(p, i, g);
    set_directions(p, i, any_triangles);
  }
}

/// Ids of the primitives that the rays from i on hit.
inline VUint ids_at(const Packet& p, int i) {
  return load_words<VFloat>(reinterpret_cast<const std::uint32_t*>(p.id + i));
}

/// Takes hits of selected lanes from i on against one primitive, one by one.
template <bool kAny>
[[gnu::noinline]] void take_hits(
    Packet& p, int i, const HitInterval<VFloat>& found, unsigned lanes, std::uint32_t id) {
  float lo[kWidth<VFloat>], hi[kWidth<VFloat>];
  store(lo, found.lo);
  store(hi, found.hi);
  each_bit(lanes, [&](int k) { take_hit<kAny>(p, i + k, {lo[k], hi[k]}, id); });
}

/// True if one of the rays from i on does not hit primitive `id` itself where it crosses it.
inline bool any_filtered(const Packet& p, int i, unsigned lanes, std::uint32_t id) {
  bool some = false;
  each_bit(lanes, [&](int k) { some |= p.filter->passing_copy(i + k, id) != id; });
  return some;
}

/// Notes hits of lanes from i on against one primitive: nearer wins, then the lower id. With kAny a
/// hit ends the ray's search.
template <bool kAny, class Shape>
inline void record(Packet& p,
                   int i,
                   const HitInterval<VFloat>& found,
                   std::uint32_t id,
                   const typename Shape::template Fields<float>& met) {
  const VFloat best = load<VFloat>(p.best + i);
  const Mask<VFloat> candidate = mask_and(found.some, found.lo <= best);
  if (none(candidate))
    return;
  if (p.filter && any_filtered(p, i, bits(candidate), id)) [[unlikely]] {
    take_hits<kAny>(p, i, found, bits(candidate), id);
    return;
  }
  const VFloat low = load<VFloat>(p.low + i);
  const Mask<VFloat> closer = mask_and(candidate, found.hi < low);
  const VFloat over(-kInfinity);
  store_selected(p.best + i, closer, kAny ? over : found.hi);
  store_selected(p.low + i, closer, kAny ? over : found.lo);
  store_selected(p.id + i, closer, VFloat(bits_of(id)));
  if constexpr (!kAny && kKeepsFields<Shape>) {
    int row = 0;
    Shape::for_each_field(
        [&](const float& x) __attribute__((always_inline)) {
          store_selected(p.hit_field[row] + i, closer, VFloat(x));
          ++row;
        },
        met);
    store_selected(p.hit_field_id + i, closer, VFloat(bits_of(id)));
  }
  const unsigned other = bits_where(ids_at(p, i) != id);
  if (const unsigned ties = bits(and_not(candidate, closer)) & other; ties != 0)
    take_hits<kAny>(p, i, found, ties, id);
}

/// Tests all live rays against a primitive of a kind and counts that: runs `test(i, g)` for the
/// first lane i of every live group g.
template <class Shape, class Test>
[[gnu::always_inline]] inline void each_tested(const Packet& p, TraceCounts& n, const Test& test) {
  unsigned busy = 0;  // in one pass with the tests: these look at best and t_min as well
  each_live_group(
      p, [&](int i, int g) __attribute__((always_inline)) {
        const unsigned on = bits(load<VFloat>(p.best + i) > load<VFloat>(p.t_min + i));
        busy += static_cast<unsigned>(__builtin_popcount(on));
        test(i, g);
      });
  n.packets.lanes_issued += static_cast<unsigned>(__builtin_popcountll(p.live) * kWidth<VFloat>);
  n.packets.lanes_busy += busy;
  count_tests<Shape>(n, busy);
}

/// All live rays against primitive `index` of many.
template <bool kAny, class Shape>
inline void test_one(Packet& p,
                     const FieldArrays<Shape>& of,
                     std::uint32_t index,
                     std::uint32_t id,
                     TraceCounts& n) {
  const auto one = broadcast<Shape, VFloat>(of, index);
  const auto met = one_of<Shape>(of, index);
  each_tested<Shape>(p, n, [&](int i, int) {
    record<kAny, Shape>(
        p, i, intersect<Shape>(simd_rays(p, i), one, load<VFloat>(p.best + i)), id, met);
  });
}

/// A triangle, as it is and in the frame of a packet, and the packet's rays from i on. They share
/// an axis, or each has its own: one test for both takes 1.05 of the instructions.
template <bool kShareAxis>
struct TriangleSource {
  const Packet& p;
  const Triangle::Fields<float>& as_it_is;
  const float (*corner)[3];
  int i, axis;
  std::uint32_t id;

  RayAndTriangle<VFloat> operator()() const {
    if constexpr (kShareAxis)
      return along_axis();
    else
      return permuted();
  }
  float frame_error() const { return p.frame_error; }
  ExactRay given(int k) const { return p.given.ray(i + k); }
  double shift(int k) const { return p.given.shift_of(i + k); }
  bool is_filtered(int k) const { return p.is_filtered(i + k, id); }
  void take_vertices(int, float (&to)[3][3]) const {
    __builtin_memcpy(to, as_it_is.corner, sizeof to);
  }

 private:
  [[gnu::always_inline]] RayAndTriangle<VFloat> along_axis() const {
    const int k = axis;
    const int kx = kNextAxis[k];
    const int ky = kPreviousAxis[k];
    const auto at = [&](int c) {
      const float* const v = corner[c];
      return Vec3<VFloat>{VFloat(v[kx]), VFloat(v[ky]), VFloat(v[k])};
    };
    return {{load<VFloat>(p.org[kx] + i), load<VFloat>(p.org[ky] + i), load<VFloat>(p.org[k] + i)},
            {load<VFloat>(p.dir[kx] + i), load<VFloat>(p.dir[ky] + i), load<VFloat>(p.dir[k] + i)},
            {at(0), at(1), at(2)}};
  }
  [[gnu::always_inline]] RayAndTriangle<VFloat> permuted() const {
    const VFloat axes = load<VFloat>(p.axis + i);
    const auto at = [&](int c) {
      const float* const v = corner[c];
      return permute_axes<VFloat>(axes, {VFloat(v[0]), VFloat(v[1]), VFloat(v[2])});
    };
    return {permute_axes(axes, take_vec<VFloat>(p.org, i)),
            permute_axes(axes, take_vec<VFloat>(p.dir, i)),
            {at(0), at(1), at(2)}};
  }
};

template <bool kAny>
[[gnu::noinline]] void test_triangle(Packet& p,
                                     const Triangle::Fields<float>& triangle,
                                     std::uint32_t id,
                                     TraceCounts& n) {
  Triangle::Fields<float> framed;
  for (int k = 0; p.base && k < 3; ++k)
    for (int a = 0; a < 3; ++a)
      framed.corner[k][a] = triangle.corner[k][a] - p.base[a];
  each_tested<Triangle>(
      p, n, [&](int i, int g) __attribute__((always_inline)) {
        const Shear<VFloat> shear{load<VFloat>(p.shear[0] + i),
                                  load<VFloat>(p.shear[1] + i),
                                  load<VFloat>(p.shear[2] + i),
                                  VFloat(p.frame_error)};
        const VFloat t_min = load<VFloat>(p.t_min + i);
        const VFloat best = load<VFloat>(p.best + i);
        const float(*const corner)[3] = p.base ? framed.corner : triangle.corner;
        const int axis = p.group_axis[g];
        const auto found = [&]<bool kShareAxis>() __attribute__((always_inline)) {
          const TriangleSource<kShareAxis> source{p, triangle, corner, i, axis, id};
          return intersect_triangle(source, shear, t_min, best);
        };
        record<kAny, Triangle>(
            p,
            i,
            axis >= 0 ? found.template operator()<true>() : found.template operator()<false>(),
            id,
            triangle);
      });
}

/// Fields of the primitives i as tests read them.
template <class Shape>
[[gnu::always_inline]] inline typename Shape::template Fields<VFloat> fields_at(
    const typename Shape::Arrays& all, const VUint& i) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    Triangle::Fields<VFloat> to;
    for (int k = 0; k < 3; ++k) {
      const VUint vertex = words_at(all.corner[k], i);
      for (int a = 0; a < 3; ++a)
        to.corner[k][a] = floats_at(all.vertex[a], vertex);
    }
    return to;
  } else {
    return gathered<Shape, VFloat>(all.fields, i);
  }
}

/// The same of the rays from i on: what their packet kept, where it kept all.
template <class Shape>
[[gnu::always_inline]] inline typename Shape::template Fields<VFloat> hit_fields(
    const Packet& p, int i, unsigned lanes, const typename Shape::Arrays& all, const VUint& index) {
  if constexpr (kKeepsFields<Shape>) {
    const VUint met =
        load_words<VFloat>(reinterpret_cast<const std::uint32_t*>(p.hit_field_id + i));
    if ((lanes & ~bits_where(met == ids_at(p, i))) == 0) [[likely]] {
      typename Shape::template Fields<VFloat> to;
      int row = 0;
      Shape::for_each_field([&](VFloat& x) { x = load<VFloat>(p.hit_field[row++] + i); }, to);
      return to;
    }
  }
  return fields_at<Shape>(all, index);
}

/// Spans of t, part after part; NaN where double does not tell.
template <class Shape, int k = 0>
[[gnu::always_inline]] inline void hit_spans(const Packet& p,
                                             int i,
                                             const SimdRays<VFloat>& rays,
                                             const typename Shape::template Fields<VFloat>& met,
                                             VDouble (&lo)[kWideParts<VFloat>],
                                             VDouble (&hi)[kWideParts<VFloat>]) {
  using W = VDouble;
  const W unknown(__builtin_nan(""));
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    const auto& c = met.corner;
    const TriangleVertices<W> corner{
        to_double<k>(vec(c[0])), to_double<k>(vec(c[1])), to_double<k>(vec(c[2]))};
    const PlaneSpan<W> span = plane_span<W>(to_double<k>(rays.org), to_double<k>(rays.dir), corner);
    lo[k] = select(span.known, span.lo, unknown);
    hi[k] = span.hi;
  } else {
    const HitInterval<W> found = [&]() __attribute__((always_inline)) {
      const auto wide = given_in_double<k>(rays);
      const auto primitive = fields_to_double<Shape, k, VFloat>(met);
      if constexpr (Shape::kKind == PrimitiveKind::kSphere) {
        const int at = i + k * kWidth<W>;
        return narrowed(wide, primitive, take<W>(p.low + at), take<W>(p.best + at));
      } else {
        return bound(wide, primitive, W(static_cast<double>(kInfinity)));
      }
    }
    ();
    lo[k] = select(found.sure, found.lo, unknown);
    hi[k] = found.hi;
  }
  if constexpr (k + 1 < kWideParts<VFloat>)
    hit_spans<Shape, k + 1>(p, i, rays, met, lo, hi);
}

/// A ray of a packet, with t counted as the caller does.
inline ExactRay caller_ray(const Packet& p, int i) {
  const ExactRay ray = p.given.ray(i);
  return p.has_units ? ray.in_units_of(1 / static_cast<double>(p.unit[i])) : ray;
}

/// t of the rays of a packet from i on that hit primitives of the kinds of a set, to t[0] and on;
/// that of others stays.
template <class Set>
inline void round_hits(const Packet& p, int i, float* t) {
  const GeometryView& g = *p.geometry;
  const VUint id = ids_at(p, i);
  Set::for_each([&]<class Shape>() __attribute__((always_inline)) {
    const std::uint32_t first = g.ids.begin(Shape::kKind);
    const auto here = id - first < g.ids.count(Shape::kKind);
    const unsigned lanes = bits_where(here);
    if (lanes == 0)
      return;
    const VUint index(here ? id - first : VUint{});
    VDouble lo[kWideParts<VFloat>], hi[kWideParts<VFloat>];
    hit_spans<Shape>(
        p, i, simd_rays(p, i), hit_fields<Shape>(p, i, lanes, g.of<Shape>(), index), lo, hi);
    if (p.has_units) [[unlikely]]
      for (int k = 0; k < kWideParts<VFloat>; ++k) {
        const auto unit = take<VDouble>(p.unit + i + k * kWidth<VDouble>);
        lo[k] = lo[k] / unit;
        hi[k] = hi[k] / unit;
      }
    const VFloat least = narrow<VFloat>(lo) + VFloat(0);  // no zero is -0
    const unsigned known = bits(least == narrow<VFloat>(hi));
    store(t, select(mask_of(VUint(here)), least, load<VFloat>(t)));
    each_bit(lanes & ~known,
             [&](int k) { t[k] = rounded_t(g, caller_ray(p, i + k), id_of(p.id[i + k])); });
  });
}

}  // namespace grelha::GRELHA_ISA
