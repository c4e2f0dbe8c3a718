#include "src/core_class.hpp"

#include <string>
#include <vector>

#include "src/meshes.hpp"
#include "src/pickle.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

/// Vertices as an array of shape (n, 3): as they are, or in the caller's units.
py::object rows_of(const Model& model, const Triangles& t) {
  std::vector<Float3> points(t.vertex_count());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {t.x[i], t.y[i], t.z[i]};
  return outside_points(model, points, {py::ssize_t(points.size())});
}

py::object offset_of(const Model& model) {
  const auto& offset = model.frame.offset;
  return py::array_t<double>(3, offset.data());
}

std::string text_of_geometry(const Model& model) {
  const Geometry& g = model.geometry();
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + what;
  };
  add(g.triangles.size(), "triangles");
  add(g.spheres.size(), "spheres");
  add(g.cones.size(), "cones");
  add(g.planes.size(), "planes");
  return text.empty() ? "empty" : text;
}

/// A method that asks rays.
template <class Query>
auto of_rays(const Query& query) {
  return [query](const Core& self,
                 py::handle origins,
                 py::handle directions,
                 py::handle t_min,
                 py::handle t_max,
                 py::handle skip,
                 py::handle mask,
                 py::handle masks,
                 py::handle threads) {
    const SharedModel model = self.model;
    return query(
        *model, RayArguments{origins, directions, t_min, t_max, skip, mask, masks}, threads);
  };
}

/// A method that asks points, and reads another argument.
template <class Query>
auto of_points(const Query& query) {
  return [query](const Core& self, py::handle points, py::handle argument, py::handle threads) {
    const SharedModel model = self.model;
    return query(model, points, argument, threads);
  };
}

using CoreClass = Counted<py::class_<Core>>;

void define_making(Counted<py::module_> module, CoreClass core) {
  module.def("mesh", [](py::handle vertices, py::handle faces, py::handle threads) {
    const int count = threads_in(threads);
    return Core{built(mesh_parts(vertices, faces), count)};
  });
  module.def("check_mesh",
             [](py::handle vertices, py::handle faces) { mesh_parts(vertices, faces); });
  module.def("meshes",
             [](py::handle vertices, py::handle faces, py::handle counts, py::handle threads) {
               const int count = threads_in(threads);
               return Core{built(joined_parts(vertices, faces, counts), count)};
             });
  module.def("spheres", [](py::handle centers, py::handle radii, py::handle threads) {
    const int count = threads_in(threads);
    return Core{built(sphere_parts(centers, radii), count)};
  });
  module.def("core_of", [](const py::tuple& state) { return Core{model_of(state)}; });
  core.def("state", [](const Core& self) { return state_of(*self.model); });
  core.def("moved",
           [](const Core& self, py::handle vertices, py::handle radii, py::handle threads) {
             const int count = threads_in(threads);
             return Core{built(moved_parts(*self.model, vertices, radii), count)};
           });
  core.def("meshes_moved",
           [](const Core& self, const py::list& moves, const char* method, py::handle threads) {
             const int count = threads_in(threads);
             return Core{meshes_moved(self.model, moves, method, count)};
           });
  core.def("mesh_removed", [](const Core& self, py::handle mesh, py::handle threads) {
    const int count = threads_in(threads);
    return Core{mesh_removed(*self.model, mesh, count)};
  });
  core.def("mesh_shown", [](const Core& self, py::handle mesh, bool visible, py::handle threads) {
    const int count = threads_in(threads);
    return Core{mesh_shown(self.model, mesh, visible, count)};
  });
  core.def("mesh_added",
           [](const Core& self, py::handle vertices, py::handle faces, py::handle threads) {
             const int count = threads_in(threads);
             return Core{mesh_added(self.model, vertices, faces, count)};
           });
  core.def("is_visible",
           [](const Core& self, py::handle mesh) { return mesh_is_visible(*self.model, mesh); });
  core.def("masks_in",
           [](const Core& self, py::handle masks) { return masks_in(masks, *self.model); });
}

void define_members(CoreClass core) {
  core.def("vertices",
           [](const Core& self) { return rows_of(*self.model, self.model->geometry().triangles); });
  core.def("faces", [](const Core& self) {
    const Triangles& t = self.model->geometry().triangles;
    py::array_t<std::int64_t> faces(Shape{py::ssize_t(t.size()), 3});
    std::int64_t* to = faces.mutable_data();
    for (std::size_t i = 0; i < t.size(); ++i)
      for (const std::uint32_t v : {t.a[i], t.b[i], t.c[i]})
        *to++ = v;
    return faces;
  });
  core.def("meshes", [](const Core& self) { return mesh_count(self.model->scene()); });
  core.def("mesh_of", [](const Core& self, py::handle ids) { return mesh_of(*self.model, ids); });
  core.def("offset", [](const Core& self) { return offset_of(*self.model); });
  core.def("text", [](const Core& self) { return text_of_geometry(*self.model); });
}

}  // namespace

void define_core(py::module_& module) {
  py::class_<Core> made(module, "Core");
  CoreClass core(made);
  define_making(Counted(module), core);
  define_members(core);
  core.def("closest", of_rays(closest_hits));
  core.def("occluded", of_rays(occluded_rays));
  core.def("all_hits", of_rays(all_ray_hits));
  core.def("count_hits", of_rays(hit_counts));
  core.def("crossings", of_rays(ray_crossings));
  core.def("count_crossings", of_rays(crossing_counts));
  core.def("surfaces", of_rays(ray_surfaces));
  core.def("check", [](const Core& self) { return checked_mesh(SharedModel(self.model)); });
  core.def("contains", of_points(inside_points));
  core.def("signed_distance", of_points(signed_distances_of));
  core.def("winding_number", of_points(winding_numbers_of));
  core.def("closest_points", of_points(nearest_points));
  core.def(
      "start",
      [](const Core& self, py::handle face, py::handle u, py::handle v, py::handle directions) {
        const SharedModel model = self.model;
        return start_points(*model, {face, u, v, directions});
      });
}

}  // namespace grelha::python
