#pragma once
// Rays as walks see them: groups by components, one by itself or in a packet, what they leave out,
// the lengths in which t counts, and the tolerances of walks.

#include "kernel/base/isa.hpp"
#include "kernel/shapes/shapes.hpp"
#include "kernel/base/lanes.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/traverse/candidates.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/base/lanes_four.hpp"

namespace grelha::GRELHA_ISA {

/// What rays leave out, from one of them on.
struct RayFilter {
  const std::uint32_t* skip = nullptr;      ///< [rays]; null: nothing
  const std::uint8_t* ray_masks = nullptr;  ///< [rays]; null: 255 for all
  const std::uint8_t* masks = nullptr;      ///< [primitives] by id; null: 255 for all
  CopyTable copies;

  /// What ray i hits where it crosses primitive `id`: of that and its copies the first that is not
  /// left out, or kNoPrimitive.
  std::uint32_t passing_copy(int i, std::uint32_t id) const {
    if (passes(i, id))
      return id;
    for (std::uint32_t c = copies.begin(id); copies.has(c, id); ++c)
      if (passes(i, copies.pair[c].copy))
        return copies.pair[c].copy;
    return kNoPrimitive;
  }
  /// The same of the rays `by` further on.
  RayFilter after(std::size_t by) const {
    RayFilter moved = *this;
    moved.skip = skip ? skip + by : nullptr;
    moved.ray_masks = ray_masks ? ray_masks + by : nullptr;
    return moved;
  }

 private:
  bool passes(int i, std::uint32_t id) const {
    const unsigned of_ray = ray_masks ? ray_masks[i] : 255;
    const unsigned of_primitive = masks ? masks[id] : 255;
    return !(skip && skip[i] == id) && (of_ray & of_primitive) != 0;
  }
};

}  // namespace grelha::GRELHA_ISA

namespace grelha {

/// Least size of a direction's component = kMinAdvance * the largest. Over a scene a ray strays
/// by as much of it, where floats stray by 1e-7.
inline constexpr float kMinAdvance = 1e-12f;

/// Share of a ray's direction (sum of its components) that must lie along a packet's major axis:
/// rays cross at most 17/3 cells sideways a slice. With less a slice is wider than what rays
/// would walk alone, and nothing bounds the slopes (measured).
inline constexpr float kLeastProgress = .15f;

/// Slices below which a packet's stay in a grid has no slopes: dividing by it would make them of
/// rounding.
inline constexpr float kThinStay = 1e-3f;

/// Sides of a frustum: error <= kSideRounding * farthest position * steepest slope, 38 u.
inline constexpr float kSideRounding = 2.3e-6f;

/// Planes in world coordinates: further error <= kPlaneRounding * farthest position from 0 *
/// steepest slope, 14 u.
inline constexpr float kPlaneRounding = 1e-6f;

/// A float test may find a ball or a cone hit that lies within kPadOfBalls * pad of a ray of the
/// frustum. That is 127 u of the scene's diagonal; half a pad is 128.
inline constexpr float kPadOfBalls = .5f;

/// A hit may lie kNearSlack * farthest position before its ray's start: 46 u of the way along the
/// major axis, which is at most twice the farthest: 92 u.
inline constexpr float kNearSlack = 6e-6f;

/// End of a way through a box *= kOutsideSlack, wherever the ray starts: t of its planes are off by
/// 3 u of themselves each, 6 u of 16.8 u.
inline constexpr float kOutsideSlack = 1.000001f;
/// Added to the same: more than t of two planes lose to underflow, 2^-149 each.
inline constexpr float kOutsideUnderflow = 0x1p-140f;

/// Length of a plane's gradient *= kGradientTolerance: it is off by 2.5 u.
inline constexpr float kGradientTolerance = 1.00001f;

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// A component of a direction, at least `least` in size.
template <class Real>
[[gnu::always_inline]] inline Real with_advance(const Real& component, const Real& least) {
  const Real o = least - least;
  return select(magnitude(component) < least, select(component < o, o - least, least), component);
}

/// Clips [t0, t1] to the interval between two planes across an axis, which rays cross at `near` and
/// then at `far`. A NaN, of a ray in a plane, clips nothing.
template <class Real>
[[gnu::always_inline]] inline void clip_to_slab(const Real& near,
                                                const Real& far,
                                                Real& t0,
                                                Real& t1) {
  t0 = max(near, t0);
  t1 = min(far, t1);
}

/// The same for planes at lo and hi, whichever a ray crosses first. `inverse`: of its direction.
template <class Real>
[[gnu::always_inline]] inline void clip_to_slab(
    const Real& lo, const Real& hi, const Real& org, const Real& inverse, Real& t0, Real& t1) {
  const Real x = (lo - org) * inverse;
  const Real y = (hi - org) * inverse;
  clip_to_slab(min(x, y), max(x, y), t0, t1);
}

inline constexpr float kInfinity = __builtin_inff();

/// The scene of rays, the rays as the caller gave them, and the frame that they are in.
struct RayFrame {
  const GeometryView* geometry = nullptr;
  CallerRays given;
  const RayFilter* filter = nullptr;    ///< null: rays hit everything
  CandidateSink* candidates = nullptr;  ///< of searches for all hits
  const float* base = nullptr;          ///< x, y, z of where the frame begins; null: 0
  float frame_error = 0;                ///< error of coordinates in the frame
  float error_bound = kInfinity;        ///< see SimdRays

