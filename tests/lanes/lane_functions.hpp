#pragma once
// Functions over lanes that no other function of the library shows, lane by lane, as each
// instruction set computes them: compiled here from the kernel's headers, with the flags of its
// copies. They are no part of the library.

#include "kernel/query/variants.hpp"

namespace grelha::test {

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
  void (*camera_rays)(const FrameView&, const BandWork&, int count, bool in_pixels);
};

/// Those of a variant's instruction set.
const LaneFunctions& lane_functions(const Variant&);

}  // namespace grelha::test
