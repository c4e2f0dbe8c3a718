#pragma once
// Edges at which triangles that share corners end, or turn away from a point: what is inside of a
// mesh is no thing of its own.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/marks/rod.hpp"

namespace grelha {

/// Edges of triangles, corners at one place taken for one. Edge k of a triangle goes from its
/// corner k to the next. Triangles with two corners at one place have none: no ray meets them.
class MeshRims {
 public:
  static constexpr std::size_t kMostViewpoints = 8;

  MeshRims(const TriangleSpans& triangles, int threads);

  /// Forgets what was seen from others. Takes kMostViewpoints at most.
  void look_from(std::span<const SeenFrom> from);

  /// Whether there are few enough triangles for anything to be told of them.
  bool tell() const { return !told_.empty(); }
  /// Bits of the edges of triangle i at which a mesh of one material ends, or where one of its
  /// triangles faces viewpoint v and the other does not.
  unsigned rims(std::size_t i, std::size_t v) const;
  /// Bits of the edges of triangle i at which a mesh ends.
  unsigned ends(std::size_t i) const;
  /// The triangle across edge k of triangle i, at which no mesh ends.
  std::size_t across(std::size_t i, std::size_t k) const { return across_[3 * i + k]; }
  /// Whether triangle i is no part of a larger surface: all its corners lie where a mesh ends, and
  /// so do those of the triangles that it has an edge in common with.
  bool stands_alone(std::size_t i) const;

 private:
  static constexpr unsigned kEnds = 7;
  /// What is told of a triangle, besides the bits of the edges at which its mesh ends.
  static constexpr std::uint8_t kOpenCorners = 8;  ///< at all of its corners a mesh ends
  static constexpr std::uint8_t kFlat = 16;        ///< two corners are at one place
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  class Edges;

  void tell_of_corners(const Edges& edges);
  std::uint8_t sides_of(std::size_t i, std::span<const SeenFrom> from) const;

  const TriangleSpans& triangles_;
  const int threads_;
  std::vector<std::uint32_t> across_;  ///< [triangles][3] the triangle behind an edge, or kNone
  std::vector<std::uint8_t> told_;     ///< [triangles]
  std::vector<std::uint8_t> sides_;    ///< [triangles] bits of the viewpoints that see its back
};

}  // namespace grelha
