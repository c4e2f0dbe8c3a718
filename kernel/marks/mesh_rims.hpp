#pragma once
// Where triangles that share corners end, or turn away from a point: what is inside of a mesh is no
// thing of its own.

#include <atomic>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/scene_spans.hpp"

namespace grelha {

/// Corners of triangles, those at one place taken for one.
class MeshRims {
 public:
  MeshRims(const TriangleSpans& triangles, int threads);

  /// Forgets what was seen from another point.
  void look_from(const double (&point)[3]);

  /// Whether a corner of triangle i lies where a mesh of one material ends, or where some of its
  /// triangles face the point and some do not. With very many triangles: always.
  bool has(std::size_t i) const;
  /// Whether a corner of triangle i lies where a mesh ends. With very many triangles: always.
  bool ends_at(std::size_t i) const;
  /// Whether triangle i is no part of a larger surface: all its corners lie where a mesh ends, and
  /// so do those of the triangles that it has an edge in common with. With very many: always.
  bool stands_alone(std::size_t i) const;

 private:
  /// What is told of a corner.
  static constexpr std::uint8_t kFront = 1;
  static constexpr std::uint8_t kBack = 2;
  static constexpr std::uint8_t kOpen = 4;  ///< a mesh ends there

  /// Of triangles of one material, by the first vertices at its places.
  struct Edge {
    std::uint32_t lower, upper, material;
    auto operator<=>(const Edge&) const = default;
  };

  void add_neighbours(std::size_t i,
                      const std::vector<std::uint32_t>& name,
                      std::vector<std::atomic<std::uint32_t>>& open) const;
  void find_borders();
  bool is_open(std::uint32_t vertex) const { return (told_[first_[vertex]] & kOpen) != 0; }
  int open_corners(std::size_t i) const;
  Edge edge(std::size_t i, int k) const;
  void add_side(std::size_t i);
  std::uint8_t side_of(std::size_t i) const;

  const TriangleSpans& triangles_;
  const int threads_;
  double from_[3] = {};
  std::vector<std::uint32_t> first_;  ///< [vertices] one at the same place
  std::vector<Edge> borders_;         ///< of triangles that have corners inside of a mesh, in order
  std::vector<std::atomic<std::uint8_t>> told_;  ///< [vertices] of those that are first
};

}  // namespace grelha
