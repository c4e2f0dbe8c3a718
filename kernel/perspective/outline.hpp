#pragma once
// What primitives look like from a point, on one face of a cube around it.

#include "kernel/perspective/view.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Coordinates on a face: along its next axis, the one after, and its own, outwards.
struct FacePoint {
  double p, q, r;
};

/// Directions (u, v, 1) with a u + b v + c >= -margin.
struct HalfPlane {
  double a = 0;
  double b = 0;
  double c = 1;
  double margin = 0;
};

/// Where a ray through the point may meet a primitive.
struct Outline {
  double lo[2], hi[2];  ///< of u and v
  HalfPlane side[3];
  double near, far;  ///< along the face's axis
  /// rays further inside of all sides than they leave open meet it for sure, between near and far
  bool solid = false;
};

/// A point, and how far what rays meet may lie from the primitive that it belongs to.
struct Viewpoint {
  double at[3];
  double pad;
  double aside;  ///< beside a triangle: inside or outside is decided in double there
};

/// Lower bound of the distance of a primitive within `box`, as the largest of three coordinates.
double distance_of(const Primitives& primitives,
                   const Viewpoint& from,
                   std::uint32_t id,
                   const Box& box);

/// False: no ray through this face meets the primitive. `distance`: that of distance_of(), at least
/// kNearest pads.
bool see(const Primitives& primitives,
         const Viewpoint& from,
         std::uint32_t id,
         int face,
         double distance,
         Outline& outline);

}  // namespace grelha
