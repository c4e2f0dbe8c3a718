#include "src/world_class.hpp"

#include <limits>
#include <string>

#include "src/documents.hpp"
#include "src/pickle.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

using namespace pybind11::literals;

/// Axes as an array of shape (n, 3): as they are, or in the caller's units.
py::object rows_of(const Model& model,
                   const std::vector<float>& x,
                   const std::vector<float>& y,
                   const std::vector<float>& z) {
  const std::vector<float>* const axes[3] = {&x, &y, &z};
  const Shape shape{py::ssize_t(x.size()), 3};
  const auto fill = [&](auto array) -> py::object {
    auto* to = array.mutable_data();
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a)
        *to++ = static_cast<std::decay_t<decltype(*to)>>(model.frame.outside((*axes[a])[i], a));
    return array;
  };
  return model.in_double ? fill(py::array_t<double>(shape)) : fill(py::array_t<float>(shape));
}

py::object offset_of(const Model& model) {
  const auto& offset = model.frame.offset;
  return py::array_t<double>(3, offset.data());
}

std::string text_of_world(const Model& model) {
  const Geometry& g = model.scene.geometry;
  std::string text;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0)
      text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + what;
  };
  add(g.triangles.size(), "triangles");
  add(g.spheres.size(), "spheres");
  add(g.cones.size(), "cones");
  add(g.planes.size(), "planes");
  return "<grelha.World: " + (text.empty() ? "empty" : text) + '>';
}

/// A method that asks rays.
template <class Query>
auto of_rays(const Query& query) {
  return [query](const PythonWorld& self,
                 py::object origins,
                 py::object directions,
                 py::object t_min,
                 py::object t_max,
                 py::object skip,
                 py::object threads) {
    const SharedModel model = self.model;
    return query(*model, RayArguments{origins, directions, t_min, t_max, skip}, threads);
  };
}

/// A method that asks points.
template <class Query>
auto of_points(const Query& query) {
  return [query](const PythonWorld& self, py::object points, py::object threads) {
    const SharedModel model = self.model;
    return query(*model, points, threads);
  };
}

void define_making(py::class_<PythonWorld>& world) {
  const auto all = "threads"_a = 0;
  world.def(py::init([](py::object vertices, py::object faces, py::object threads) {
              const int count = threads_in(threads);
              return PythonWorld{built(mesh_model(vertices, faces), count)};
            }),
            "vertices"_a,
            "faces"_a,
            py::kw_only(),
            all);
  world.def_static(
      "spheres",
      [](py::object centers, py::object radii, py::object threads) {
        const int count = threads_in(threads);
        return PythonWorld{built(sphere_model(centers, radii), count)};
      },
      "centers"_a,
      "radii"_a,
      py::kw_only(),
      all,
      documents::kSpheres);
  world.def(
      "update",
      [](PythonWorld& self, py::object vertices, py::object threads) {
        const int count = threads_in(threads);
        self.model = built(moved_model(*self.model, vertices), count);
      },
      "vertices"_a,
      py::kw_only(),
      all,
      documents::kUpdate);
  world.def(py::pickle([](const PythonWorld& self) { return state_of(*self.model); },
                       [](const py::tuple& state) { return PythonWorld{model_of(state)}; }));
}

void define_members(py::class_<PythonWorld>& world) {
  world.def_property_readonly(
      "vertices",
      [](const PythonWorld& self) {
        const Triangles& t = self.model->scene.geometry.triangles;
        return rows_of(*self.model, t.x, t.y, t.z);
      },
      "The vertices as they were rounded: a copy, (n, 3) float32, or float64 if they were given "
      "so.");
  world.def_property_readonly(
      "faces",
      [](const PythonWorld& self) {
        const Triangles& t = self.model->scene.geometry.triangles;
        py::array_t<std::int64_t> faces(Shape{py::ssize_t(t.size()), 3});
        std::int64_t* to = faces.mutable_data();
        for (std::size_t i = 0; i < t.size(); ++i)
          for (const std::uint32_t v : {t.a[i], t.b[i], t.c[i]})
            *to++ = v;
        return faces;
      },
      "The triangles' vertices: a copy, (m, 3) int64.");
  world.def_property_readonly(
      "offset",
      [](const PythonWorld& self) { return offset_of(*self.model); },
      "What was subtracted from the vertices before they were rounded: (3,) float64.");
  world.def("__repr__", [](const PythonWorld& self) { return text_of_world(*self.model); });
}

}  // namespace

void define_world(py::module_& module) {
  py::class_<PythonWorld> world(module, "World", documents::kWorld);
  define_making(world);
  define_members(world);
  const auto rays = [&](const char* name, auto query, const char* document) {
    world.def(name,
              of_rays(query),
              "origins"_a,
              "directions"_a,
              "t_min"_a = 0.,
              "t_max"_a = std::numeric_limits<double>::infinity(),
              "skip"_a = py::none(),
              py::kw_only(),
              "threads"_a = 0,
              document);
  };
  rays("closest", closest_hits, documents::kClosest);
  rays("occluded", occluded_rays, documents::kOccluded);
  rays("all_hits", all_ray_hits, documents::kAllHits);
  rays("count_hits", hit_counts, documents::kCountHits);
  const auto points = [&](const char* name, auto query, const char* document) {
    world.def(name, of_points(query), "points"_a, py::kw_only(), "threads"_a = 0, document);
  };
  points("contains", inside_points, documents::kContains);
  points("signed_distance", signed_distances_of, documents::kSignedDistance);
  world.def(
      "closest_points",
      [](const PythonWorld& self, py::object given, py::object radius, py::object threads) {
        const SharedModel model = self.model;
        return nearest_points(*model, given, radius, threads);
      },
      "points"_a,
      "radius"_a = std::numeric_limits<double>::infinity(),
      py::kw_only(),
      "threads"_a = 0,
      documents::kClosestPoints);
}

}  // namespace grelha::python
