#pragma once
// Adaptive supersampling by recursive subdivision: a square whose corners differ too much is split
// into four, as in POV-Ray's method 2 (Whitted 1980, section 4). Neighbouring squares share their
// corners.

#include <cstdint>

#include "grelha/geometry.hpp"

namespace grelha {

inline constexpr int kMostSubdivisions = 8;
/// Steps of the lattice that all points lie on, a pixel; the same at every depth, so that a point
/// keeps its name.
inline constexpr std::uint32_t kLatticeSteps = 1u << kMostSubdivisions;
/// Widest and highest picture: its lattice is counted exactly by floats.
inline constexpr int kMostSubdividedSide = (1 << 24) / static_cast<int>(kLatticeSteps);

/// A point of a picture, in lattice steps from its upper left corner.
struct LatticePoint {
  std::uint32_t x, y;
  bool operator==(const LatticePoint&) const = default;  ///< the same place
};

/// Returns a 32-bit hash of a point, which seeds the point's random numbers.
inline std::uint32_t lattice_hash(LatticePoint p) {
  // MurmurHash3's finalizer (A. Appleby)
  std::uint64_t x = static_cast<std::uint64_t>(p.y) << 32 | p.x;
  x ^= x >> 33;
  x *= 0xFF51AFD7ED558CCDu;
  x ^= x >> 33;
  x *= 0xC4CEB9FE1A85EC53u;
  return static_cast<std::uint32_t>(x >> 32);
}

/// Adaptive supersampling: `on` or not, and how fine.
struct Subdivision {
  bool on = false;
  /// squares split where a channel of two corners differs by more; display values, clamped to [0,
  /// 1]
  float threshold = .1f;
  /// times a pixel may be split, up to kMostSubdivisions; 0: its corners alone
  int depth = 3;
};

}  // namespace grelha