  /// True if ray i hits nothing where it crosses primitive `id`.
  bool is_filtered(int i, std::uint32_t id) const {
    return filter && filter->passing_copy(i, id) == kNoPrimitive;
  }
};

/// The same in the frame of a grid; `shift` as in CallerRays.
inline RayFrame grid_frame(const RayFrame& from, const GridView& g, const double* shift) {
  RayFrame to = from;
  to.given.shift = shift;
  to.base = g.lo_f;
  to.frame_error = g.frame_error;
  to.error_bound = g.error_bound + static_cast<float>(2 * kFarError) * g.frame_error;
  return to;
}

inline std::uint32_t id_of(float bits) {
  return static_cast<std::uint32_t>(float_bits(bits));
}
inline float bits_of(std::uint32_t id) {
  return bits_float(static_cast<std::int32_t>(id));
}

/// K rays. Each searches (t_min, best). `id` holds the bits of the nearest primitive so far, which
/// is hit at a t from `low` to `best`; while there is none both are the end of the search.
///
/// Rays from afar are copied into the frame of a grid: `given` holds the rays before that.
template <int K>
struct RayGroup : RayFrame {
  static constexpr std::size_t kAlign = K > 1 ? 64 : alignof(float);
  static constexpr int kRows = K > 1 ? 3 : 4;  ///< of one ray four are stored at once
  alignas(kAlign) float org[3][K];
  alignas(kAlign) float dir[3][K];
  alignas(kAlign) float t_min[K];
  alignas(kAlign) float best[K];
  alignas(kAlign) float low[K];
  alignas(kAlign) float id[K];
  alignas(kAlign) float inv_dd[K];
  alignas(kAlign) float inv_length[K];
  // With triangles or boxes only.
  alignas(kAlign) float axis[K];  ///< of the shear: 0, 1 or 2
  alignas(kAlign) float shear[kRows][K];
  alignas(kAlign) float inverse[kRows][K];  ///< of directions, no component 0
  /// the side of a box that the ray hits first, along each axis; the other is 3 on or back
  alignas(kAlign) std::uint32_t near[kRows][K];
  // Where directions were divided by a length: that, and ends of searches in the caller's lengths.
  alignas(kAlign) float unit[K];
  alignas(kAlign) float given_t_min[K];
  alignas(kAlign) float given_t_max[K];
};

inline constexpr float kGreatest = 0x1.fffffep127f;
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
/// Squares of directions up to this have no inverse in float.
inline constexpr float kNoInverse = 0x1p-128f;
/// Squared lengths of directions that are traced as they are. With others products of t, lengths of
/// directions and sizes of primitives, from 2^-60 to 2^60, leave what floats can hold.
inline constexpr float kMinSquaredLength = 0x1p-4f;
inline constexpr float kMaxSquaredLength = 0x1p16f;

/// The powers of two by which directions are divided so that their largest component is in [1, 2);
/// 1 where they are fine as they are, or sound at no length.
template <class Real>
inline Real direction_scale(const Vec3<Real>& dir) {
  const Real squared = dot(dir, dir);
  const Mask<Real> fine =
      mask_and(squared >= Real(kMinSquaredLength), squared <= Real(kMaxSquaredLength));
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
inline void scale_interval(float unit, float& t_min, float& t_max) {
  const double by = unit;
  t_min = round_down(by * t_min);
  t_max = round_up(by * t_max);
}

/// A ray by itself.
struct Single : RayGroup<1> {
  const TriangleBlock* block = nullptr;  ///< of the last triangle that came first
};

/// One ray of a group, as tests of one ray take it.
template <class Group>
struct RayOf {
  Group& rays;
  int i;
};
template <>
struct RayOf<Single> {
  Single& rays;
  static constexpr int i = 0;
};
struct Packet;
using PacketRay = RayOf<Packet>;
using SingleRay = RayOf<Single>;

template <class Group>
inline std::uint32_t id_of(const RayOf<Group>& r) {
  return id_of(r.rays.id[r.i]);
}
template <class Group>
inline void set_hit(const RayOf<Group>& r, const CrossingSpan& t, std::uint32_t id) {
  r.rays.best[r.i] = t.hi;
  r.rays.low[r.i] = t.lo;
  r.rays.id[r.i] = bits_of(id);
}

/// Sets the inverse direction and the near sides of boxes, which tests of triangles also need.
inline void set_inverse(Single& r, const Vec3<float>& d) {
  const Four least = four(min_advance(d.x, d.y, d.z));
  const Four dir{d.x, d.y, d.z, 1};
  const Four inverse = four(1) / with_advance(dir, least);
  const FourInts low{0, 1, 2, 0};
  store(r.inverse, inverse);
  store(r.near, inverse < four(0) ? low + 3 : low);
}

/// The direction and the ends of a ray, as set_direction_scales() has them.
inline Vec3<float> set_direction_scale(Single& r, const Ray& ray) {
  const Vec3<float> dir{ray.dir.x, ray.dir.y, ray.dir.z};
  const float unit = direction_scale(dir);
  *r.unit = unit;
  *r.t_min = *r.given_t_min = ray.t_min;
  *r.best = *r.given_t_max = ray.t_max;
  if (unit == 1) [[likely]]
    return dir;
  *r.best = *r.given_t_max = finite_end(unit, ray.t_max);
  scale_interval(unit, *r.t_min, *r.best);
  return {dir.x / unit, dir.y / unit, dir.z / unit};
}

/// t of a hit between the ends of its search, which rounding may have taken it to.
inline float strictly_between(float t, float t_min, float t_max) {
  const float after = t > t_min ? t : next_above(t_min);
  return (after < t_max ? after : next_below(t_max)) + 0.f;  // no zero is -0
}

/// Prepares a ray by itself, as prepare(Packet&) does many. False: it hits nothing, r is
/// incomplete.
inline bool prepare(Single& r, const Ray& ray, bool any_triangles) {
  if (!(next_above(ray.t_min) < ray.t_max))
    return false;
  const Vec3<float> d = set_direction_scale(r, ray);
  const Float3& org = ray.org;
  const float dd = dot(d, d);
  // NaN and infinity times zero are NaN
  const float sum = ((org.x + org.y) + (org.z + dd)) + 1 / dd;
  if (!(sum * 0 == 0))
    return false;
  *r.org[0] = org.x;
  *r.org[1] = org.y;
  *r.org[2] = org.z;
  *r.dir[0] = d.x;
  *r.dir[1] = d.y;
  *r.dir[2] = d.z;
  *r.low = *r.best;
  *r.id = bits_of(kNoPrimitive);
  r.given = {{r.org[0], r.org[1], r.org[2]},
             {r.dir[0], r.dir[1], r.dir[2]},
             r.given_t_min,
             r.given_t_max,
             r.unit};
  *r.inv_dd = 1 / dd;
  *r.inv_length = inverse_length(d, *r.inv_dd);
  *r.axis = 0;
  if (any_triangles) {
    *r.axis = static_cast<float>(largest_axis(d.x, d.y, d.z));
    const Vec3<float> q = permute_axes<float>(*r.axis, d);
    store(r.shear, Four{q.x, q.y, 1, 1} / four(q.z));
    set_inverse(r, d);
  }
  return true;
}

}  // namespace grelha::GRELHA_ISA
