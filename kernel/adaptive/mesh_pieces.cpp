#include "kernel/adaptive/mesh_pieces.hpp"

#include <array>
#include <bit>
#include <numeric>
#include <unordered_map>

#include "kernel/scene/hash.hpp"

namespace grelha {
namespace {

/// Pieces of more triangles share vertices by their index: readers of meshes see to it.
constexpr std::uint32_t kFewTriangles = 64;
/// Triangles of a piece that are looked at.
constexpr std::uint32_t kMostSeen = 4096;

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

std::array<std::uint32_t, 3> corners(const TriangleSpans& t, std::size_t i) {
  return {t.a[i], t.b[i], t.c[i]};
}

struct PlaceHash {
  std::size_t operator()(const Place3& p) const {
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

/// Joins small pieces that touch.
void weld(const TriangleSpans& t, Sets& sets) {
  const std::vector<std::uint32_t> sizes = sizes_of(t, sets);
  std::unordered_map<Place3, std::uint32_t, PlaceHash> first;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (sizes[sets.root(t.a[i])] > kFewTriangles)
      continue;
    for (const std::uint32_t v : corners(t, i))
      sets.join(first.try_emplace(corner_of(t, v), v).first->second, v);
  }
}

/// A piece that grows: from the vertex farthest from its first one to the farthest from that.
struct Piece {
  Rod rod;
  double most = -1;
  std::uint32_t triangles = 0, seen = 0;

  void stretch_from(const Place3& fixed, const Place3& p, Place3& end) {
    if (const double d = dot(p - fixed, p - fixed); d > most) {
      most = d;
      end = p;
    }
  }
  void widen(const Place3& p) {
    const Place3 along = rod.end[1] - rod.end[0], c = cross(along, p - rod.end[0]);
    const double length = dot(along, along);
    if (length > 0)
      rod.radius = std::max(rod.radius, std::sqrt(dot(c, c) / length));
  }
};

/// All pieces, and which one each triangle belongs to.
class MeshPieces {
 public:
  MeshPieces(const TriangleSpans& t, Sets& sets) : t_(t), of_(t.size()) {
    std::unordered_map<std::uint32_t, std::uint32_t> number;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const auto [known, is_new] =
          number.try_emplace(sets.root(t.a[i]), static_cast<std::uint32_t>(pieces_.size()));
      if (is_new) {
        const Place3 first = corner_of(t, t.a[i]);
        pieces_.push_back({{{first, first}, 0, t.material[i]}});
      }
      of_[i] = known->second;
      ++pieces_[of_[i]].triangles;
    }
  }

  std::vector<Rod> rods() {
    std::vector<Place3> first;
    for (const Piece& piece : pieces_)
      first.push_back(piece.rod.end[0]);
    each_vertex([&](Piece& piece, std::size_t k, const Place3& p) {
      piece.stretch_from(first[k], p, piece.rod.end[0]);
    });
    for (Piece& piece : pieces_)
      piece.most = -1;
    each_vertex([](Piece& piece, std::size_t, const Place3& p) {
      piece.stretch_from(piece.rod.end[0], p, piece.rod.end[1]);
    });
    each_vertex([](Piece& piece, std::size_t, const Place3& p) { piece.widen(p); });
    std::vector<Rod> rods;
    for (const Piece& piece : pieces_)
      rods.push_back(piece.rod);
    return rods;
  }

 private:
  template <class Visit>
  void each_vertex(const Visit& visit) {
    for (Piece& piece : pieces_)
      piece.seen = 0;
    for (std::size_t i = 0; i < t_.size(); ++i) {
      Piece& piece = pieces_[of_[i]];
      if (piece.seen++ % (piece.triangles / kMostSeen + 1) == 0)
        for (const std::uint32_t v : corners(t_, i))
          visit(piece, of_[i], corner_of(t_, v));
    }
  }

  const TriangleSpans& t_;
  std::vector<std::uint32_t> of_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<Rod> mesh_pieces(const TriangleSpans& triangles) {
  Sets sets(triangles.vertex_count());
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::uint32_t v : corners(triangles, i))
      sets.join(triangles.a[i], v);
  weld(triangles, sets);
  return MeshPieces(triangles, sets).rods();
}

}  // namespace grelha
