#pragma once
// The features of a renderer that a scene needs.

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// The features that a scene uses. Materials that no primitive has do not count.
struct Needs {
  bool spheres = false, triangles = false, cones = false, planes = false;
  bool smooth_normals = false;
  bool reflection = false;  ///< a mirror weight, or glass, which reflects totally at grazing angles
  bool refraction = false, fresnel = false, emission = false, roughness = false;
  bool area_lights = false, lens = false, environment = false;
  bool operator==(const Needs&) const = default;
};

Needs needs_of(const SceneFile& file);

}  // namespace grelha
