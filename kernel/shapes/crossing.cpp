#include "kernel/shapes/hit.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "kernel/base/exact_numbers.hpp"

namespace grelha {
namespace {

/// t of spheres and cones that agree to this part of themselves are equal.
constexpr double kEqualWide = 0x1p-90;
/// Volume between a point and three corners: error <= kWideVolumeError * product of its distances
/// to them.
constexpr double kWideVolumeError = 0x1p-94;

int sign_of(const DoubleDouble& x) {
  return x.high < 0 ? -1 : x.high > 0 ? 1 : 0;
}

int sign(const Expansion& x) {
  return x.sign();
}
int sign(Int128 x) {
  return grelha::sign_of(x);  // that of doubles stands before it here
}

WideVector wide(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
WideVector wide_difference(const float (&a)[3], const double (&b)[3]) {
  return {DoubleDouble(a[0]) - b[0], DoubleDouble(a[1]) - b[1], DoubleDouble(a[2]) - b[2]};
}

}  // namespace

ExactCrossing ExactCrossing::unfolded() const {
  return whole_ ? ExactCrossing(expansion_of(n_, unit_), expansion_of(d_, 1)) : *this;
}

DoubleDouble ExactCrossing::wide() const {
  if (whole_)
    return unfolded().wide();
  return rational_ ? DoubleDouble(numerator_) / DoubleDouble(denominator_) : t_;
}

int ExactCrossing::compare(double x) const {
  if (std::isinf(x))
    return x > 0 ? -1 : 1;
  if (whole_ && x == 0)
    return sign(n_) * sign(d_);
  if (whole_)
    return unfolded().compare(x);
  if (!rational_)
    return sign_of(t_ - x);
  return (numerator_ - denominator_ * x).sign() * denominator_.sign();
}

int ExactCrossing::compare(const ExactCrossing& other) const {
  if (whole_ && other.whole_ && unit_ == other.unit_)
    return compare_products(n_, other.d_, other.n_, d_) * sign(d_) * sign(other.d_);
  if ((whole_ || rational_) && (other.whole_ || other.rational_) && (whole_ || other.whole_))
    return unfolded().compare(other.unfolded());
  if (rational_ && other.rational_) {
    const Expansion apart = numerator_ * other.denominator_ - other.numerator_ * denominator_;
    return apart.sign() * denominator_.sign() * other.denominator_.sign();
  }
  const DoubleDouble a = wide();
  const DoubleDouble b = other.wide();
  const DoubleDouble apart = a - b;
  const double tolerance = kEqualWide * (std::abs(a.high) + std::abs(b.high));
  return std::abs(apart.high) <= tolerance ? 0 : sign_of(apart);
}

double ExactCrossing::estimate() const {
  if (whole_)
    return double_of(n_) / double_of(d_) * unit_;
  return rational_ ? numerator_.estimate() / denominator_.estimate() : t_.high;
}

float ExactCrossing::rounded() const {
  const double t = estimate();
  const auto near = static_cast<float>(t);
  const double from = near;
  const float next = std::nextafter(near, t > from ? INFINITY : -INFINITY);
  if (t == from || !std::isfinite(near) || !std::isfinite(next))
    return near;
  // the estimate may lie on the wrong side of the middle, no farther
  const int beyond = compare(.5 * from + .5 * next) * (t > from ? 1 : -1);
  const bool is_odd = std::bit_cast<std::uint32_t>(near) % 2 != 0;
  return beyond > 0 || (beyond == 0 && is_odd) ? next : near;
}

namespace {

/// Bits of lengths and of directions as integers. An edge function is the sum of six products of
/// two lengths and a direction, less than 2^124; three of them are less than 2^126. Six products of
/// three lengths are less than 2^123.
constexpr int kLengthBits = 40;
constexpr int kDirectionBits = 41;

/// A ray and the corners of a triangle, counted from the ray's origin.
struct IntegerTriangle {
  IntegerVector corner[3], dir[1];
  double unit, dir_unit;
};

/// Returns false if the numbers do not fit: floats of very unequal sizes.
bool to_integers(const ExactRay& ray, const float (&corner)[3][3], IntegerTriangle& found) {
  double from_org[3][3];
  double lost = 0;
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) {
      double rest = 0;
      two_sum(corner[i][a], -ray.org[a], from_org[i][a], rest);
      lost += std::abs(rest);
    }
  const double dir[1][3] = {{ray.dir[0], ray.dir[1], ray.dir[2]}};
  return lost == 0 && to_integers(from_org, kLengthBits, found.corner, found.unit) &&
         to_integers(dir, kDirectionBits, found.dir, found.dir_unit);
}

/// Tells from edge functions if a ray crosses a triangle, edges and corners included; adds them.
/// edge(i) is opposite to corner i.
template <class Number, class Edge>
bool crosses_inside(const Edge& edge, Number& sum) {
  int least = 1;
  int most = -1;
  for (int i = 0; i < 3; ++i) {
    const Number one = edge(i);
    least = std::min(least, sign(one));
    most = std::max(most, sign(one));
    if (least * most < 0)
      return false;
    sum += one;
  }
  return sign(sum) != 0;
}

/// t = numerator / denominator times a power of two, if there is a crossing.
struct IntegerCrossing {
  bool some = false;
  Int128 numerator = 0, denominator = 0;
  double unit = 0;
};

IntegerCrossing cross_integers(const IntegerTriangle& t) {
  const IntegerVector* const at = t.corner;
  const WideIntegerVector bc = cross(at[1], at[2]);
  const auto edge = [&](int i) {
    return dot(i == 0 ? bc : cross(at[(i + 1) % 3], at[(i + 2) % 3]), t.dir[0]);
  };
  Int128 sum = 0;
  if (!crosses_inside(edge, sum))
    return {};
  return {true, dot(bc, at[0]), sum, t.unit / t.dir_unit};
}

ExactCrossing cross_expansions(const ExactRay& ray, const float (&corner)[3][3]) {
  ExactVector at[3];
  for (int i = 0; i < 3; ++i)
    at[i] = difference(corner[i], ray.org);
  const ExactVector bc = cross(at[1], at[2]);
  const auto edge = [&](int i) {
    return dot(i == 0 ? bc : cross(at[(i + 1) % 3], at[(i + 2) % 3]), ray.dir);
  };
  Expansion sum;
  if (!crosses_inside(edge, sum))
    return {};
  return {dot(bc, at[0]), sum};
}

}  // namespace

namespace {

/// Crossings in integers that a thread has computed: of a ray through a vertex each cell and each
/// tie asks again about all triangles that have it. What it answers is what would be computed.
class CrossingMemo {
 public:
  const IntegerCrossing* find(const ExactRay& ray, const float (&corner)[3][3]) const {
    const Entry& e = entry_[place_of(ray, corner)];
    return e.is_set && is_same(e, ray, corner) ? &e.found : nullptr;
  }
  void keep(const ExactRay& ray, const float (&corner)[3][3], const IntegerCrossing& found) {
    Entry& e = entry_[place_of(ray, corner)];
    e.is_set = true;
    std::memcpy(e.org, ray.org, sizeof e.org);
    std::memcpy(e.dir, ray.dir, sizeof e.dir);
    std::memcpy(e.corner, corner, sizeof e.corner);
    e.found = found;
  }

