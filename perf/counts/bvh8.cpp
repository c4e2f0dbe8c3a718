#include "perf/counts/bvh8.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace grelha::perf {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBins = 16;

int bin_of(float x, float lo, float scale) {
  return std::clamp(static_cast<int>((x - lo) * scale), 0, kBins - 1);
}

float component(const Float3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

}  // namespace

Bvh8::Box::Box() : lo{kInfinity, kInfinity, kInfinity}, hi{-kInfinity, -kInfinity, -kInfinity} {}

void Bvh8::Box::add(const Box& b) {
  for (int a = 0; a < 3; ++a) {
    lo[a] = std::min(lo[a], b.lo[a]);
    hi[a] = std::max(hi[a], b.hi[a]);
  }
}

float Bvh8::Box::area() const {
  const float x = hi[0] - lo[0];
  const float y = hi[1] - lo[1];
  const float z = hi[2] - lo[2];
  return x >= 0 ? x * y + y * z + z * x : 0;
}

Bvh8::Bvh8(const Triangles& triangles) : t_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  for (std::uint32_t i = 0; i < order_.size(); ++i)
    boxes_.push_back(box_of(i));
  root_ = collapse(build(0, static_cast<std::uint32_t>(order_.size())));
}

Bvh8::Box Bvh8::box_of(std::uint32_t triangle) const {
  Box b;
  for (const auto* corners : {&t_.a, &t_.b, &t_.c}) {
    const std::uint32_t v = (*corners)[triangle];
    const float at[3] = {t_.x[v], t_.y[v], t_.z[v]};
    for (int a = 0; a < 3; ++a) {
      b.lo[a] = std::min(b.lo[a], at[a]);
      b.hi[a] = std::max(b.hi[a], at[a]);
    }
  }
  return b;
}

float Bvh8::middle(std::uint32_t triangle, int axis) const {
  return .5f * (boxes_[triangle].lo[axis] + boxes_[triangle].hi[axis]);
}

Bvh8::Box Bvh8::box_around(std::uint32_t first, std::uint32_t count) const {
  Box b;
  for (std::uint32_t i = first; i < first + count; ++i)
    b.add(boxes_[order_[i]]);
  return b;
}

Bvh8::Split Bvh8::best_split(std::uint32_t first, std::uint32_t count, const Box& box) const {
  Split best{kInfinity, 0, 0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    float lo = kInfinity;
    float hi = -kInfinity;
    for (std::uint32_t i = first; i < first + count; ++i) {
      lo = std::min(lo, middle(order_[i], axis));
      hi = std::max(hi, middle(order_[i], axis));
    }
    if (!(hi > lo))
      continue;
    const float scale = static_cast<float>(kBins) * .9999f / (hi - lo);
    Box in[kBins];
    std::uint32_t held[kBins] = {};
    for (std::uint32_t i = first; i < first + count; ++i) {
      const int bin = bin_of(middle(order_[i], axis), lo, scale);
      in[bin].add(boxes_[order_[i]]);
      ++held[bin];
    }
    // groups of four are tested at once
    const auto cost = [](const Box& b, std::uint32_t n) {
      return n == 0 ? 0 : b.area() * static_cast<float>((n + kLeaf - 1) / kLeaf);
    };
    float right[kBins] = {};
    Box sum;
    std::uint32_t n = 0;
    for (int b = kBins - 1; b > 0; --b) {
      sum.add(in[b]);
      right[b] = cost(sum, n += held[b]);
    }
    sum = {};
    n = 0;
    for (int b = 1; b < kBins; ++b) {
      sum.add(in[b - 1]);
      const float mask_and = cost(sum, n += held[b - 1]) + right[b];
      if (n > 0 && n < count && mask_and < best.cost)
        best = {mask_and, axis, b, lo, scale};
    }
  }
  best.cost /= std::max(box.area(), std::numeric_limits<float>::min());
  return best;
}

/// Returns the number of the pair that holds triangles [first, first + count) of order_.
std::uint32_t Bvh8::build(std::uint32_t first, std::uint32_t count) {
  const auto number = static_cast<std::uint32_t>(pairs_.size());
  pairs_.push_back({box_around(first, count), first, count, {}});
  if (count <= kLeaf)
    return number;
  const Split split = best_split(first, count, pairs_[number].box);
  const auto begin = order_.begin() + first;
  auto mid = begin + count / 2;
  if (split.cost < kInfinity)
    mid = std::partition(begin, begin + count, [&](std::uint32_t i) {
      return bin_of(middle(i, split.axis), split.lo, split.scale) < split.bin;
    });
  const auto left = static_cast<std::uint32_t>(mid - begin);
  const std::uint32_t a = build(first, left);
  const std::uint32_t b = build(first + left, count - left);
  pairs_[number].count = 0;
  pairs_[number].child[0] = a;
  pairs_[number].child[1] = b;
  return number;
}

