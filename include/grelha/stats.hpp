#pragma once
// Statistics of builds and renders. Counting never changes a picture. Some counts (visits, tests,
// packets) depend on packet size and instruction set; ray counts do not.

#include <array>
#include <cstdint>
#include <vector>

#include "grelha/phase.hpp"

namespace grelha {

/// Numbers of rays by purpose.
struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, reflection = 0, refraction = 0;
  /// Returns the sum of the four.
  std::uint64_t total() const { return primary + shadow + reflection + refraction; }
  /// Adds the counts of another thread or call.
  void operator+=(const RayCounts& o) {
    primary += o.primary;
    shadow += o.shadow;
    reflection += o.reflection;
    refraction += o.refraction;
  }
};

/// Numbers of intersection tests by kind of primitive.
struct TestCounts {
  std::uint64_t sphere = 0, triangle = 0, cone = 0, plane = 0;  ///< one ray against one primitive
};

/// Counts of packets and of their lanes.
struct PacketCounts {
  std::uint64_t formed = 0;            ///< packets traced together to the end
  std::uint64_t packet_fallbacks = 0;  ///< packets that diverged and continued as single rays
  std::uint64_t lanes_issued = 0;      ///< SIMD lanes in tests of many rays against one primitive
  std::uint64_t lanes_busy = 0;        ///< those lanes that held an active ray
};

/// Tests of single rays, each against up to eight boxes or primitives in one SIMD operation.
struct RowCounts {
  std::uint64_t boxes = 0;       ///< one ray against bounding boxes of blocks of primitives
  std::uint64_t primitives = 0;  ///< one ray against primitives
};

/// Counts of a trace.
struct TraceCounts {
  std::uint64_t visits = 0;  ///< grid cells visited by a packet or a ray
  TestCounts tests;
  RowCounts rows;
  PacketCounts packets;
  /// Adds the counts of another thread or call.
  void operator+=(const TraceCounts& o) {
    visits += o.visits;
    tests.sphere += o.tests.sphere;
    tests.triangle += o.tests.triangle;
    tests.cone += o.tests.cone;
    tests.plane += o.tests.plane;
    rows.boxes += o.rows.boxes;
    rows.primitives += o.rows.primitives;
    packets.formed += o.packets.formed;
    packets.packet_fallbacks += o.packets.packet_fallbacks;
    packets.lanes_issued += o.packets.lanes_issued;
    packets.lanes_busy += o.packets.lanes_busy;
  }
};

/// What ended a picture rendered with RefineOptions: kNone if nothing did, or no sample differed.
enum class Limit { kNone, kError, kSamples, kSeconds };

/// Estimated error of a picture rendered with RefineOptions; display units, 0 to 1.
struct ErrorStats {
  /// estimated RMSE of all pixels and channels against the converged picture
  double rmse = 0;
  double rmse_bound = 0;  ///< upper bound of rmse at 95 % confidence
  bool met = false;       ///< the requested RMSE is reached
  Limit ended = Limit::kNone;
  /// number of error checks: each doubles the samples of blocks drawn at random, and what these
  /// differ from the samples before corrects rmse
  int checks = 0;
  std::uint64_t check_samples = 0;    ///< that checks took, among `samples`
  std::uint64_t samples = 0;          ///< of all pixels; see RefineOptions::seconds
  std::uint32_t least = 0, most = 0;  ///< samples of a single pixel
  int rounds = 0;                     ///< of adding samples, without checks
};

/// Seconds per Phase, summed over all threads.
struct PhaseSeconds : std::array<double, kPhases> {
  PhaseSeconds() : array{} {}
  /// Adds the counts of another thread or call.
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

/// Size of one grid of a World.
struct GridStats {
  std::array<std::uint32_t, 3> cells{};  ///< per axis
  std::uint64_t occupied = 0;            ///< cells that contain at least one reference
  std::uint64_t references = 0;          ///< primitives per cell, summed over all cells
  std::uint64_t bytes = 0;
};

}  // namespace grelha