 private:
  static constexpr std::size_t kEntries = 64;
  struct Entry {
    bool is_set = false;
    double org[3], dir[3];
    float corner[3][3];
    IntegerCrossing found;
  };

  static bool is_same(const Entry& e, const ExactRay& ray, const float (&corner)[3][3]) {
    return std::memcmp(e.dir, ray.dir, sizeof e.dir) == 0 &&
           std::memcmp(e.org, ray.org, sizeof e.org) == 0 &&
           std::memcmp(e.corner, corner, sizeof e.corner) == 0;
  }
  static std::size_t place_of(const ExactRay& ray, const float (&corner)[3][3]) {
    std::uint64_t h = 0;
    const auto add = [&h](auto x) {
      std::uint64_t word = 0;
      std::memcpy(&word, &x, sizeof x);
      h = (h ^ word) * 0x9E3779B97F4A7C15u;
    };
    add(ray.dir[0]);
    add(ray.dir[1]);
    for (const auto& c : corner)
      add(c[0]);
    return static_cast<std::size_t>(h >> 58);
  }

  Entry entry_[kEntries];
};

ExactCrossing beyond_start(const ExactRay& ray, const ExactCrossing& found) {
  return found.some() && found.compare(ray.t_min) > 0 ? found : ExactCrossing();
}
ExactCrossing beyond_start(const ExactRay& ray, const IntegerCrossing& t) {
  return t.some ? beyond_start(ray, ExactCrossing(t.numerator, t.denominator, t.unit))
                : ExactCrossing();
}

}  // namespace

ExactCrossing cross_triangle(const ExactRay& ray, const float (&corner)[3][3]) {
  static thread_local CrossingMemo memo;
  if (const IntegerCrossing* const known = memo.find(ray, corner))
    return beyond_start(ray, *known);
  IntegerTriangle integers;
  if (!to_integers(ray, corner, integers))
    return beyond_start(ray, cross_expansions(ray, corner));
  const IntegerCrossing found = cross_integers(integers);
  memo.keep(ray, corner, found);
  return beyond_start(ray, found);
}

namespace {

/// Numbers of 106 bits suffice unless the edge functions of a triangle cancel to this part of their
/// terms: each is off by some 2^-96 of them.
constexpr double kLeastWide = 0x1p-60;

/// The parts of a sum; of opposite signs none.
void share(const double (&edge)[3], double sum, double (&weight)[3]) {
  for (int i = 0; i < 3; ++i)
    weight[i] = std::max(edge[i] / sum, 0.);
}

}  // namespace

void crossing_weights(const ExactRay& ray, const float (&corner)[3][3], double (&weight)[3]) {
  WideVector at[3];
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    at[i] = wide_difference(corner[i], ray.org);
    for (const DoubleDouble& x : {at[i].x, at[i].y, at[i].z})
      size = std::max(size, std::abs(x.high));
  }
  const WideVector dir = wide(ray.dir);
  const double way = std::max({std::abs(dir.x.high), std::abs(dir.y.high), std::abs(dir.z.high)});
  double edge[3];
  DoubleDouble wide_sum;
  for (int i = 0; i < 3; ++i) {
    const DoubleDouble one = dot(cross(at[(i + 1) % 3], at[(i + 2) % 3]), dir);
    edge[i] = one.high;
    wide_sum = wide_sum + one;
  }
  if (std::abs(wide_sum.high) > kLeastWide * (size * size * way)) {
    share(edge, wide_sum.high, weight);
    return;
  }
  ExactVector exact[3];
  Expansion sum;
  for (int i = 0; i < 3; ++i)
    exact[i] = difference(corner[i], ray.org);
  for (int i = 0; i < 3; ++i) {
    const Expansion one = dot(cross(exact[(i + 1) % 3], exact[(i + 2) % 3]), ray.dir);
    edge[i] = one.estimate();
    sum += one;
  }
  share(edge, sum.estimate(), weight);
}

