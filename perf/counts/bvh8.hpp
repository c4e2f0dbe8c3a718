#pragma once
// A tree of boxes, eight children a node, to count by: how many nodes and leaves a ray looks into.
// No clock, no SIMD. Its triangles are not tested by the kernel's rules, so that its answers are
// for counting alone.
//
// Built as Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007; made eight
// wide as Wald, Benthin, Boulos, "Getting Rid of Packets", 2008: the largest child is replaced by
// its own two until there are eight.

#include <cstdint>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/rays.hpp"

namespace grelha::perf {

/// Nodes and leaves that a set of rays visited.
struct TreeCounts {
  std::uint64_t nodes = 0;   ///< eight boxes each
  std::uint64_t leaves = 0;  ///< up to four triangles each
  std::uint64_t hits = 0;
};

class Bvh8 {
 public:
  explicit Bvh8(const Triangles& triangles);

  /// Counts what one ray looks into up to its nearest hit, or with `any` to any: nearest boxes
  /// first.
  void count(const Ray& ray, bool any, TreeCounts& counts) const;

 private:
  static constexpr int kWide = 8;
  static constexpr std::uint32_t kLeaf = 4;  ///< triangles

  struct Box {
    float lo[3], hi[3];
    Box();
    void add(const Box& b);
    float area() const;
  };
  /// A node of two children, or a leaf.
  struct Pair {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< triangles of a leaf
    std::uint32_t child[2] = {};
  };
  struct Child {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< triangles of a leaf; count 0: a node
    std::uint32_t node = 0;
  };
  struct Node {
    Child child[kWide];
    int size = 0;
  };
  /// How a range of triangles is best parted.
  struct Split {
    float cost;
    int axis, bin;
    float lo, scale;
  };

  Box box_of(std::uint32_t triangle) const;
  Box box_around(std::uint32_t first, std::uint32_t count) const;
  float middle(std::uint32_t triangle, int axis) const;
  Split best_split(std::uint32_t first, std::uint32_t count, const Box& box) const;
  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  std::uint32_t collapse(std::uint32_t pair);
  bool meets(std::uint32_t triangle, const Ray& ray, float& t) const;

  const Triangles& t_;
  std::vector<Box> boxes_;            ///< [triangles]
  std::vector<std::uint32_t> order_;  ///< triangles, leaf after leaf
  std::vector<Pair> pairs_;
  std::vector<Node> nodes_;
  std::uint32_t root_ = 0;
};

}  // namespace grelha::perf
