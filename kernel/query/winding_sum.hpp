#pragma once
// Generalized winding numbers of points, by clusters of triangles and the solid angles of those
// near: + - * / and square roots alone.

#include <initializer_list>

#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/triangle.hpp"
#include "kernel/world/winding_tree.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::GRELHA_ISA {

/// atan(y / x) of a point (x, y) in the right half plane or the left one, from -pi to pi; 0 where
/// both are 0. Within 2^-50.
///
/// The ratio of the lesser to the greater is turned back by 0, pi / 8 or pi / 4, which leaves at
/// most tan(pi / 16) < .199: the series ends with an error below .199^21 / 21 < 2^-53.
template <class Real>
[[gnu::always_inline]] inline Real angle_of(const Real& x, const Real& y) {
  constexpr double kPi = 0x1.921fb54442d18p+1;
  constexpr double kTan1 = 0x1.975f5e0553158p-3;  // of pi / 16
  constexpr double kTan2 = 0x1.a827999fcef32p-2;  // of pi / 8
  constexpr double kTan3 = 0x1.561b82ab7f990p-1;  // of 3 pi / 16
  const Real o(0), ax = magnitude(x), ay = magnitude(y);
  const Real less = min(ax, ay), more = max(ax, ay);
  const auto above_first = less > Real(kTan1) * more;
  const auto above_second = less > Real(kTan3) * more;
  const Real tan = select(above_second, Real(1), select(above_first, Real(kTan2), o));
  const Real turned = select(above_second, Real(kPi / 4), select(above_first, Real(kPi / 8), o));
  const Real rest = (less - tan * more) / (more + tan * less);
  const Real square = rest * rest;
  Real series(1. / 19);
  for (const double odd : {17., 15., 13., 11., 9., 7., 5., 3., 1.})
    series = Real(1 / odd) - square * series;
  Real angle = turned + rest * series;
  angle = select(ay > ax, Real(kPi / 2) - angle, angle);
  angle = select(x < o, Real(kPi) - angle, angle);
  return select(more > o, select(y < o, o - angle, angle), o);
}

/// Numbers below kLeastParts * product of the three distances, whose parts are off by 20 u, are
/// computed anew in 106 bits. They are so small near an edge alone.
inline constexpr double kLeastParts = 0x1p-8;
/// The same of a volume in double whose sign is known.
inline constexpr double kVolumeError = 0x1p-47;

/// Half the solid angles of the triangles of a block, positive where their corners are clockwise as
/// seen from the point; 0 where it lies in one. docs/proofs.md derives the error: 2^-40 where no
/// edge is nearer than 2^-24 of its length.
///
/// Source  Van Oosterom, Strackee, "The Solid Angle of a Plane Triangle", 1983.
inline void half_angles(const double (&p)[3], const TriangleBlock& block, double (&angle)[kBlock]) {
  for (int i = 0; i < kBlock; i += kWidth<VDouble>) {
    const auto way = [&](const float(&v)[3][kBlock]) {
      return Vec3<VDouble>{take<VDouble>(v[0] + i) - VDouble(p[0]),
                           take<VDouble>(v[1] + i) - VDouble(p[1]),
                           take<VDouble>(v[2] + i) - VDouble(p[2])};
    };
    const Vec3<VDouble> a = way(block.a), b = way(block.b), c = way(block.c);
    const VDouble la = length(a), lb = length(b), lc = length(c);
    const VDouble lengths = la * lb * lc;
    VDouble volume = dot(cross(a, b), c);
    VDouble real = lengths + (dot(a, b) * lc + (dot(b, c) * la + dot(c, a) * lb));
    const auto no_volume = magnitude(volume) <= VDouble(kVolumeError) * lengths;
    const auto small = max_abs(real, volume) <= VDouble(kLeastParts) * lengths;
    const unsigned unsure = bits(mask_or(small, mask_and(real < VDouble(0), no_volume)));
    if (unsure != 0) [[unlikely]] {
      double reals[kWidth<VDouble>], volumes[kWidth<VDouble>];
      store(reals, real);
      store(volumes, volume);
      each_bit(unsure, [&](int k) {
        const SolidAngleParts parts = solid_angle_parts(p, triangle_of(block, i + k).corner);
        reals[k] = parts.real;
        volumes[k] = parts.volume;
      });
      load(reals, real);
      load(volumes, volume);
    }
    const VDouble half = angle_of(real, volume);
    store(angle + i, select(volume == VDouble(0), VDouble(0), half));
  }
}

