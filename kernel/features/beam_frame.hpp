#pragma once
// A beam of four rays: the pyramid they span, and places in it.

#include "kernel/features/tolerances.hpp"
#include "kernel/simd/vec3.hpp"
#include "kernel/walk/packet.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kCorners = 4;

struct Beam {
  Vec3f org[kCorners], dir[kCorners];  ///< around the beam, in order; unit directions
  float growth = 1;                    ///< times as wide is what counts as inside
};

/// Signs of the corners of a beam along x and y.
inline constexpr float kCornerSigns[kCorners][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/// A beam as a pyramid over a parallelogram: its rays seem to come from the apex, and a point apex
/// + w (axis + x right + y up) lies inside when |x| and |y| are at most 1.
struct BeamFrame {
  Vec3f apex, axis, right, up;
  Vec3f to_x, to_y;  ///< x = dot(p, to_x) / dot(p, unit), p from the apex; y likewise
  Vec3f unit;        ///< the axis without what right and up add to it: w = dot(p, unit)
  float depth;       ///< w from which the whole beam is on its way: of its farthest origin
};

inline Vec3f middle(const Vec3f (&p)[kCorners]) {
  return .25f * ((p[0] + p[1]) + (p[2] + p[3]));
}

/// How far the origins of a beam's rays are apart, and how much farther they are a unit along it.
struct BeamSpread {
  float offset = 0;
  float growth = 0;
};

/// Adds a ray; `o`: its origin, `d`: its direction for a unit along the axis, from those of the
/// middle.
[[gnu::always_inline]] inline void spread_by(BeamSpread& s, const Vec3f& o, const Vec3f& d) {
  s.offset += length(o);
  s.growth += dot(o, d) > 0 || dot(o, o) == 0 ? length(d) : 0 - length(d);
}

/// How far behind the origins the apex lies. Rays that run together or keep apart have none there:
/// one far away stands for it.
[[gnu::always_inline]] inline float apex_distance(const BeamSpread& s) {
  if (s.offset == 0)
    return 0;
  const float farthest = kFarthestApex * s.offset;
  return s.growth > 0 ? lesser(s.offset / s.growth, farthest) : farthest;
}

/// Sets where the corner rays pierce w = 1, and how wide the beam is there.
[[gnu::always_inline]] inline void span_parallelogram(const Beam& b, BeamFrame& f) {
  Vec3f c[kCorners];
  const float along = f.depth > 0 ? 0.f : 1.f;
  for (int i = 0; i < kCorners; ++i) {
    // any place on a ray from the apex will do
    const Vec3f at = b.org[i] + along * b.dir[i] - f.apex;
    c[i] = (1 / dot(at, f.unit)) * at;
  }
  f.axis = middle(c);
  const float half = .25f * b.growth;
  f.right = half * ((c[1] - c[0]) + (c[2] - c[3]));
  f.up = half * ((c[3] - c[0]) + (c[2] - c[1]));
}

/// Sets what finds x and y; false of a pyramid that floats do not tell from a sheet. Along the axis
/// x = det(p, up, axis) / det(right, up, axis), over w.
[[gnu::always_inline]] inline bool set_coordinates(BeamFrame& f) {
  const Vec3f n = cross(f.right, f.up);
  const float det = dot(n, f.axis);
  const float widest = greater(dot(f.right, f.right), dot(f.up, f.up));
  if (!(det * det > kThinnest * kThinnest * widest))
    return false;
  f.to_x = (1 / det) * cross(f.up, f.axis);
  f.to_y = (1 / det) * cross(f.axis, f.right);
  return true;
}

/// The w from which the whole beam is on its way. Its corners are nearly the ends of a slanting
/// mirror, whose 1 / w is linear across the beam. Not above 0: it never is.
[[gnu::always_inline]] inline float depth_of(const Beam& b, const BeamFrame& f) {
  float first = kInfinity;
  float last = 0;
  float mean = 0;  // of 1 / w
  for (int i = 0; i < kCorners; ++i) {
    const float w = dot(b.org[i] - f.apex, f.unit);
    first = lesser(w, first);
    last = greater(w, last);
    mean += .25f / w;
  }
  const auto grown = [&](float w) { return 1 / (mean + b.growth * (1 / w - mean)); };
  const float end = grown(last);
  return end > 0 ? greater(end, last) + kDepthMargin * (end - grown(first)) : 0;
}

/// False when the rays spread too far to be a beam.
inline bool frame_of(const Beam& b, BeamFrame& f) {
  const Vec3f org = middle(b.org);
  f.unit = normalize(middle(b.dir));
  if (!(f.unit.x == f.unit.x))
    return false;
  BeamSpread spread;
  for (int i = 0; i < kCorners; ++i) {
    const float along = dot(b.dir[i], f.unit);
    if (!(along > kNarrow))
      return false;
    // where it passes the plane across the axis: on a slanting mirror rays start apart along it too
    const Vec3f away = b.org[i] - org;
    const Vec3f across = away - (dot(away, f.unit) / along) * b.dir[i];
    spread_by(spread, across, (1 / along) * b.dir[i] - f.unit);
  }
  f.depth = apex_distance(spread);
  f.apex = org - f.depth * f.unit;
  span_parallelogram(b, f);
  if (!set_coordinates(f))
    return false;
  if (f.depth == 0)
    return true;
  f.depth = depth_of(b, f);
  return f.depth > 0;
}

/// Place in the beam, see BeamFrame.
struct Place {
  float x, y, w;
};
[[gnu::always_inline]] inline Place place(const BeamFrame& f, const Vec3f& p) {
  const Vec3f d = p - f.apex;
  const float w = dot(d, f.unit);
  return {dot(d, f.to_x) / w, dot(d, f.to_y) / w, w};
}
/// Whether a place lies in the pyramid of a beam.
inline bool is_inside(const BeamFrame& f, const Vec3f& p) {
  const Vec3f d = p - f.apex;
  const float w = dot(d, f.unit);
  return w > 0 && magnitude(dot(d, f.to_x)) <= w && magnitude(dot(d, f.to_y)) <= w;
}
/// How far out: at most 1 inside.
inline float outness(float x, float y) {
  return greater(magnitude(x), magnitude(y));
}

/// Point of a ball nearest to the axis.
inline Vec3f ball_point(const BeamFrame& f, const Vec3f& c, float r) {
  const Vec3f d = c - f.apex;
  const Vec3f off = d - (dot(d, f.axis) / dot(f.axis, f.axis)) * f.axis;
  const float far = length(off);
  return far <= r ? c - off : c - ((kRimShare * r) / far) * off;
}

}  // namespace grelha::GRELHA_ISA
