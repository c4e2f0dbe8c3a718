#include "kernel/picture/target_rays.hpp"

#include <array>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "kernel/base/hash.hpp"

namespace grelha {
namespace {

/// Pieces of more triangles share vertices by their index: readers of meshes see to it.
constexpr std::uint32_t kMinTriangles = 64;
/// Triangles of a piece that are looked at.
constexpr std::uint32_t kMaxVisited = 4096;

/// Disjoint sets (Tarjan), each known by its least element.
class Sets {
 public:
  explicit Sets(std::size_t count) : up_(count) { std::iota(up_.begin(), up_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (up_[i] != i)
      i = up_[i] = up_[up_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    up_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> up_;
};

std::array<std::uint32_t, 3> vertices_of(const TriangleSpans& t, std::size_t i) {
  return {t.a[i], t.b[i], t.c[i]};
}

struct PointHash {
  std::size_t operator()(const Point3& p) const {
    std::uint32_t hash = 0;
    for (const double c : p.at)
      hash = scattered_bits(hash ^ std::bit_cast<std::uint32_t>(static_cast<float>(c) + 0.f));
    return hash;
  }
};

/// Triangles of each piece, by its first vertex; pieces joined by index.
std::vector<std::uint32_t> sizes_of(const TriangleSpans& t, Sets& sets) {
  std::vector<std::uint32_t> sizes(t.vertex_count());
  for (std::size_t i = 0; i < t.size(); ++i)
    ++sizes[sets.root(t.a[i])];
  return sizes;
}

/// Joins small parts that touch.
void merge_vertices(const TriangleSpans& t, Sets& sets) {
  const std::vector<std::uint32_t> sizes = sizes_of(t, sets);
  std::unordered_map<Point3, std::uint32_t, PointHash> first;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (sizes[sets.root(t.a[i])] > kMinTriangles)
      continue;
    for (const std::uint32_t v : vertices_of(t, i))
      sets.join(first.try_emplace(corner_of(t, v), v).first->second, v);
  }
}

/// A piece that grows: from the vertex farthest from its first one to the farthest from that.
struct MeshPart {
  Capsule capsule;
  double most = -1;
  std::uint32_t triangles = 0, seen = 0;

  void stretch_from(const Point3& fixed, const Point3& p, Point3& end) {
    if (const double d = dot(p - fixed, p - fixed); d > most) {
      most = d;
      end = p;
    }
  }
  void grow_radius(const Point3& p) {
    const Point3 along = capsule.end[1] - capsule.end[0], c = cross(along, p - capsule.end[0]);
    const double length = dot(along, along);
    if (length > 0)
      capsule.radius = std::max(capsule.radius, std::sqrt(dot(c, c) / length));
  }
};

/// All pieces, and which one each triangle belongs to.
class MeshParts {
 public:
  MeshParts(const TriangleSpans& t, Sets& sets) : t_(t), of_(t.size()) {
    std::unordered_map<std::uint32_t, std::uint32_t> number;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const auto [known, is_new] =
          number.try_emplace(sets.root(t.a[i]), static_cast<std::uint32_t>(parts_.size()));
      if (is_new) {
        const Point3 first = corner_of(t, t.a[i]);
        parts_.push_back({{{first, first}, 0, t.material[i]}});
      }
      of_[i] = known->second;
      ++parts_[of_[i]].triangles;
    }
  }

  std::vector<Capsule> capsules() {
    std::vector<Point3> first;
    for (const MeshPart& part : parts_)
      first.push_back(part.capsule.end[0]);
    each_vertex([&](MeshPart& part, std::size_t k, const Point3& p) {
      part.stretch_from(first[k], p, part.capsule.end[0]);
    });
    for (MeshPart& part : parts_)
      part.most = -1;
    each_vertex([](MeshPart& part, std::size_t, const Point3& p) {
      part.stretch_from(part.capsule.end[0], p, part.capsule.end[1]);
    });
    each_vertex([](MeshPart& part, std::size_t, const Point3& p) { part.grow_radius(p); });
    std::vector<Capsule> capsules;
    for (const MeshPart& part : parts_)
      capsules.push_back(part.capsule);
    return capsules;
  }

 private:
  template <class Visit>
  void each_vertex(const Visit& visit) {
    for (MeshPart& part : parts_)
      part.seen = 0;
    for (std::size_t i = 0; i < t_.size(); ++i) {
      MeshPart& part = parts_[of_[i]];
      if (part.seen++ % (part.triangles / kMaxVisited + 1) == 0)
        for (const std::uint32_t v : vertices_of(t_, i))
          visit(part, of_[i], corner_of(t_, v));
    }
  }

  const TriangleSpans& t_;
  std::vector<std::uint32_t> of_;
  std::vector<MeshPart> parts_;
};

}  // namespace

std::vector<Capsule> mesh_parts(const TriangleSpans& triangles) {
  Sets sets(triangles.vertex_count());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t v : vertices_of(triangles, i))
      sets.join(triangles.a[i], v);
  merge_vertices(triangles, sets);
  return MeshParts(triangles, sets).capsules();
}

}  // namespace grelha
