#pragma once
// Rays as the tests of primitives see them, and what tests find: spans of t in floats, and the
// doubles and exact numbers that decide what floats cannot. Given floats are exact numbers.
// Derivations: docs/proofs.md.

#include <type_traits>

#include "grelha/geometry.hpp"
#include "kernel/base/exact_numbers.hpp"
#include "kernel/base/vec3.hpp"

namespace grelha {

/// A ray as it came; every number is a float's, times a power of two.
struct ExactRay {
  double org[3];
  double dir[3];
  double t_min, t_max;

  /// With t counted in another length: a power of two.
  ExactRay in_units_of(double unit) const {
    return {{org[0], org[1], org[2]},
            {dir[0] / unit, dir[1] / unit, dir[2] / unit},
            t_min * unit,
            t_max * unit};
  }
};

/// The first crossing beyond t_min of a ray and a primitive.
class ExactCrossing {
 public:
  ExactCrossing() = default;  ///< there is none
  /// t = numerator / denominator, which is not 0.
  ExactCrossing(const Expansion& numerator, const Expansion& denominator)
      : exists_(true), rational_(true), numerator_(numerator), denominator_(denominator) {}
  explicit ExactCrossing(const DoubleDouble& t) : exists_(true), t_(t) {}
  /// t = numerator / denominator times a power of two.
  ExactCrossing(Int128 numerator, Int128 denominator, double unit)
      : exists_(true), whole_(true), n_(numerator), d_(denominator), unit_(unit) {}

  bool some() const { return exists_; }
  /// The sign of t - x: exact for triangles and planes, of 100 bits for spheres and cones.
  int compare(double x) const;
  /// The sign of t - other.t: exact if both are triangles or planes. Others are equal if their
  /// first 90 bits agree.
  int compare(const ExactCrossing& other) const;
  /// t, within 2^-50 of itself.
  double estimate() const;
  /// The float nearest to t; of two the even one.
  float rounded() const;

 private:
  DoubleDouble wide() const;

  bool exists_ = false;
  bool rational_ = false;
  bool whole_ = false;
  Int128 n_ = 0, d_ = 0;
  double unit_ = 0;
  /// The same, of expansions.
  ExactCrossing unfolded() const;
  Expansion numerator_, denominator_;
  DoubleDouble t_;
};

/// From either side, edges and corners included. Rays in the plane of a triangle, and triangles
/// without an area, do not cross.
ExactCrossing cross_triangle(const ExactRay& ray, const float (&corner)[3][3]);
/// Weights of the corners where a ray crosses a triangle, given that it does: each within 2^-30,
/// none negative.
void crossing_weights(const ExactRay& ray, const float (&corner)[3][3], double (&weight)[3]);
/// True if a ray that is moved aside by an infinitesimal amount crosses between t_min and t_max.
/// Such a ray crosses no edge and no corner of a closed mesh, so its crossings are even in number
/// outside and odd inside. Edelsbrunner & Mücke, "Simulation of Simplicity", 1990.
bool crosses_perturbed(const ExactRay& ray, const float (&corner)[3][3]);
/// The order in which that ray crosses two triangles: -1, 0 (at the same t, as in one plane) or 1.
int order_perturbed(const ExactRay& ray, const float (&corner)[3][3], const float (&other)[3][3]);
/// Where the line of a ray crosses the plane of a triangle; it must.
ExactCrossing cross_plane_of(const ExactRay& ray, const float (&corner)[3][3]);
/// True if a ray that crosses a triangle comes from the side from which its corners are
/// counter-clockwise.
bool crosses_front(const ExactRay& ray, const float (&corner)[3][3]);
/// A complex number whose angle is half the solid angle of a triangle, as solid_angle.hpp has it.
struct SolidAngleParts {
  double real;
  double volume;  ///< the imaginary part: its sign is exact
};
/// In numbers of 106 bits: within 2^-94 of the product of the distances to the corners, and
/// rounded.
SolidAngleParts solid_angle_parts(const double (&point)[3], const float (&corner)[3][3]);
/// True if a point lies within a distance of another: exact.
bool is_within(const double (&point)[3], const float (&center)[3], float radius);
/// From either side. Rays along a plane do not cross.
ExactCrossing cross_plane(const ExactRay& ray, const float (&point)[3], const float (&normal)[3]);
/// From outside or inside; of a negative radius from inside alone. A line that touches crosses.
ExactCrossing cross_sphere(const ExactRay& ray, const float (&center)[3], float radius);

/// The side of a cone frustum, as Cone::Fields has it.
struct ExactCone {
  float base[3], axis[3], height, radius, slope, side;
};
ExactCrossing cross_cone(const ExactRay& ray, const ExactCone& cone);

}  // namespace grelha

