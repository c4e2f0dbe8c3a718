// Rays along axes, which meet vertices and edges of regular meshes: doubles hold their edge
// functions exactly where differences of coordinates are as short as floats.

#include "kernel/shapes/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/shapes.hpp"
#include "kernel/shapes/rounding.hpp"

namespace grelha {

namespace {
bool is_along_axis(const ExactRay& r) {
  return (r.dir[0] == 0) + (r.dir[1] == 0) + (r.dir[2] == 0) == 2;
}
}  // namespace

/// The edges of a triangle as a ray along an axis passes them.
class AxisEdges {
 public:
  AxisEdges(const ExactRay& r, const float (&corner)[3][3]) {
    const int k = scalar::largest_axis(
        static_cast<float>(r.dir[0]), static_cast<float>(r.dir[1]), static_cast<float>(r.dir[2]));
    const int u = scalar::kNextAxis[k];
    const int v = scalar::kPreviousAxis[k];
    is_known_ = r.dir[u] == 0 && r.dir[v] == 0;
    if (!is_known_)
      return;
    double at[3][2];
    for (int i = 0; i < 3; ++i)
      for (const int side : {0, 1}) {
        const int a = side == 0 ? u : v;
        double rest = 0;
        two_sum(corner[i][a], -r.org[a], at[i][side], rest);
        is_known_ &=
            rest == 0 && at[i][side] == static_cast<double>(static_cast<float>(at[i][side]));
      }
    for (int i = 0; i < 3; ++i) {
      const double(&from)[2] = at[(i + 1) % 3];
      const double(&to)[2] = at[(i + 2) % 3];
      const double first = to[0] * from[1];  // products of two floats are exact
      const double second = to[1] * from[0];
      positive_ |= first > second;
      negative_ |= first < second;
      zeros_ |= unsigned{first == second} << i;
    }
  }

  /// True if doubles tell on which side of each edge the ray passes.
  bool is_known() const { return is_known_; }
  bool crosses() const { return positive_ != negative_; }

  /// True if two triangles have the vertex or the edge at which the ray crosses both.
  static bool meet(const AxisEdges& a,
                   const float (&corner)[3][3],
                   const AxisEdges& b,
                   const float (&other)[3][3]) {
    if (!a.is_known_ || !b.is_known_ || a.zeros_ == 0 || b.zeros_ == 0)
      return false;
    // a corner lies on the edges that are not opposite to it
    const auto crossed = [](const AxisEdges& edges, const float(&of)[3][3], const float*(&to)[2]) {
      int count = 0;
      for (int i = 0; i < 3; ++i)
        if ((edges.zeros_ >> i & 1) == 0)
          to[count++] = of[i];
      to[1] = count == 1 ? to[0] : to[1];
      return count > 0;
    };
    const float* one[2];
    const float* two[2];
    if (!crossed(a, corner, one) || !crossed(b, other, two))
      return false;
    const auto is_same = [](const float* p, const float* q) {
      return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    };
    return (is_same(one[0], two[0]) && is_same(one[1], two[1])) ||
           (is_same(one[0], two[1]) && is_same(one[1], two[0]));
  }

 private:
  bool is_known_ = false, positive_ = false, negative_ = false;
  unsigned zeros_ = 0;  ///< bit i: the ray is on the line of the edge that is opposite to corner i
};

/// bound_triangle() in double; of rays along axes it tells more.
inline scalar::HitInterval<double> bound_crossing(const ExactRay& ray,
                                                  const float (&corner)[3][3]) {
  scalar::HitInterval<double> found = scalar::bound_triangle(ray, corner);
  if (!found.some || found.sure || !is_along_axis(ray))
    return found;
  const AxisEdges edges(ray, corner);
  if (edges.is_known()) {
    found.some = edges.crosses();
    found.sure = found.some && found.lo > ray.t_min;
  }
  return found;
}

namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

template <class Shape>
using One = typename Shape::template Fields<float>;

template <class Shape>
scalar::HitInterval<double> double_interval(const ExactRay& ray, const One<Shape>& one) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    return bound_crossing(ray, one.corner);
  } else {
    const scalar::SimdRays<double> wide = scalar::in_double(ray);
    return scalar::bound(wide, scalar::fields_to_double<Shape, 0, float>(one), kNoEnd);
  }
}

template <class Shape>
ExactCrossing crossing_of(const ExactRay& ray, const One<Shape>& one) {
  if constexpr (Shape::kKind == PrimitiveKind::kTriangle) {
    return cross_triangle(ray, one.corner);
  } else {
    return scalar::exact_crossing(ray, one);
  }
}

scalar::HitInterval<double> double_interval(const GeometryView& g,
                                            const ExactRay& ray,
                                            std::uint32_t id) {
  return visit_primitive(
      g, id, [&]<class Shape>(const One<Shape>& one) { return double_interval<Shape>(ray, one); });
}

template <class Shape>
CrossingSpan span_of(const ExactRay& ray, const One<Shape>& primitive, double shift) {
  return scalar::refine_span(double_interval<Shape>(ray, primitive), shift, [&] {
    return crossing_of<Shape>(ray, primitive);
  });
}

}  // namespace

namespace {

bool is_same_point(const float (&a)[3], const float (&b)[3]) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

}  // namespace

CrossingSpan triangle_span(const ExactRay& ray, const float (&corner)[3][3], double shift) {
  // no area: many triangles of a mesh whose coordinates keep few digits
  if (is_same_point(corner[0], corner[1]) || is_same_point(corner[1], corner[2]) ||
      is_same_point(corner[2], corner[0]))
    return {};
  return scalar::refine_span(
      bound_crossing(ray, corner), shift, [&] { return cross_triangle(ray, corner); });
}