SolidAngleParts solid_angle_parts(const double (&point)[3], const float (&corner)[3][3]) {
  WideVector to[3];
  DoubleDouble length[3];
  for (int k = 0; k < 3; ++k) {
    const auto along = [&](int a) { return DoubleDouble(corner[k][a]) - point[a]; };
    to[k] = {along(0), along(1), along(2)};
    length[k] = square_root(dot(to[k], to[k]));
  }
  const DoubleDouble lengths = length[0] * length[1] * length[2];
  const DoubleDouble real = lengths + dot(to[0], to[1]) * length[2] +
                            dot(to[1], to[2]) * length[0] + dot(to[2], to[0]) * length[1];
  const DoubleDouble volume = dot(cross(to[0], to[1]), to[2]);
  if (magnitude(volume) > lengths * kWideVolumeError)
    return {real.high, volume.high};
  const auto exact = [&](int k) { return difference(corner[k], point); };
  return {real.high, dot(cross(exact(0), exact(1)), exact(2)).estimate()};
}

bool is_within(const double (&point)[3], const float (&center)[3], float radius) {
  double squared = 0;
  for (int a = 0; a < 3; ++a)
    squared += (center[a] - point[a]) * (center[a] - point[a]);
  const double square = static_cast<double>(radius) * radius;
  if (std::abs(squared - square) > 0x1p-48 * (squared + square))
    return squared < square;
  const ExactVector way = difference(center, point);
  const Expansion r(static_cast<double>(radius));
  return (dot(way, way) - r * r).sign() < 0;
}

