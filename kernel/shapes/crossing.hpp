#pragma once
// Crossings of rays and primitives in exact arithmetic, for cases that floats and doubles cannot
// decide. Given floats are exact numbers. Derivations: docs/numerics.md.

#include "kernel/base/double_double.hpp"
#include "kernel/base/wide_integer.hpp"

namespace grelha {

/// A ray as it came; every number is a float's, times a power of two.
struct ExactRay {
  double org[3];
  double dir[3];
  double t_min, t_max;

  /// With t counted in another length: a power of two.
  ExactRay in_units_of(double unit) const {
    return {{org[0], org[1], org[2]},
            {dir[0] / unit, dir[1] / unit, dir[2] / unit},
            t_min * unit,
            t_max * unit};
  }
};

/// The first crossing beyond t_min of a ray and a primitive.
class ExactCrossing {
 public:
  ExactCrossing() = default;  ///< there is none
  /// t = numerator / denominator, which is not 0.
  ExactCrossing(const Expansion& numerator, const Expansion& denominator)
      : exists_(true), rational_(true), numerator_(numerator), denominator_(denominator) {}
  explicit ExactCrossing(const DoubleDouble& t) : exists_(true), t_(t) {}
  /// t = numerator / denominator times a power of two.
  ExactCrossing(Int128 numerator, Int128 denominator, double unit)
      : exists_(true), whole_(true), n_(numerator), d_(denominator), unit_(unit) {}

  bool some() const { return exists_; }
  /// The sign of t - x: exact for triangles and planes, of 100 bits for spheres and cones.
  int compare(double x) const;
  /// The sign of t - other.t: exact if both are triangles or planes. Others are equal if their
  /// first 90 bits agree.
  int compare(const ExactCrossing& other) const;
  /// t, within 2^-50 of itself.
  double estimate() const;
  /// The float nearest to t; of two the even one.
  float rounded() const;

 private:
  DoubleDouble wide() const;

  bool exists_ = false;
  bool rational_ = false;
  bool whole_ = false;
  Int128 n_ = 0, d_ = 0;
  double unit_ = 0;
  /// The same, of expansions.
  ExactCrossing unfolded() const;
  Expansion numerator_, denominator_;
  DoubleDouble t_;
};

/// From either side, edges and corners included. Rays in the plane of a triangle, and triangles
/// without an area, do not cross.
ExactCrossing cross_triangle(const ExactRay& ray, const float (&corner)[3][3]);
/// Weights of the corners where a ray crosses a triangle, given that it does: each within 2^-30,
/// none negative.
void crossing_weights(const ExactRay& ray, const float (&corner)[3][3], double (&weight)[3]);
/// True if a ray that is moved aside by an infinitesimal amount crosses between t_min and t_max.
/// Such a ray crosses no edge and no corner of a closed mesh, so its crossings are even in number
/// outside and odd inside. Edelsbrunner & Mücke, "Simulation of Simplicity", 1990.
bool crosses_beside(const ExactRay& ray, const float (&corner)[3][3]);
/// The order in which that ray crosses two triangles: -1, 0 (at the same t, as in one plane) or 1.
int order_beside(const ExactRay& ray, const float (&corner)[3][3], const float (&other)[3][3]);
/// Where the line of a ray crosses the plane of a triangle; it must.
ExactCrossing cross_plane_of(const ExactRay& ray, const float (&corner)[3][3]);
/// True if a ray that crosses a triangle comes from the side from which its corners are
/// counter-clockwise.
bool crosses_front(const ExactRay& ray, const float (&corner)[3][3]);
/// A complex number whose angle is half the solid angle of a triangle, as solid_angle.hpp has it.
struct SolidAngleParts {
  double real;
  double volume;  ///< the imaginary part: its sign is exact
};
/// In numbers of 106 bits: within 2^-94 of the product of the distances to the corners, and
/// rounded.
SolidAngleParts solid_angle_parts(const double (&point)[3], const float (&corner)[3][3]);
/// True if a point lies within a distance of another: exact.
bool is_within(const double (&point)[3], const float (&center)[3], float radius);
/// From either side. Rays along a plane do not cross.
ExactCrossing cross_plane(const ExactRay& ray, const float (&point)[3], const float (&normal)[3]);
/// From outside or inside; of a negative radius from inside alone. A line that touches crosses.
ExactCrossing cross_sphere(const ExactRay& ray, const float (&center)[3], float radius);

/// The side of a cone frustum, as Cone::Fields has it.
struct ExactCone {
  float base[3], axis[3], height, radius, slope, side;
};
ExactCrossing cross_cone(const ExactRay& ray, const ExactCone& cone);

}  // namespace grelha