/// Returns the number of the node that has a pair's children, and theirs in the place of the
/// largest.
std::uint32_t Bvh8::collapse(std::uint32_t pair) {
  std::vector<std::uint32_t> children{pair};
  while (children.size() < kWide) {
    const auto size = [&](std::uint32_t i) {
      return pairs_[i].count != 0 ? -1 : pairs_[i].box.area();
    };
    const auto largest = std::max_element(
        children.begin(), children.end(), [&](auto a, auto b) { return size(a) < size(b); });
    if (size(*largest) < 0)
      break;
    const Pair& p = pairs_[*largest];
    *largest = p.child[0];
    children.push_back(p.child[1]);
  }
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  for (const std::uint32_t c : children) {
    const Pair& p = pairs_[c];
    node.child[node.size++] = {p.box, p.first, p.count, p.count != 0 ? 0 : collapse(c)};
  }
  nodes_[number] = node;
  return number;
}

/// Möller & Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, in double.
bool Bvh8::meets(std::uint32_t triangle, const Ray& ray, float& t) const {
  const std::uint32_t v[3] = {t_.a[triangle], t_.b[triangle], t_.c[triangle]};
  double e[3], f[3], s[3], d[3];
  for (int a = 0; a < 3; ++a) {
    const std::vector<float>& x = a == 0 ? t_.x : a == 1 ? t_.y : t_.z;
    e[a] = double(x[v[1]]) - x[v[0]];
    f[a] = double(x[v[2]]) - x[v[0]];
    s[a] = double(component(ray.org, a)) - x[v[0]];
    d[a] = component(ray.dir, a);
  }
  const auto cross = [](const double(&p)[3], const double(&q)[3], double(&to)[3]) {
    for (int a = 0; a < 3; ++a)
      to[a] = p[(a + 1) % 3] * q[(a + 2) % 3] - p[(a + 2) % 3] * q[(a + 1) % 3];
  };
  const auto dot = [](const double(&p)[3], const double(&q)[3]) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  };
  double p[3], q[3];
  cross(d, f, p);
  cross(s, e, q);
  const double det = dot(e, p);
  const double u = dot(s, p) / det;
  const double w = dot(d, q) / det;
  const double at = dot(f, q) / det;
  if (!(u >= 0 && w >= 0 && u + w <= 1 && at > ray.t_min && at < t))
    return false;
  t = static_cast<float>(at);
  return true;
}

void Bvh8::count(const Ray& ray, bool any, TreeCounts& counts) const {
  struct Waiting {
    float enter;
    const Child* child;
  };
  Child root;
  root.node = root_;
  std::vector<Waiting> stack{{ray.t_min, &root}};
  float best = ray.t_max;
  bool hit = false;
  while (!stack.empty() && !(any && hit)) {
    const Waiting next = stack.back();
    stack.pop_back();
    if (next.enter > best)
      continue;
    if (next.child->count != 0) {
      ++counts.leaves;
      for (std::uint32_t i = 0; i < next.child->count; ++i)
        hit |= meets(order_[next.child->first + i], ray, best);
      continue;
    }
    ++counts.nodes;
    const Node& node = nodes_[next.child->node];
    const std::size_t from = stack.size();
    for (int c = 0; c < node.size; ++c) {
      float enter = ray.t_min;
      float leave = best;
      for (int a = 0; a < 3; ++a) {
        const float inverse = 1 / component(ray.dir, a);
        const float x = (node.child[c].box.lo[a] - component(ray.org, a)) * inverse;
        const float y = (node.child[c].box.hi[a] - component(ray.org, a)) * inverse;
        enter = std::max(enter, std::min(x, y));
        leave = std::min(leave, std::max(x, y));
      }
      if (enter <= leave)
        stack.push_back({enter, &node.child[c]});
    }
    std::sort(stack.begin() + static_cast<std::ptrdiff_t>(from),
              stack.end(),
              [](const Waiting& a, const Waiting& b) { return a.enter > b.enter; });
  }
  counts.hits += hit;
}

}  // namespace grelha::perf
