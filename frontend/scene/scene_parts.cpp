#include "frontend/scene/scene_parts.hpp"

#include <exception>
#include <vector>

#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

/// Calls `use` with each array of a whole and the same one of its part.
template <class Use>
void with_arrays(Triangles& all, const Triangles& part, const Use& use) {
  use(all.x, part.x);
  use(all.y, part.y);
  use(all.z, part.z);
  use(all.a, part.a);
  use(all.b, part.b);
  use(all.c, part.c);
  use(all.material, part.material);
}
template <class Use>
void with_arrays(Spheres& all, const Spheres& part, const Use& use) {
  use(all.x, part.x);
  use(all.y, part.y);
  use(all.z, part.z);
  use(all.radius, part.radius);
  use(all.material, part.material);
}
template <class Use>
void with_arrays(Cones& all, const Cones& part, const Use& use) {
  use(all.base_x, part.base_x);
  use(all.base_y, part.base_y);
  use(all.base_z, part.base_z);
  use(all.base_radius, part.base_radius);
  use(all.apex_x, part.apex_x);
  use(all.apex_y, part.apex_y);
  use(all.apex_z, part.apex_z);
  use(all.apex_radius, part.apex_radius);
  use(all.material, part.material);
}

constexpr auto append = [](auto& all, const auto& part) {
  reserve_to_fill(all, all.size() + part.size());
  all.insert(all.end(), part.begin(), part.end());
};

void shift(std::vector<std::uint32_t>& indices, std::size_t first, std::uint32_t by) {
  for (std::size_t i = first; i < indices.size(); ++i)
    indices[i] += by;
}

/// Normals are empty where no vertex has one, and short until one has.
void append_normals(Triangles& all, const Triangles& part) {
  if (all.nx.empty() && part.nx.empty())
    return;
  const std::size_t before = all.vertex_count(), after = before + part.vertex_count();
  const auto append_one = [&](std::vector<float>& n, const std::vector<float>& more) {
    n.resize(before);
    append(n, more);
    n.resize(after);
  };
  append_one(all.nx, part.nx);
  append_one(all.ny, part.ny);
  append_one(all.nz, part.nz);
}

void append_triangles(Triangles& all, const Triangles& part, std::uint32_t first_material) {
  const auto first_vertex = std::uint32_t(all.vertex_count());
  const std::size_t first = all.size();
  append_normals(all, part);
  with_arrays(all, part, append);
  shift(all.a, first, first_vertex);
  shift(all.b, first, first_vertex);
  shift(all.c, first, first_vertex);
  shift(all.material, first, first_material);
}

/// Spheres or cones.
template <class Kind>
void append_kind(Kind& all, const Kind& part, std::uint32_t first_material) {
  const std::size_t first = all.size();
  with_arrays(all, part, append);
  shift(all.material, first, first_material);
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
  append_kind(all.spheres, more.spheres, first_material);
  append_kind(all.cones, more.cones, first_material);
  materials.insert(materials.end(), part.scene.materials.begin() + 1, part.scene.materials.end());
  add_counts(file, part);
}

void reserve_for_parts(SceneFile& file, const SceneFile& part, double times) noexcept try {
  const auto reserve = [times](auto& all, const auto& more) {
    all.reserve(all.size() + std::size_t(double(more.size()) * times));
  };
  Geometry& all = file.scene.geometry;
  const Geometry& first = part.scene.geometry;
  with_arrays(all.triangles, first.triangles, reserve);
  with_arrays(all.spheres, first.spheres, reserve);
  with_arrays(all.cones, first.cones, reserve);
} catch (const std::exception&) {  // then they grow as far as they can
}

}  // namespace grelha