/// Adds up the winding number of a point, down the clusters. What is added is a function of point,
/// clusters and error alone, and so is the order: the same bits by every instruction set.
///
/// Source  Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized
///         Winding Numbers", 2013.
class WindingSum {
 public:
  /// A cluster that adds to the error, in proportion to its area, no more than `error` would be of
  /// all, is taken as one.
  WindingSum(const WindingTreeView& tree, const double (&p)[3], double error)
      : tree_(tree), p_{p[0], p[1], p[2]}, allowed_(error * kFullAngle / tree.area) {
    if (!(tree.area > 0))
      return;
    push(tree.levels - 1, 0);
    while (size_ > 0) {
      const Entry next = stack_[--size_];
      if (next.level >= 0)
        push(next.level, next.index);
      else
        add_block(next.index);
    }
  }
  double number() const { return sum_ / kFullAngle; }
  /// number() is within it, and what doubles round of triangles; mostly much less than `error`.
  double error() const { return error_ / kFullAngle; }

 private:
  static constexpr double kFullAngle = 0x1.921fb54442d18p+3;  ///< 4 pi
  /// More than rounding makes of a cluster's solid angle, over what its area is at its distance.
  static constexpr double kRounding = 0x1p-40;

  struct Entry {
    int level;  ///< of the row that the cluster stands for; -1: a block
    std::uint32_t index;
  };

  /// Takes the clusters of a row that are far enough away, and leaves the others to be looked into.
  void push(int level, std::uint32_t row) {
    double angle[kBlock], error[kBlock];
    const std::uint32_t begin = row * kBlock;
    const unsigned taken = take_clusters(tree_.rows[tree_.first[level] + row], angle, error);
    const std::uint32_t left = tree_.clusters[level] - begin;
    const unsigned there = left < kBlock ? (1u << left) - 1 : (1u << kBlock) - 1;
    each_bit(taken & there, [&](int k) {
      sum_ += angle[k];
      error_ += error[k];
    });
    for (unsigned open = there & ~taken; open != 0;) {  // the first is the next
      const int k = 31 - __builtin_clz(open);
      open &= ~(1u << k);
      stack_[size_++] = {level - 1, begin + static_cast<std::uint32_t>(k)};
    }
  }