// Rays as the tests of primitives see them, and what a test finds.

namespace grelha::GRELHA_ISA {

/// Rays as the caller gave them, for cases that tests cannot decide: element i of each array.
struct CallerRays {
  const float* org[3] = {};
  const float* dir[3] = {};
  const float* t_min = nullptr;
  const float* t_max = nullptr;   ///< read while a ray has hit nothing
  const float* unit = nullptr;    ///< length in which t counts, but not t_min and t_max; null: 1
  const double* shift = nullptr;  ///< t of a given ray minus t of the tested one; null: 0

  ExactRay ray(int i) const {
    const double by = unit ? unit[i] : 1;
    return {{org[0][i], org[1][i], org[2][i]},
            {dir[0][i], dir[1][i], dir[2][i]},
            by * t_min[i],
            by * t_max[i]};
  }
  double shift_of(int i) const { return shift ? shift[i] : 0; }
};

/// Rays side by side, or one ray in all lanes. In the frame of a grid, tests subtract `base` from
/// the coordinates of primitives.
template <class Real>
struct SimdRays {
  Vec3<Real> org, dir;
  Real inv_dd;      ///< 1 / dot(dir, dir)
  Real inv_length;  ///< see inverse_length
  Real t_min;
  Real frame_error;             ///< error of coordinates in the frame
  Real error_bound;             ///< kFarError times the greatest distance to a primitive, or
                                ///< infinity
  const float* base = nullptr;  ///< x, y, z; null: 0
  const CallerRays* given = nullptr;
  int first = 0;  ///< index of the first lane among those given
  int step = 0;   ///< 1: a ray a lane; 0: one in all

  /// From the rays to points of primitives.
  [[gnu::always_inline]] Vec3<Real> to(const Vec3<Real>& point) const {
    if (!base)
      return point - org;
    return (point - Vec3<Real>{Real(base[0]), Real(base[1]), Real(base[2])}) - org;
  }
};

/// At least 1 / |dir| and at most sqrt 3 times as much, without a square root. Off by 5 u.
template <class Real>
[[gnu::always_inline]] inline Real inverse_length(const Vec3<Real>& dir, const Real& inv_dd) {
  const Vec3<Real> size = sizes(dir);
  return ((size.x + size.y) + size.z) * inv_dd;
}

/// Half an ulp of 1.
template <class Real>
inline constexpr double kUnit = std::is_same_v<Scalar<Real>, float> ? 0x1p-24 : 0x1p-53;
/// `count` half ulps of 1, as a Real.
template <class Real>
[[gnu::always_inline]] inline Real units(double count) {
  return Real(static_cast<Scalar<Real>>(count * kUnit<Real>));
}
/// Products of four lengths below this may have underflowed.
template <class Real>
inline constexpr double kUnderflow = std::is_same_v<Scalar<Real>, float> ? 0x1p-100 : 0x1p-900;

/// The first crossings beyond t_min and before t_max that tests find. Lanes that are not `some`
/// have none; lanes that are `sure` have one, at t from lo to hi.
template <class Real>
struct HitInterval {
  Mask<Real> some, sure;
  Real lo, hi;
};

}  // namespace grelha::GRELHA_ISA

// Crossings that floats cannot decide are decided by doubles, and the rest by exact numbers.

