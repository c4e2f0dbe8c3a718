#pragma once
// What a scene asks of a renderer, and how far it reaches.

#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Which parts of a renderer a scene calls for, from what its primitives use: an unused material
/// asks for nothing.
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
