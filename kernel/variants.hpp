#pragma once
// The compiled copies of the hot loops, one per instruction set, behind plain function pointers.

#include <cstdint>
#include <span>
#include <string_view>

#include "kernel/shading_view.hpp"
#include "kernel/stats.hpp"
#include "kernel/view.hpp"

namespace grelha {

/// Rays in arrays of `count`. t: in, where the search ends; out, the nearest hit, or the old value when there is none (closest);
/// -infinity when something is in the way (occluded). Directions of any length from 1e-18 to 1e18 (others meet nothing); t counts
/// multiples of it. Rays with a NaN or an infinity meet nothing.
struct RaySpan {
  const float *ox, *oy, *oz, *dx, *dy, *dz, *t_min;
  float* t;
  std::uint32_t* id;  ///< out: the primitive, kNoPrimitive where nothing was met
  int count;
};

enum class Method {
  kPackets,    ///< `packet` rays march together
  kSingle,     ///< one ray at a time, SIMD over primitives, leaping over empty cells
  kReference,  ///< one ray, one primitive at a time, cell by cell (Amanatides & Woo 1987), with or without mailboxes
};

struct TraceSettings {
  Method method = Method::kPackets;
  int packet = 64;      ///< 16 or 64
  bool mailbox = true;
};

/// What one instruction set's file provides.
struct VariantLoops {
  void (*closest)(const SceneView&, const RaySpan&, const TraceSettings&, TraceCounts&);
  void (*occluded)(const SceneView&, const RaySpan&, const TraceSettings&, TraceCounts&);
  void (*render_band)(const SceneView&, const ShadingView&, const FrameView&, int y0, int y1, const BandWork&, TraceCounts&, RayCounts&);
  /// power(x[i], y[i]) for tests.
  void (*power)(const float* x, const float* y, float* out, int count);
  void (*render_points)(const SceneView&, const ShadingView&, const FrameView&, const PointList&, const BandWork&, TraceCounts&, RayCounts&);
};

struct Variant {
  std::string_view name;
  int lanes;
  bool (*runs_here)();
  const VariantLoops& loops;
};

/// Compiled copies, scalar first, then by growing width.
std::span<const Variant* const> variants();
/// The named copy; "best" is the widest that runs here. nullptr: not compiled or unknown.
const Variant* find_variant(std::string_view name);

}  // namespace grelha
