#pragma once
// Whether the triangles that pass for one surface leave no gap in a beam.

#include "kernel/features/same_surface.hpp"

namespace grelha::GRELHA_ISA {

/// Triangles of one surface, each once.
class Sheet {
 public:
  explicit Sheet(const GeometryView& g) : g_(g) {}

  void add(std::uint32_t id) {
    for (int i = 0; i < size_; ++i)
      if (id_[i] == id)
        return;
    corners_[size_] = corners_of(g_, id);
    id_[size_++] = id;
  }

  /// Whether each edge inside the beam belongs to two of them.
  bool closed(const BeamFrame& f) const {
    for (int i = 0; i < size_ && size_ > 1; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3f& a = corners_[i].at[k];
        const Vec3f& b = corners_[i].at[(k + 1) % 3];
        if (!shared(i, a, b) && reaches_in(f, a, b))
          return false;
      }
    return true;
  }

 private:
  /// Whether an edge lies in the beam: its other triangle may lie just outside.
  static bool reaches_in(const BeamFrame& f, const Vec3f& a, const Vec3f& b) {
    BeamPoint p = in_beam(f, a);
    BeamPoint q = in_beam(f, b);
    return clip({f.depth, kInfinity, kEdgeInside}, p, q);
  }

  /// Whether another triangle than i has the edge as well.
  bool shared(int i, const Vec3f& a, const Vec3f& b) const {
    for (int j = 0; j < size_; ++j)
      if (j != i && has(corners_[j], a) && has(corners_[j], b))
        return true;
    return false;
  }

  const GeometryView& g_;
  int size_ = 0;
  std::uint32_t id_[kMostMet + kCorners];
  Corners3 corners_[kMostMet + kCorners];
};

/// Whether what the corner rays met, and what passes for one surface with it, leaves no gap.
inline bool closed(const GeometryView& g,
                   const BeamFrame& f,
                   const Met& met,
                   const std::uint32_t (&front)[kCorners]) {
  if (!is_triangle(g, front[0]))
    return true;
  Sheet sheet(g);
  for (const std::uint32_t id : front)
    sheet.add(id);
  for (int i = 0; i < met.size; ++i)
    if (alike(g, front[0], met.id[i]))
      sheet.add(met.id[i]);
  return sheet.closed(f);
}

}  // namespace grelha::GRELHA_ISA
