#include "frontend/scene/scene_parts.hpp"

#include <vector>

namespace grelha {
namespace {

using Indices = std::vector<std::uint32_t>;

template <class T>
void append(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void append_shifted(Indices& all, const Indices& more, std::uint32_t shift) {
  const std::size_t before = all.size();
  append(all, more);
  for (std::size_t i = before; i < all.size(); ++i)
    all[i] += shift;
}

/// Normals are empty where no vertex has one, and short until one has.
void append_normals(Triangles& all, const Triangles& more) {
  if (all.nx.empty() && more.nx.empty())
    return;
  const std::size_t before = all.vertex_count(), after = before + more.vertex_count();
  const auto append_one = [&](std::vector<float>& n, const std::vector<float>& n_more) {
    n.resize(before);
    append(n, n_more);
    n.resize(after);
  };
  append_one(all.nx, more.nx);
  append_one(all.ny, more.ny);
  append_one(all.nz, more.nz);
}

void append_triangles(Triangles& all, const Triangles& more, std::uint32_t first_material) {
  const auto first_vertex = std::uint32_t(all.vertex_count());
  append_normals(all, more);
  append(all.x, more.x);
  append(all.y, more.y);
  append(all.z, more.z);
  append_shifted(all.a, more.a, first_vertex);
  append_shifted(all.b, more.b, first_vertex);
  append_shifted(all.c, more.c, first_vertex);
  append_shifted(all.material, more.material, first_material);
}

void append_spheres(Spheres& all, const Spheres& more, std::uint32_t first_material) {
  append(all.x, more.x);
  append(all.y, more.y);
  append(all.z, more.z);
  append(all.radius, more.radius);
  append_shifted(all.material, more.material, first_material);
}

void append_cones(Cones& all, const Cones& more, std::uint32_t first_material) {
  append(all.base_x, more.base_x);
  append(all.base_y, more.base_y);
  append(all.base_z, more.base_z);
  append(all.base_radius, more.base_radius);
  append(all.apex_x, more.apex_x);
  append(all.apex_y, more.apex_y);
  append(all.apex_z, more.apex_z);
  append(all.apex_radius, more.apex_radius);
  append_shifted(all.material, more.material, first_material);
}

void add_counts(SceneFile& file, const SceneFile& part) {
  file.counts.s += part.counts.s;
  file.counts.p += part.counts.p;
  file.counts.pp += part.counts.pp;
  file.counts.c += part.counts.c;
  file.counts.materials += part.counts.materials;
  file.dropped.not_finite += part.dropped.not_finite;
  file.dropped.zero_area += part.dropped.zero_area;
}

}  // namespace

void append_part(SceneFile& file, const SceneFile& part) {
  Geometry& all = file.scene.geometry;
  const Geometry& more = part.scene.geometry;
  std::vector<Material>& materials = file.scene.materials;
  const auto first_material = std::uint32_t(materials.size() - 1);
  append_triangles(all.triangles, more.triangles, first_material);
  append_spheres(all.spheres, more.spheres, first_material);
  append_cones(all.cones, more.cones, first_material);
  materials.insert(materials.end(), part.scene.materials.begin() + 1, part.scene.materials.end());
  add_counts(file, part);
}

}  // namespace grelha
