#pragma once
// What a build and a render did, in numbers. Counting never changes a picture; some counts (visits,
// tests, packets) depend on packet size and instruction set, those of rays do not.

#include <array>
#include <cstdint>
#include <vector>

#include "grelha/phase.hpp"

namespace grelha {

/// Rays by what they are for.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, reflection = 0, refraction = 0;
  /// Their sum.
  std::uint64_t total() const { return primary + shadow + reflection + refraction; }
  /// Adds what another thread or call did.
  void operator+=(const RayCounts& o) {
    primary += o.primary;
    shadow += o.shadow;
    reflection += o.reflection;
    refraction += o.refraction;
  }
};

/// Tests by kind of primitive.
struct TestCounts {
  std::uint64_t sphere = 0, triangle = 0, cone = 0, plane = 0;  ///< one ray against one primitive
};

/// Counts of packets and of their lanes.
struct PacketCounts {
  std::uint64_t formed = 0;        ///< packets that marched together to the end
  std::uint64_t fell_back = 0;     ///< packets that spread and went on as single rays
  std::uint64_t lanes_issued = 0;  ///< SIMD lanes of the tests of many rays against one primitive
  std::uint64_t lanes_busy = 0;    ///< those of them that carried a ray still searching
};

/// Counts of what rays that go by themselves are held against, up to eight side by side.
struct RowCounts {
  std::uint64_t boxes = 0;       ///< one ray against boxes of blocks of primitives
  std::uint64_t primitives = 0;  ///< one ray against primitives
};

/// Counts of a trace.
struct TraceCounts {
  std::uint64_t visits = 0;  ///< grid cells looked into, by a packet or by a ray
  TestCounts tests;
  RowCounts rows;
  PacketCounts packets;
  /// Adds what another thread or call did.
  void operator+=(const TraceCounts& o) {
    visits += o.visits;
    tests.sphere += o.tests.sphere;
    tests.triangle += o.tests.triangle;
    tests.cone += o.tests.cone;
    tests.plane += o.tests.plane;
    rows.boxes += o.rows.boxes;
    rows.primitives += o.rows.primitives;
    packets.formed += o.packets.formed;
    packets.fell_back += o.packets.fell_back;
    packets.lanes_issued += o.packets.lanes_issued;
    packets.lanes_busy += o.packets.lanes_busy;
  }
};

/// Estimates of the error of a picture whose samples were spent by error; display units,
/// 0 to 1.
struct ErrorStats {
  /// of all pixels and channels against the converged picture, estimated
  double rmse = 0;
  double rmse_bound = 0;  ///< not exceeded at 95 % confidence
  /// rmse of about 5 % of the pixels by a second, independent set of samples; 0: there was none
  double audited = 0;
  int audits = 0;                   ///< such sets, of other pixels each
  std::uint64_t audit_samples = 0;  ///< that they took, which are no part of the picture
  std::uint64_t samples = 0;  ///< of all pixels. RefineOptions::samples repeats a run by time.
  /// there were when the RMSE asked for was met: the others went to pixels with wide intervals. 0:
  /// it was not met, or not asked for.
  std::uint64_t met_at = 0;
  std::uint32_t least = 0, most = 0;  ///< of one pixel
  int rounds = 0;                     ///< of doubling
};

/// Seconds of all threads together, by Phase.
struct PhaseSeconds : std::array<double, kPhases> {
  PhaseSeconds() : array{} {}
  /// Adds what another thread or call did.
  void operator+=(const PhaseSeconds& o) {
    for (std::size_t i = 0; i < size(); ++i)
      (*this)[i] += o[i];
  }
};

/// Counts and times of a render.
struct RenderStats {
  RayCounts rays;
  TraceCounts trace;
  PhaseSeconds phases;  ///< only with RenderOptions::phases
  ErrorStats error;     ///< only with RefineOptions
  int threads = 0;
  const char* isa = "";
};

/// One grid of a World.
struct GridStats {
  std::array<std::uint32_t, 3> cells{};  ///< per axis
  std::uint64_t occupied = 0;            ///< cells that hold at least one reference
  std::uint64_t references = 0;          ///< primitives over cells
  std::uint64_t bytes = 0;
};

}  // namespace grelha
