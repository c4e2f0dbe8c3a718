#pragma once
// Functions over lanes that no other function of the library shows, lane by lane, as each
// instruction set computes them: compiled here from the kernel's headers, with the flags of its
// copies. They are no part of the library.

#include "kernel/query/variants.hpp"

namespace grelha::test {

/// How far rays exceed the bounds that a frustum guarantees; at most 0 if the bounds hold.
struct FrustumCheck {
  bool together = false;
  int rays = 0;                 ///< of the packet, that hit the grid
  float steepest = 0;           ///< slope
  double sides = -1;            ///< of a slice's cells, in cells
  double planes = -1;           ///< of the planes that cull, in cells, as the culls compute them
  double balls = -1;            ///< of the same by balls beside a ray that its test may hit
  double group_planes = -1;     ///< of the same planes of the ray's own group
  double near = -1;             ///< of the near plane, before which there is no hit, in slices
  double group_near = -1;       ///< of the near plane of the ray's own group
  double gradient_length = -1;  ///< by which a plane's gradient is longer than is said, of itself
};

struct LaneFunctions {
  /// power(x[i], y[i]).
  void (*power)(const float* x, const float* y, float* out, int count);
  /// sample_pairs() of pixel[i], index[i], key[i].
  void (*samples)(const SamplePlan&,
                  const std::uint32_t* pixel,
                  const std::uint32_t* index,
                  int dimension,
                  const std::uint32_t* key,
                  const Strata&,
                  float* u,
                  float* v,
                  int count);
  /// Camera rays of the work's batch.
  void (*camera_rays)(const FrameView&, const StripWork&, int count, bool in_pixels);
  /// Bounds rays in a grid, and follows each in long double.
  /// Of the rays of one packet.
  FrustumCheck (*check_frustum)(const GridView&, const Rays&);
  int most_rays;  ///< of a packet
};

/// Those of a variant's instruction set.
const LaneFunctions& lane_functions(const Variant&);

}  // namespace grelha::test
