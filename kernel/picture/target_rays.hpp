#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "grelha/stats.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/picture/refinement.hpp"
#include "kernel/shade/strips.hpp"

namespace grelha {

struct Point3 {
  double at[3];
  double operator[](std::size_t a) const { return at[a]; }
  double& operator[](std::size_t a) { return at[a]; }
  bool operator==(const Point3&) const = default;
};
inline Point3 operator-(const Point3& a, const Point3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
inline double dot(const Point3& a, const Point3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point3 cross(const Point3& a, const Point3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// All of a thing lies within `radius` of the stretch between its ends.
struct Capsule {
  Point3 end[2];
  double radius;
  std::uint32_t material;

  double length() const { return std::sqrt(dot(end[1] - end[0], end[1] - end[0])); }
};

inline Capsule capsule_of(const SphereSpans& s, std::size_t i) {
  const Point3 centre{{s.x[i], s.y[i], s.z[i]}};
  return {{centre, centre}, std::abs(static_cast<double>(s.radius[i])), s.material[i]};
}

inline Capsule capsule_of(const ConeSpans& c, std::size_t i) {
  return {{{{c.base_x[i], c.base_y[i], c.base_z[i]}}, {{c.apex_x[i], c.apex_y[i], c.apex_z[i]}}},
          std::max(std::abs(static_cast<double>(c.base_radius[i])),
                   std::abs(static_cast<double>(c.apex_radius[i]))),
          c.material[i]};
}

inline Point3 corner_of(const TriangleSpans& t, std::uint32_t vertex) {
  return {{t.x[vertex], t.y[vertex], t.z[vertex]}};
}

/// The plane of points p with dot(normal, p) = distance.
struct MirrorPlane {
  Point3 normal;  ///< a unit vector
  double distance;

  double above(const Point3& p) const { return dot(normal, p) - distance; }
  /// The mirror image of a point.
  Point3 image(const Point3& p) const {
    const double twice = 2 * above(p);
    return {{p[0] - twice * normal[0], p[1] - twice * normal[1], p[2] - twice * normal[2]}};
  }
};

/// Planes of smooth mirrors, each once; empty if there are more than a few, as in a curved mirror.
std::vector<MirrorPlane> flat_mirrors(const World::Impl& world);

/// True if a material is a smooth mirror.
bool is_smooth_mirror(const MaterialView& materials, std::uint32_t material);

/// The connected pieces of triangles, in the order of their first ones. Triangles that share a
/// vertex are connected, by its index or (for small pieces) by its coordinates. For a piece of many
/// triangles, every so many tell where it lies.
std::vector<Capsule> mesh_parts(const TriangleSpans& triangles);

// Projects points of a scene into its picture.

/// A camera in double precision.
class ToPicture {
 public:
  explicit ToPicture(const FrameView& f) : f_(f) {
    for (std::size_t a = 0; a < 3; ++a) {
      eye_[a] = f.eye[a];
      ff_ += square(f.forward[a]);
      rr_ += square(f.right[a]);
      uu_ += square(f.up[a]);
    }
  }
  struct Spot {
    double x, y;   ///< pixels
    double depth;  ///< in lengths of `forward`
  };
  Spot operator()(const Point3& p) const {
    double z = 0;
    double x = 0;
    double y = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = p[a] - eye_[a];
      z += d * f_.forward[a];
      x += d * f_.right[a];
      y += d * f_.up[a];
    }
    z /= ff_;
    const double shrink = f_.parallel ? 1 : z;
    return {.5 * f_.width + x / (rr_ * shrink), .5 * f_.height - y / (uu_ * shrink), z};
  }
  /// Where a ray that sees a point starts.
  Point3 eye(const Point3& p) const {
    if (!f_.parallel)
      return eye_;
    const double depth = (*this)(p).depth;
    Point3 at = p;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] -= depth * f_.forward[a];
    return at;
  }
  /// How wide a pixel is.
  double pixel(double depth) const { return (f_.parallel ? 1 : depth) * std::sqrt(rr_); }
  /// Pixels that a ball of a radius reaches from its middle at most, anywhere in the picture: balls
  /// look longer in its corners.
  double half_width(double radius, double depth) const {
    const double corner =
        f_.parallel ? 0 : square(.5 * f_.width) * rr_ + square(.5 * f_.height) * uu_;
    return radius / pixel(depth) * std::sqrt(1 + corner / ff_);
  }

 private:
  static double square(double x) { return x * x; }
  const FrameView& f_;
  Point3 eye_;
  double ff_ = 0;
  double rr_ = 0;
  double uu_ = 0;
};

/// Cuts off what of a capsule lies behind the eye, or nearly so; false: nothing is left.
inline bool cut_behind(const ToPicture& to, Capsule& capsule) {
  const double z[2] = {to(capsule.end[0]).depth, to(capsule.end[1]).depth};
  const double least = 1e-3 * std::max(z[0], z[1]);
  if (!(least > 0))
    return false;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t a = 0; z[k] < least && a < 3; ++a)
      capsule.end[k][a] +=
          (least - z[k]) / (z[1 - k] - z[k]) * (capsule.end[1 - k][a] - capsule.end[k][a]);
  return true;
}

/// Number of objects that samples may miss: triangles and all other primitives.
std::size_t object_count(const World::Impl& world);

/// Sends a ray to each sphere, cone or piece of a mesh that looks thinner than a pixel, one per
/// pixel of its length: straight through transparent surfaces, by way of flat mirrors, and from
/// each point light on to the surface behind it. The pixels of a refined picture that a ray hits
/// get boxes that later samples favour; until then r.missed holds the variances that the objects
/// may add to blocks.
void target_small_objects(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts);

}  // namespace grelha
