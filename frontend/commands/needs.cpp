#include "frontend/commands/needs.hpp"

#include <algorithm>

#include "grelha/scene_spans.hpp"

namespace grelha {

namespace {

bool any(Float3 v) {
  return v.x != 0 || v.y != 0 || v.z != 0;
}

bool any(const std::vector<float>& values) {
  return std::ranges::any_of(values, [](float value) { return value != 0; });
}

bool has_normals(const Triangles& t) {
  return any(t.nx) || any(t.ny) || any(t.nz);
}

void add_needs(Needs& needs, const Material& material) {
  const bool glass = material.transmission > 0;
  needs.reflection |= any(material.mirror) || glass;
  needs.refraction |= glass;
  needs.fresnel |= material.fresnel && glass;
  needs.emission |= any(material.emission);
  needs.roughness |= material.roughness > 0;
}

}  // namespace

Needs needs_of(const SceneFile& file) {
  const Geometry& geometry = file.scene.geometry;
  Needs needs;
  needs.spheres = geometry.spheres.size() > 0;
  needs.triangles = geometry.triangles.size() > 0;
  needs.cones = geometry.cones.size() > 0;
  needs.planes = geometry.planes.size() > 0;
  needs.smooth_normals = has_normals(geometry.triangles);
  needs.lens = file.lens.present && file.lens.aperture > 0;
  needs.area_lights = !file.area_lights.empty();
  needs.environment = !file.environment.empty();
  const std::vector<char> used = used_materials(file.scene);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i])
      add_needs(needs, file.scene.materials[i]);
  }
  return needs;
}

}  // namespace grelha
