#pragma once
// Generalized winding numbers of points, by clusters of triangles.

#include "kernel/grid/winding_tree.hpp"
#include "kernel/query/solid_angle.hpp"
#include "kernel/query/variants.hpp"

namespace grelha::GRELHA_ISA {

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
