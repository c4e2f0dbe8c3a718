#pragma once
// The compiled copies of the hot loops, one per instruction set, behind plain function pointers.

#include <cstdint>
#include <span>
#include <string_view>

#include "grelha/distance.hpp"
#include "grelha/part.hpp"
#include "grelha/query.hpp"
#include "kernel/scene/shading_view.hpp"
#include "grelha/stats.hpp"
#include "kernel/grid/view.hpp"
#include "kernel/world/winding_tree.hpp"
#include "kernel/traverse/candidates.hpp"

namespace grelha {

/// Finds the closest hits of any number of rays.
using ClosestLoop =
    void (*)(const SceneView&, const Rays&, const Hits&, const TraceOptions&, TraceCounts&);
/// Tests whether anything is in the way of the rays: [rays.count] out, 1 or 0.
using OccludedLoop =
    void (*)(const SceneView&, const Rays&, std::uint8_t*, const TraceOptions&, TraceCounts&);

/// Finds the closest points of [count] points.
using ClosestPointsLoop =
    void (*)(const SceneView&, const Float3*, std::size_t count, float radius, ClosestPoint*);

/// Lists what each ray may cross between its ends.
using CollectLoop = void (*)(const SceneView&, const Rays&, CandidateSink&);

/// Winding numbers of [count] points, within `error`.
using WindingLoop = void (*)(
    const WindingTreeView&, const Float3*, std::size_t count, double error, double* numbers);
/// Tests whether winding numbers are beyond 1/2 or -1/2: [count] out, 1 or 0. Numbers within
/// kLeastWindingError of it decide as they were computed.
using SortByWindingLoop = void (*)(const WindingTreeView&,
                                   const Float3*,
                                   std::size_t count,
                                   std::uint8_t* inside);
inline constexpr double kLeastWindingError = 0x1p-18;

/// The functions of one instruction set.
struct VariantLoops {
  ClosestLoop closest;
  OccludedLoop occluded;
  /// One ray by itself, and what it leaves out, or null.
  Hit (*closest_one)(const SceneView&, const Ray&, const Filter*);
  bool (*occluded_one)(const SceneView&, const Ray&, const Filter*);
  ClosestPointsLoop closest_points;
  CollectLoop collect;
  WindingLoop winding_numbers;
  SortByWindingLoop sort_by_winding;
  void (*render_strip)(const SceneView&,
                       const ShadingView&,
                       const FrameView&,
                       const Part&,
                       const StripWork&,
                       TraceCounts&,
                       RayCounts&);
  /// Samples of selected pixels, kParts sums a run; see render_runs.
  void (*render_runs)(const SceneView&,
                      const ShadingView&,
                      const FrameView&,
                      const PixelRun*,
                      int runs,
                      const StripWork&,
                      TraceCounts&,
                      RayCounts&);
  /// All samples of points of the picture, whose names work.pixels holds.
  void (*render_points)(const SceneView&,
                        const ShadingView&,
                        const FrameView&,
                        const PointList&,
                        const StripWork&,
                        TraceCounts&,
                        RayCounts&);
};

struct Variant {
  std::string_view name;
  int lanes;
  bool (*is_supported)();
  const VariantLoops& loops;
};

/// Compiled copies, by growing width.
std::span<const Variant* const> variants();
/// The widest that runs here.
const Variant& best_variant();
/// The named copy; "best" is the widest that runs here. nullptr: not compiled or unknown.
const Variant* find_variant(std::string_view name);
/// The same; throws std::invalid_argument when it is not compiled, unknown or does not run here.
const Variant& choose_variant(std::string_view name);
/// The same for so many rays: the best for few is no wider than these.
const Variant& choose_variant(std::string_view name, std::size_t rays);

}  // namespace grelha
