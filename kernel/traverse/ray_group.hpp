#pragma once
// Rays as arrays, a component each, and what those that are traced together have in common.

#include "kernel/grid/view.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/sphere.hpp"
#include "kernel/traverse/candidates.hpp"
#include "kernel/traverse/ray_filter.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr float kInfinity = __builtin_inff();

/// The scene of rays, the rays as the caller gave them, and the frame that they are in.
struct RayFrame {
  const GeometryView* geometry = nullptr;
  GivenRays given;
  const RayFilter* filter = nullptr;    ///< null: rays hit everything
  CandidateSink* candidates = nullptr;  ///< of searches for all hits
  const float* base = nullptr;          ///< x, y, z of where the frame begins; null: 0
  float frame_error = 0;                ///< error of coordinates in the frame
  float error_bound = kInfinity;        ///< see SimdRays

  /// True if ray i hits nothing where it crosses primitive `id`.
  bool leaves_out(int i, std::uint32_t id) const {
    return filter && filter->hit_of(i, id) == kNoPrimitive;
  }
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

inline std::uint32_t id_of(float bits) {
  return static_cast<std::uint32_t>(float_bits(bits));
}
inline float bits_of(std::uint32_t id) {
  return bits_float(static_cast<std::int32_t>(id));
}

/// K rays. Each searches (t_min, best). `id` holds the bits of the nearest primitive so far, which
/// is hit at a t from `low` to `best`; while there is none both are the end of the search.
///
/// Rays from afar are copied into the frame of a grid: `given` holds the rays before that.
template <int K>
struct RayGroup : RayFrame {
  static constexpr std::size_t kAlign = K > 1 ? 64 : alignof(float);
  static constexpr int kRows = K > 1 ? 3 : 4;  ///< of one ray four are stored at once
  alignas(kAlign) float org[3][K];
  alignas(kAlign) float dir[3][K];
  alignas(kAlign) float t_min[K];
  alignas(kAlign) float best[K];
  alignas(kAlign) float low[K];
  alignas(kAlign) float id[K];
  alignas(kAlign) float inv_dd[K];
  alignas(kAlign) float inv_length[K];
  // With triangles or boxes only.
  alignas(kAlign) float axis[K];  ///< of the shear: 0, 1 or 2
  alignas(kAlign) float shear[kRows][K];
  alignas(kAlign) float inverse[kRows][K];  ///< of directions, no component 0
  /// the side of a box that the ray hits first, along each axis; the other is 3 on or back
  alignas(kAlign) std::uint32_t near[kRows][K];
  // Where directions were divided by a length: that, and ends of searches in the caller's lengths.
  alignas(kAlign) float unit[K];
  alignas(kAlign) float given_t_min[K];
  alignas(kAlign) float given_t_max[K];
};

}  // namespace grelha::GRELHA_ISA