namespace grelha {

/// t of a crossing, from lo to hi; NaN: there is none.
struct CrossingSpan {
  float lo = __builtin_nanf("");
  float hi = __builtin_nanf("");
};

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// One ray in double.
inline SimdRays<double> in_double(const ExactRay& r) {
  const Vec3<double> dir = vec(r.dir);
  const double inv_dd = 1 / dot(dir, dir);
  return {.org = vec(r.org),
          .dir = dir,
          .inv_dd = inv_dd,
          .inv_length = inverse_length(dir, inv_dd),
          .t_min = r.t_min,
          .frame_error = 0,
          .error_bound = __builtin_inf()};
}

/// Part i of rays as they came, in double.
template <int i, class Real>
[[gnu::always_inline]] inline SimdRays<Wide<Real>> given_in_double(const SimdRays<Real>& ray) {
  using W = Wide<Real>;
  const auto given = [&](const float* of) {
    of += ray.first;
    return ray.step == 0 ? W(static_cast<double>(*of)) : take<W>(of + i * kWidth<W>);
  };
  const auto of = [&](const auto& member, const Real& own) {
    return ray.base ? given(member(*ray.given)) : to_double<i>(own);
  };
  const auto t_min = [&] {
    if (ray.given && ray.given->unit)
      return given(ray.given->unit) * given(ray.given->t_min);
    return of([](const CallerRays& g) { return g.t_min; }, ray.t_min);
  };
  const auto origin = [](int axis) { return [axis](const CallerRays& g) { return g.org[axis]; }; };
  const Vec3<W> dir = to_double<i>(ray.dir);
  const W inv_dd = W(1) / dot(dir, dir);
  return {.org = {of(origin(0), ray.org.x), of(origin(1), ray.org.y), of(origin(2), ray.org.z)},
          .dir = dir,
          .inv_dd = inv_dd,
          .inv_length = inverse_length(dir, inv_dd),
          .t_min = t_min(),
          .frame_error = W(0),
          .error_bound = W(0)};
}
/// t of the rays as given minus t of the tested rays.
template <int i, class Real>
[[gnu::always_inline]] inline Wide<Real> shift_in_double(const SimdRays<Real>& ray) {
  using W = Wide<Real>;
  if (!ray.base)
    return W(0);
  return ray.step == 0 ? W(ray.given->shift[ray.first])
                       : load<W>(ray.given->shift + ray.first + i * kWidth<W>);
}
/// Moves a double by more than 2 u and the least float: it rounds to a float not above, or not
/// below.
template <class W>
[[gnu::always_inline]] inline W rounded_down(const W& a) {
  return a - (magnitude(a) * W(0x1p-23) + W(0x1p-149));
}
template <class W>
[[gnu::always_inline]] inline W rounded_up(const W& a) {
  return a + (magnitude(a) * W(0x1p-23) + W(0x1p-149));
}

/// Upper and lower bounds of t, counted from `shift` on: doubles round the difference by 2^-53 of
/// itself.
inline float round_t_up(double t, double shift) {
  return round_up((t - shift) + magnitude(t - shift) * 0x1p-52);
}
inline float round_t_down(double t, double shift) {
  return round_down((t - shift) - magnitude(t - shift) * 0x1p-52);
}

/// Floats around [lo, hi], t being counted from `shift` on.
inline CrossingSpan span_from(double lo, double hi, double shift) {
  return {round_t_down(lo, shift), round_t_up(hi, shift)};
}
inline CrossingSpan span_of(const ExactCrossing& crossing, double shift) {
  const double t = crossing.estimate();
  return span_from(t - magnitude(t) * 0x1p-48, t + magnitude(t) * 0x1p-48, shift);
}

/// The span of a crossing from doubles, or else from cross(); t is counted from `shift` on.
template <class Cross>
inline CrossingSpan refine_span(const HitInterval<double>& found,
                                double shift,
                                const Cross& cross) {
  if (!found.some)
    return {};
  if (found.sure)
    return span_from(found.lo, found.hi, shift);
  const ExactCrossing exact = cross();
  return exact.some() ? span_of(exact, shift) : CrossingSpan{};
}

/// Replaces selected lanes of `found` by span_of(lane).
template <class Real, class SpanOf>
inline void replace_selected(unsigned selected, HitInterval<Real>& found, const SpanOf& span_of) {
  Scalar<Real> lo[kWidth<Real>], hi[kWidth<Real>];
  store(lo, found.lo);
  store(hi, found.hi);
  each_bit(selected, [&](int k) {
    const CrossingSpan span = span_of(k);
    lo[k] = span.lo;
    hi[k] = span.hi;
  });
  load(lo, found.lo);
  load(hi, found.hi);
  found.some = mask_and(found.some, found.hi == found.hi);
}

}  // namespace grelha::GRELHA_ISA

