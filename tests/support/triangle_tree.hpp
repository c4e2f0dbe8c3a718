#pragma once
// A tree of boxes over triangles, for judges that are independent of the kernel's grids.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "grelha/geometry.hpp"

namespace grelha::test {

/// The longest side of each box is halved at the middle triangle.
class TriangleTree {
 public:
  struct Bounds {
    float lo[3], hi[3];
  };

  explicit TriangleTree(const Triangles& all) : all_(all), order_(all.a.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty())
      split(0, order_.size());
  }

  /// Calls found(i) for the triangles of all boxes but those that skip(box) leaves out. Of two
  /// boxes the one with the lower rank(box) comes first.
  template <class Skip, class Rank, class Found>
  void visit(const Skip& skip, const Rank& rank, const Found& found) const {
    std::vector<std::size_t> open;
    if (!nodes_.empty())
      open.push_back(0);
    while (!open.empty()) {
      const Node& n = nodes_[open.back()];
      open.pop_back();
      if (skip(n.box))
        continue;
      if (n.left == 0)
        std::for_each(&order_[n.begin], &order_[n.end - 1] + 1, found);
      else if (rank(nodes_[n.left].box) < rank(nodes_[n.right].box))
        open.insert(open.end(), {n.right, n.left});
      else
        open.insert(open.end(), {n.left, n.right});
    }
  }

 private:
  struct Node {
    Bounds box;
    std::size_t begin, end;   ///< in order_
    std::size_t left, right;  ///< nodes, or 0
  };
  static constexpr std::size_t kLeaf = 4;

  float middle(std::uint32_t i, int a) const {
    const auto& x = a == 0 ? all_.x : a == 1 ? all_.y : all_.z;
    return x[all_.a[i]] / 3 + x[all_.b[i]] / 3 + x[all_.c[i]] / 3;
  }

  Bounds bounds(std::size_t begin, std::size_t end) const {
    Bounds box{{1e38f, 1e38f, 1e38f}, {-1e38f, -1e38f, -1e38f}};
    for (std::size_t k = begin; k < end; ++k)
      for (const std::uint32_t v : {all_.a[order_[k]], all_.b[order_[k]], all_.c[order_[k]]}) {
        const float p[3] = {all_.x[v], all_.y[v], all_.z[v]};
        for (int a = 0; a < 3; ++a) {
          box.lo[a] = std::min(box.lo[a], p[a]);
          box.hi[a] = std::max(box.hi[a], p[a]);
        }
      }
    return box;
  }

  std::size_t split(std::size_t begin, std::size_t end) {
    const std::size_t at = nodes_.size();
    const Bounds box = bounds(begin, end);
    nodes_.push_back({box, begin, end, 0, 0});
    if (end - begin <= kLeaf)
      return at;
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (box.hi[a] - box.lo[a] > box.hi[axis] - box.lo[axis])
        axis = a;
    const std::size_t half = (begin + end) / 2;
    const auto place = [&](std::size_t k) {
      return order_.begin() + static_cast<std::ptrdiff_t>(k);
    };
    std::nth_element(place(begin), place(half), place(end), [&](auto i, auto j) {
      return middle(i, axis) < middle(j, axis);
    });
    const std::size_t left = split(begin, half);
    const std::size_t right = split(half, end);
    nodes_[at].left = left;
    nodes_[at].right = right;
    return at;
  }

  const Triangles& all_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace grelha::test
