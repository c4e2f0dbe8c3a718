#pragma once
// What rays that are traced together have in common.

#include "kernel/grid/view.hpp"
#include "kernel/shapes/exact_hits.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/traverse/ray_filter.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kInfinity = __builtin_inff();

/// The scene of rays, the rays as the caller gave them, and the frame that they are in.
struct RayFrame {
  const GeometryView* geometry = nullptr;
  GivenRays given;
  const RayFilter* filter = nullptr;  ///< null: rays hit everything
  const float* base = nullptr;        ///< x, y, z of where the frame begins; null: 0
  float frame_error = 0;              ///< error of coordinates in the frame
  float error_bound = kInfinity;      ///< see SimdRays
};

/// The same in the frame of a grid; `shift` as in GivenRays.
inline RayFrame grid_frame(const RayFrame& from, const GridView& g, const double* shift) {
  RayFrame to = from;
  to.given.shift = shift;
  to.base = g.lo_f;
  to.frame_error = g.frame_error;
  to.error_bound = g.error_bound + static_cast<float>(2 * kFarError) * g.frame_error;
  return to;
}

/// Takes a hit that floats cannot tell from ray i's hit so far, `held`, or from the end of its
/// search: returns which counts, or kNoPrimitive, and `span` of the first one.
[[gnu::noinline, gnu::cold]] inline std::uint32_t settle_tie(
    const RayFrame& frame, int i, std::uint32_t held, std::uint32_t id, CrossingSpan& span) {
  const ExactRay ray = frame.given.ray(i);
  const double shift = frame.given.shift_of(i);
  if (held != kNoPrimitive)
    return is_closest(*frame.geometry, ray, id, held, shift, span) ? id : held;
  if (!is_before_end(*frame.geometry, ray, id))
    return kNoPrimitive;
  span = crossing_span(*frame.geometry, ray, id, shift);
  return id;
}

}  // namespace grelha::GRELHA_ISA
