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

/// The materials that primitives have.
std::vector<Material> materials_in_use(const Scene& scene) {
  const std::vector<char> used = used_materials(scene);
  std::vector<Material> found;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i])
      found.push_back(scene.materials[i]);
  return found;
}

}  // namespace

Needs needs_of(const SceneFile& file) {
  const Geometry& geometry = file.scene.geometry;
  const std::vector<Material> materials = materials_in_use(file.scene);
  const auto some = [&](bool (*has)(const Material&)) {
    return std::ranges::any_of(materials, has);
  };
  const bool glass = some([](const Material& m) { return m.transmission > 0; });
  return {{"spheres", geometry.spheres.size() > 0},
          {"triangles", geometry.triangles.size() > 0},
          {"cones", geometry.cones.size() > 0},
          {"planes", geometry.planes.size() > 0},
          {"smooth_normals", has_normals(geometry.triangles)},
          {"colors", file.colors.any()},
          {"reflection", glass || some([](const Material& m) { return any(m.mirror); })},
          {"refraction", glass},
          {"fresnel", some([](const Material& m) { return m.fresnel && m.transmission > 0; })},
          {"emission", some([](const Material& m) { return any(m.emission); })},
          {"roughness", some([](const Material& m) { return m.roughness > 0; })},
          {"area_lights", std::ranges::any_of(file.scene.lights, &Light::is_area)},
          {"lens", file.lens.present && file.lens.aperture > 0},
          {"environment", !file.environment.empty()}};
}

}  // namespace grelha
