#pragma once
// How a bare mesh is seen: what is up, from which side, and how far away it fits into the picture.

#include <optional>

#include "frontend/scene/double3.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

inline constexpr double kFilledByMesh = .9;  ///< of a picture's height, or of its width

inline Double3 unit_vector(const Double3& a) {
  return sum(1 / length(a), a, 0, a);
}

/// The axes of a valid camera: from `at` to the eye, to its right and up.
struct CameraAxes {
  explicit CameraAxes(const Camera& c)
      : back(difference(c.eye, c.at)),
        distance(length(back)),
        right(unit_vector(cross(in_double(c.up), back))),
        up(unit_vector(cross(back, right))) {
    back = unit_vector(back);
  }
  Double3 back;
  double distance;
  Double3 right, up;
};

struct MeshView {
  Camera camera;
  MeshExtent extent;
};

/// A three-quarter view of triangles and balls, 30 degrees to the right of their front and 20 above
/// it, 40 if they are thin in that direction. `up`: absent is by their shape, along the axis in
/// which a sheet is thin, else y, or z if they stand far more surely on that side. The front is z
/// where y is up, and else -y, as in programs for CAD.
MeshView mesh_view(const Geometry& geometry, const std::optional<Float3>& up = {});

/// Moves a camera along its view, and across it, until the picture shows the mesh in every position
/// of a turn about `pole`: the distance is the same all around. An orthographic picture has the
/// mesh in its middle, and with `fit_height` the height that shows it.
void fit_turned(const MeshExtent& mesh, const Float3& pole, bool fit_height, Camera& camera);

/// Steps back with the camera of mesh_view(), which shows its mesh in a square, until a narrower
/// picture shows it as well.
void fit_width(const MeshExtent& mesh, Camera& camera);

}  // namespace grelha
