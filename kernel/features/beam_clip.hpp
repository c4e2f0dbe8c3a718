#pragma once
// What of a stretch or of a triangle lies within a beam. It is cut while it is in three dimensions:
// what begins behind the apex, or goes far beyond, is cut off like all else.

#include "kernel/features/beam_frame.hpp"

namespace grelha::GRELHA_ISA {

/// A point from the apex on: its place is (x / w, y / w), see BeamFrame.
struct BeamPoint {
  float x, y, w;
};
inline BeamPoint in_beam(const BeamFrame& f, const Vec3f& p) {
  const Vec3f d = p - f.apex;
  return {dot(d, f.to_x), dot(d, f.to_y), dot(d, f.unit)};
}
inline BeamPoint between(const BeamPoint& a, const BeamPoint& b, float t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)};
}
inline Vec3f point_of(const BeamFrame& f, const BeamPoint& p) {
  return f.apex + ((p.w * f.axis + p.x * f.right) + p.y * f.up);
}

/// A piece of a beam: from w = near to far, and as wide as the beam times `width`.
struct BeamPiece {
  static constexpr int kSides = 6;
  float near, far;
  float width = 1;

  /// From 0 on inside of a side.
  float operator()(int side, const BeamPoint& p) const {
    switch (side) {
      case 0:
        return p.w - near;
      case 1:
        return far - p.w;
      case 2:
        return width * p.w - p.x;
      case 3:
        return width * p.w + p.x;
      case 4:
        return width * p.w - p.y;
      default:
        return width * p.w + p.y;
    }
  }
};

/// Keeps what lies in a piece of a beam; false: nothing does.
inline bool clip(const BeamPiece& piece, BeamPoint& a, BeamPoint& b) {
  for (int side = 0; side < BeamPiece::kSides; ++side) {
    const float at_a = piece(side, a);
    const float at_b = piece(side, b);
    if (!(at_a >= 0) && !(at_b >= 0))
      return false;
    if (at_a >= 0 && at_b >= 0)
      continue;
    const BeamPoint cut = between(a, b, at_a / (at_a - at_b));
    (at_a >= 0 ? b : a) = cut;
  }
  return true;
}

/// Corners of a convex polygon in a beam.
class BeamPolygon {
 public:
  BeamPolygon(const BeamFrame& f, const Vec3f (&corner)[3]) {
    for (const Vec3f& c : corner)
      at_[size_++] = in_beam(f, c);
  }

  /// Keeps what lies in a piece of the beam; false: nothing does.
  bool keep(const BeamPiece& piece) {
    unsigned crossed = 0;
    for (int side = 0; side < BeamPiece::kSides; ++side) {
      int within = 0;
      for (int i = 0; i < size_; ++i)
        within += piece(side, at_[i]) >= 0;
      if (within == 0)
        return false;
      crossed |= (within < size_ ? 1u : 0u) << side;
    }
    if (crossed != 0 && passes())
      return false;
    for (int side = 0; crossed != 0 && size_ > 0; ++side, crossed >>= 1)
      if (crossed & 1)
        cut(piece, side);
    return size_ > 0;
  }

  BeamPoint middle() const {
    BeamPoint sum{0, 0, 0};
    for (int i = 0; i < size_; ++i)
      sum = {sum.x + at_[i].x, sum.y + at_[i].y, sum.w + at_[i].w};
    const float part = 1 / static_cast<float>(size_);
    return {part * sum.x, part * sum.y, part * sum.w};
  }

  int size() const { return size_; }
  const BeamPoint& operator[](int i) const { return at_[i]; }

 private:
  static constexpr int kMost = 3 + BeamPiece::kSides;

  /// Whether the triangle surely passes by the beam: a plane through the apex and one of its edges
  /// has it on one side and the beam, one wide, on the other. Most that cuts leave nothing of do.
  bool passes() const {
    for (int i = 0; i < 3; ++i) {
      const Vec3f a = as_vector(at_[i]);
      const Vec3f n = cross(a, as_vector(at_[(i + 1) % 3]) - a);
      const float widest = magnitude(n.x) + magnitude(n.y);
      if (dot(n, as_vector(at_[(i + 2) % 3])) > 0 ? n.z < -widest : n.z > widest)
        return true;
    }
    return false;
  }
  static Vec3f as_vector(const BeamPoint& p) { return {p.x, p.y, p.w}; }

  void cut(const BeamPiece& piece, int side) {
    BeamPoint kept[kMost + 1];
    int n = 0;
    for (int i = 0; i < size_; ++i) {
      const BeamPoint& a = at_[i];
      const BeamPoint& b = at_[(i + 1) % size_];
      const float at_a = piece(side, a);
      const float at_b = piece(side, b);
      if (at_a >= 0)
        kept[n++] = a;
      if ((at_a >= 0) != (at_b >= 0))
        kept[n++] = between(a, b, at_a / (at_a - at_b));
    }
    size_ = n < kMost ? n : kMost;
    for (int i = 0; i < size_; ++i)
      at_[i] = kept[i];
  }

  int size_ = 0;
  BeamPoint at_[kMost];
};

/// Places of a beam, -1 to 1 each way.
struct BeamBox {
  float lo[2] = {1, 1};
  float hi[2] = {-1, -1};

  void add(float x, float y) {
    const float at[2] = {x, y};
    for (int j = 0; j < 2; ++j) {
      const float in = at[j] < -1 ? -1.f : at[j] > 1 ? 1.f : at[j];
      lo[j] = lesser(lo[j], in);
      hi[j] = greater(hi[j], in);
    }
  }
  void add(const BeamBox& other) {
    add(other.lo[0], other.lo[1]);
    add(other.hi[0], other.hi[1]);
  }
  /// Of the beam.
  float share() const { return .25f * (hi[0] - lo[0]) * (hi[1] - lo[1]); }
  /// Whether all of it lies beside the pixel, where its beam is wider.
  bool is_beside() const {
    constexpr float kSide = 1 / kPixelGrowth;
    return lo[0] > kSide || lo[1] > kSide || hi[0] < -kSide || hi[1] < -kSide;
  }
  /// What a ball covers at most.
  void add_ball(const BeamFrame& f, const BeamPoint& c, float radius) {
    const float x = radius * length(f.to_x);
    const float y = radius * length(f.to_y);
    for (const float w : {c.w - radius, c.w + radius}) {
      if (!(w > 0)) {
        add(-1, -1);
        add(1, 1);
        continue;
      }
      add((c.x - x) / w, (c.y - y) / w);
      add((c.x + x) / w, (c.y + y) / w);
    }
  }
  static BeamBox all() {
    BeamBox box;
    box.add(-1, -1);
    box.add(1, 1);
    return box;
  }
};

}  // namespace grelha::GRELHA_ISA