CrossingBounds crossing_bounds(const GeometryView& g, const ExactRay& ray, std::uint32_t id) {
  const scalar::HitInterval<double> found = double_interval(g, ray, id);
  return {found.some, found.sure, found.lo, found.hi};
}
ExactCrossing crossing_of(const GeometryView& g, const ExactRay& ray, std::uint32_t id) {
  return visit_primitive(
      g, id, [&]<class Shape>(const One<Shape>& one) { return crossing_of<Shape>(ray, one); });
}

CrossingSpan crossing_span(PrimitiveKind kind,
                           const ExactRay& ray,
                           const void* fields,
                           double shift) {
  CrossingSpan span;
  for_each_shape([&]<class Shape>() {
    if (kind == Shape::kKind)
      span = span_of<Shape>(ray, *static_cast<const One<Shape>*>(fields), shift);
  });
  return span;
}

CrossingSpan crossing_span(const GeometryView& g,
                           const ExactRay& ray,
                           std::uint32_t id,
                           double shift) {
  return visit_primitive(
      g, id, [&]<class Shape>(const One<Shape>& one) { return span_of<Shape>(ray, one, shift); });
}

bool meet_on_axis(const GeometryView& g,
                  const ExactRay& ray,
                  std::uint32_t id,
                  std::uint32_t other) {
  const std::uint32_t first = g.ids.begin(PrimitiveKind::kTriangle);
  if (!is_along_axis(ray) || !g.ids.has(PrimitiveKind::kTriangle, id) ||
      !g.ids.has(PrimitiveKind::kTriangle, other))
    return false;
  const One<Triangle> a = g.of<Triangle>().triangle(id - first);
  const One<Triangle> b = g.of<Triangle>().triangle(other - first);
  return AxisEdges::meet(AxisEdges(ray, a.corner), a.corner, AxisEdges(ray, b.corner), b.corner);
}

bool is_closest(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                std::uint32_t other,
                double shift,
                CrossingSpan& first) {
  const scalar::HitInterval<double> a = double_interval(g, ray, id);
  const scalar::HitInterval<double> b = double_interval(g, ray, other);
  if (a.sure && b.sure && (a.hi < b.lo || b.hi < a.lo)) {
    const scalar::HitInterval<double>& c = a.hi < b.lo ? a : b;
    first = scalar::span_from(c.lo, c.hi, shift);
    return a.hi < b.lo;
  }
  const ExactCrossing one = crossing_of(g, ray, id);
  const ExactCrossing two = crossing_of(g, ray, other);
  const int order = one.compare(two);
  const bool is_first = order != 0 ? order < 0 : id < other;
  first = scalar::span_of(is_first ? one : two, shift);
  return is_first;
}

bool is_before_end(const GeometryView& g, const ExactRay& ray, std::uint32_t id) {
  const scalar::HitInterval<double> found = double_interval(g, ray, id);
  if (found.sure && (found.hi < ray.t_max || found.lo >= ray.t_max))
    return found.hi < ray.t_max;
  return crossing_of(g, ray, id).compare(ray.t_max) < 0;
}

double double_t(const GeometryView& g, const ExactRay& ray, std::uint32_t id) {
  const scalar::HitInterval<double> found = double_interval(g, ray, id);
  const double t = .5 * found.lo + .5 * found.hi;
  if (found.sure && found.hi - found.lo <= 0x1p-45 * std::abs(t))
    return t;
  return crossing_of(g, ray, id).estimate();
}

Barycentric barycentric(const GeometryView& g, const ExactRay& ray, std::uint32_t id) {
  const One<Triangle> triangle =
      g.of<Triangle>().triangle(id - g.ids.begin(PrimitiveKind::kTriangle));
  double weight[3];
  if (!scalar::double_weights(ray, triangle.corner, weight))
    crossing_weights(ray, triangle.corner, weight);
  const float u = static_cast<float>(weight[1]) + 0.f;  // no zero is -0
  const float v = static_cast<float>(weight[2]) + 0.f;
  return {u, std::min(v, float_not_above(1 - static_cast<double>(u)))};
}

namespace {
scalar::HitInterval<double> narrow_interval(const GeometryView& g,
                                            const ExactRay& ray,
                                            std::uint32_t id,
                                            const CrossingSpan& span) {
  if (g.ids.has(PrimitiveKind::kSphere, id)) {
    const One<Sphere> sphere =
        primitive_at<Sphere>(g.of<Sphere>(), id - g.ids.begin(PrimitiveKind::kSphere));
    const scalar::HitInterval<double> found =
        scalar::narrowed<double>(scalar::in_double(ray),
                                 scalar::fields_to_double<Sphere, 0, float>(sphere),
                                 span.lo,
                                 span.hi);
    if (found.sure)
      return found;
  }
  return double_interval(g, ray, id);
}
}  // namespace

float rounded_t(const GeometryView& g,
                const ExactRay& ray,
                std::uint32_t id,
                const CrossingSpan& span) {
  const scalar::HitInterval<double> found = narrow_interval(g, ray, id, span);
  const auto first = static_cast<float>(found.lo);
  const bool known = found.sure && first == static_cast<float>(found.hi);
  return (known ? first : crossing_of(g, ray, id).rounded()) + 0.f;  // no zero is -0
}

}  // namespace grelha
