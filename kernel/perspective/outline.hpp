#pragma once
// What primitives look like from a point, on one face of a cube around it.

#include "kernel/perspective/viewpoint.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Directions (u, v, 1) with a u + b v + c >= -margin.
struct HalfPlane {
  double a = 0;
  double b = 0;
  double c = 1;
  double margin = 0;
};

/// Where a ray through the point may meet a primitive.
struct Bounds {
  double lo[2], hi[2];  ///< of u and v
  double near, far;     ///< along the face's axis
};

/// The same, more closely.
struct Outline : Bounds {
  HalfPlane side[3];
  /// rays further inside of all sides than they leave open meet it for sure, between near and far
  bool solid = false;
};

/// False: no ray through this face meets the primitive. `distance`: that of distance_of(), at least
/// kNearest pads.
bool see(const Primitives& primitives,
         const Viewpoint& from,
         std::uint32_t id,
         int face,
         double distance,
         Outline& outline);

/// The same, and where see() says false perhaps not, with bounds around those that it sets; `box`:
/// the primitive's. Takes a third of the time.
bool see_about(const Primitives& primitives,
               const Viewpoint& from,
               std::uint32_t id,
               const Box& box,
               int face,
               double distance,
               Bounds& bounds);

}  // namespace grelha