// Decides what floats cannot: where a hit is, and which of two hits is first. Doubles are tried
// first, then exact numbers.

namespace grelha {

struct GeometryView;

/// The span of t - shift of the first crossing beyond t_min of a ray and one primitive of a kind,
/// with the given Fields<float>.
CrossingSpan crossing_span(PrimitiveKind kind,
                           const ExactRay& ray,
                           const void* fields,
                           double shift);
/// The same for the primitive `id`.
CrossingSpan crossing_span(const GeometryView& g,
                           const ExactRay& ray,
                           std::uint32_t id,
                           double shift);

/// t of the first crossing of a ray and a primitive beyond t_min: surely none unless `some`, and
/// surely one from lo to hi if `sure`. By doubles alone.
struct CrossingBounds {
  bool some, sure;
  double lo, hi;
};
CrossingBounds crossing_bounds(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// The same crossing, exactly.
ExactCrossing crossing_of(const GeometryView& g, const ExactRay& ray, std::uint32_t id);

/// True if a ray that crosses two primitives beyond t_min crosses `id` first; of equal t the lower
/// id is first. `first`: the span of t - shift of the first of the two.
bool is_closest(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                std::uint32_t other,
                double shift,
                CrossingSpan& first);
/// True if a ray along an axis, which crosses two triangles, does so at a vertex or an edge that
/// both have, at one t.
bool meet_on_axis(const GeometryView& g,
                  const ExactRay& ray,
                  std::uint32_t id,
                  std::uint32_t other);
/// True if a ray crosses a primitive before t_max, given that it crosses it beyond t_min.
bool is_before_end(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// Barycentric coordinates where a ray crosses a triangle, given that it does: those of Hits.
struct Barycentric {
  float u = 0, v = 0;
};
Barycentric barycentric(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// t of the first crossing, within 2^-45 of itself.
double double_t(const GeometryView& g, const ExactRay& ray, std::uint32_t id);
/// The same rounded once; faster for a sphere if `span` holds it.
float rounded_t(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                const CrossingSpan& span = {});

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// Replaces the selected lanes of crossings that floats found.
template <class Shape, class Real>
[[gnu::noinline, gnu::cold]] void refine_lanes(
    const SimdRays<Real>& ray,
    const typename Shape::template Fields<Real>& primitive,
    const Mask<Real>& selected,
    HitInterval<Real>& found) {
  using One = typename Shape::template Fields<float>;
  float field[sizeof(One) / sizeof(float)][kWidth<Real>];
  int count = 0;
  Shape::for_each_field([&](const Real& x) { store(field[count++], x); }, primitive);
  replace_selected(bits(selected), found, [&](int k) {
    One one;
    int next = 0;
    Shape::for_each_field([&](float& x) { x = field[next++][k]; }, one);
    const int at = ray.first + k * ray.step;
    return crossing_span(Shape::kKind, ray.given->ray(at), &one, ray.given->shift_of(at));
  });
}

/// Finds crossings of rays and primitives: lanes whose ray crosses at a t beyond t_min, which is
/// from lo to hi. Lanes whose t is surely beyond `best` are left out.
template <class Shape, class Real>
[[gnu::always_inline]] inline HitInterval<Real> intersect(
    const SimdRays<Real>& ray,
    const typename Shape::template Fields<Real>& primitive,
    const Real& best) {
  HitInterval<Real> found = bound(ray, primitive, best);
  const Mask<Real> unsure = and_not(found.some, found.sure);
  if (any(unsure)) [[unlikely]]
    refine_lanes<Shape>(ray, primitive, unsure, found);
  return found;
}

}  // namespace grelha::GRELHA_ISA
