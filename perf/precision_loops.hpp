#pragma once
// Groups of rays against groups of triangles by two methods, in float and in double lanes, compiled
// for each instruction set and, for comparison, with fused multiply-add.

#include <cstdint>
#include <string_view>
#include <vector>

namespace grelha::perf {

/// rays, and triangles, of a group; all of the rays meet all of the triangles
inline constexpr int kGroup = 16;

/// [groups * kGroup] of each component. All rays of a group have their largest direction component
/// along the same axis.
struct Pairs {
  std::vector<float> org[3], dir[3], a[3], b[3], c[3];
  std::vector<std::uint8_t> axis;  ///< [groups]
  int groups() const { return static_cast<int>(axis.size()); }
};

/// [groups * kGroup]: t of the nearest hit and which of the group's triangles it was, -1 for none.
struct PairHits {
  std::vector<double> t;
  std::vector<int> triangle;
};

struct PrecisionLoops {
  std::string_view isa;
  bool fused;
  bool (*runs_here)();
  /// [in double][watertight, else Möller and Trumbore's]
  void (*loop[2][2])(const Pairs&, PairHits&);
};

extern const PrecisionLoops k_scalar_precision;
#ifdef GRELHA_X86_VARIANTS
extern const PrecisionLoops k_sse2_precision, k_avx2_precision, k_avx512_precision,
    k_avx2_fused_precision, k_avx512_fused_precision;
#endif

}  // namespace grelha::perf