ExactCrossing cross_plane(const ExactRay& ray, const float (&point)[3], const float (&normal)[3]) {
  const double n[3] = {normal[0], normal[1], normal[2]};
  Expansion along;
  for (int i = 0; i < 3; ++i)
    along.add_product(n[i], ray.dir[i]);
  if (along.sign() == 0)
    return {};
  const ExactCrossing found(dot(difference(point, ray.org), n), along);
  return found.compare(ray.t_min) > 0 ? found : ExactCrossing();
}

namespace {

/// The lesser of two t beyond t_min, NaN left out.
ExactCrossing first_of(const ExactRay& ray, DoubleDouble a, DoubleDouble b) {
  if (b < a || std::isnan(a.high))
    std::swap(a, b);
  if (a > ray.t_min)
    return ExactCrossing(a);
  return b > ray.t_min ? ExactCrossing(b) : ExactCrossing();
}

}  // namespace

ExactCrossing cross_sphere(const ExactRay& ray, const float (&center)[3], float radius) {
  const WideVector to_center = wide_difference(center, ray.org);
  const WideVector dir = wide(ray.dir);
  const DoubleDouble dd = dot(dir, dir);
  const DoubleDouble rr = DoubleDouble(radius) * radius;
  const WideVector moment = cross(to_center, dir);
  const DoubleDouble disc = rr * dd - dot(moment, moment);
  if (!(dd > 0) || !(radius != 0) || disc < 0)
    return {};
  const DoubleDouble root = square_root(disc);
  const DoubleDouble middle = dot(to_center, dir);
  const DoubleDouble q = middle < 0 ? middle - root : middle + root;
  const DoubleDouble one = q / dd;
  const DoubleDouble other = q.high == 0 ? DoubleDouble() : (dot(to_center, to_center) - rr) / q;
  if (radius > 0)
    return first_of(ray, one, other);
  const DoubleDouble leave = one < other ? other : one;
  return leave > ray.t_min ? ExactCrossing(leave) : ExactCrossing();
}

// As cone_crossings() of shapes/cone.hpp, which derives it.
ExactCrossing cross_cone(const ExactRay& ray, const ExactCone& cone) {
  const DoubleDouble nowhere(std::nan(""));
  const WideVector given{cone.axis[0], cone.axis[1], cone.axis[2]};
  const WideVector axis = DoubleDouble(1) / square_root(dot(given, given)) * given;
  const WideVector dir = wide(ray.dir);
  const WideVector to_base = wide_difference(cone.base, ray.org);
  const DoubleDouble inverse = DoubleDouble(1) / dot(dir, dir);
  const DoubleDouble near = dot(to_base, dir) * inverse;
  const WideVector p = near * dir - to_base;
  const WideVector n = cross(dir, axis);
  const WideVector e = inverse * n;
  const WideVector pn = cross(p, axis);
  const DoubleDouble pz = dot(p, axis);
  const DoubleDouble dz = dot(dir, axis);
  const DoubleDouble slope(cone.slope);
  const DoubleDouble r = DoubleDouble(cone.radius) + slope * pz;
  const DoubleDouble rd = slope * dz;
  const DoubleDouble erd = inverse * rd;
  const DoubleDouble a = dot(n, e) - rd * erd;
  const DoubleDouble b = dot(pn, e) - r * erd;
  const DoubleDouble c = inverse * (dot(pn, pn) - r * r);
  const WideVector w = erd * pn - r * e;
  const DoubleDouble moment = dot(p, e);
  const DoubleDouble bb = b * b;
  const DoubleDouble ww = dot(w, w);
  const DoubleDouble disc = bb < ww ? bb - a * c : ww - moment * moment;
  if (disc < 0)
    return {};
  const DoubleDouble root = square_root(disc);
  const DoubleDouble q = b < 0 ? root - b : -(b + root);
  const auto on_side = [&](const DoubleDouble& s) {
    const DoubleDouble h = pz + s * dz;
    const bool leaves = !(a * s + b < 0);
    const bool between = !(h < 0) && !(h > cone.height) && !std::isnan(h.high);
    return between && (cone.side > 0 || leaves) ? near + s : nowhere;
  };
  return first_of(ray, on_side(q / a), on_side(c / q));
}

}  // namespace grelha