  /// Bits of the clusters of which the terms left out are small enough; the solid angle of each,
  /// and how far it may be off.
  ///
  /// With q the radius over the distance R, and S the spread, these terms are at most fourth / R^5
  /// and q^2 (5 + 6 q + 7 q^2 ...) = q^2 (5 - 4 q) / (1 - q)^2 times S / R^4.
  unsigned take_clusters(const WindingRow& row,
                         double (&angle)[kBlock],
                         double (&error)[kBlock]) const {
    unsigned taken = 0;
    for (int i = 0; i < kBlock; i += kWidth<VDouble>) {
      const auto at = [i](const double(&numbers)[kBlock]) { return load<VDouble>(numbers + i); };
      const Vec3<VDouble> r{at(row.center[0]) - VDouble(p_[0]),
                            at(row.center[1]) - VDouble(p_[1]),
                            at(row.center[2]) - VDouble(p_[2])};
      const VDouble inverse_square = VDouble(1) / dot(r, r);
      const VDouble inverse = square_root(inverse_square);
      const VDouble q = at(row.radius) * inverse;
      const VDouble rest = VDouble(1) - q;
      const VDouble area = at(row.area);
      const VDouble terms = q * q * (VDouble(5) - VDouble(4) * q) / (rest * rest);
      const VDouble off = ((at(row.spread) * terms + at(row.fourth) * inverse) * inverse_square +
                           VDouble(kRounding) * area) *
                          inverse_square;
      taken |= bits(mask_and(q < VDouble(.75), off <= VDouble(allowed_) * area)) << i;
      store(error + i, off);
      const Vec3<VDouble> s = r * r;
      const VDouble second =
          (at(row.second[0]) * s.x + (at(row.second[1]) * s.y + at(row.second[2]) * s.z)) +
          (at(row.second[3]) * r.x * r.y +
           (at(row.second[4]) * r.x * r.z + at(row.second[5]) * r.y * r.z));
      const VDouble third =
          r.x * (at(row.third[0]) * s.x + (at(row.third[5]) * s.y + at(row.third[7]) * s.z)) +
          (r.y * (at(row.third[3]) * s.x + (at(row.third[1]) * s.y + at(row.third[8]) * s.z)) +
           (r.z * (at(row.third[4]) * s.x + (at(row.third[6]) * s.y + at(row.third[2]) * s.z)) +
            at(row.third[9]) * r.x * r.y * r.z));
      const Vec3<VDouble> n{at(row.normal[0]), at(row.normal[1]), at(row.normal[2])};
      store(angle + i,
            (dot(n, r) + (second + third * inverse_square) * inverse_square) *
                (inverse_square * inverse));
    }
    return taken;
  }

  void add_block(std::uint32_t block) {
    double half[kBlock];
    half_angles(p_, tree_.blocks[block], half);
    const std::uint32_t left = tree_.triangles - block * kBlock;
    for (std::uint32_t i = 0; i < kBlock && i < left; ++i)
      sum_ += 2 * half[i];
  }

  const WindingTreeView& tree_;
  const double p_[3];
  const double allowed_;
  double sum_ = 0, error_ = 0;
  Entry stack_[(kBlock - 1) * WindingTreeView::kMostLevels + kBlock];
  int size_ = 0;
};

/// The winding numbers of [count] points; NaN for points with a NaN or an infinity.
inline void winding_numbers(const WindingTreeView& tree,
                            const Float3* points,
                            std::size_t count,
                            double error,
                            double* numbers) {
  for (std::size_t i = 0; i < count; ++i) {
    const double p[3] = {points[i].x, points[i].y, points[i].z};
    const double sum = p[0] + p[1] + p[2];
    numbers[i] = sum - sum == 0 ? WindingSum(tree, p, error).number() : __builtin_nan("");
  }
}

/// True if the size of a point's winding number is above 1/2. A coarse one decides for most.
inline bool is_wound_around(const WindingTreeView& tree, const double (&p)[3]) {
  double beyond = 0;
  for (const double allowed : {1., 0x1p-3, 0x1p-7, 0x1p-12, kLeastWindingError}) {
    const WindingSum sum(tree, p, allowed);
    beyond = magnitude(sum.number()) - .5;
    if (!(magnitude(beyond) <= sum.error() + kLeastWindingError))
      break;
  }
  return beyond > 0;
}

/// The same of [count] points: 1 or 0; points with a NaN or an infinity are outside.
inline void sort_by_winding(const WindingTreeView& tree,
                            const Float3* points,
                            std::size_t count,
                            std::uint8_t* inside) {
  for (std::size_t i = 0; i < count; ++i) {
    const double p[3] = {points[i].x, points[i].y, points[i].z};
    const double sum = p[0] + p[1] + p[2];
    inside[i] = sum - sum == 0 && is_wound_around(tree, p);
  }
}

}  // namespace grelha::GRELHA_ISA
