#include "src/scene_class.hpp"

#include <exception>

#include "frontend/files/parse_error.hpp"
#include "src/core_class.hpp"
#include "src/file_scene.hpp"
#include "src/materials.hpp"

namespace grelha::python {
namespace {

void translate(std::exception_ptr thrown) {
  try {
    if (thrown)
      std::rethrow_exception(thrown);
  } catch (const FileError& error) {
    PyErr_SetString(PyExc_OSError, error.what());
  } catch (const ParseError& error) {
    PyErr_SetString(PyExc_ValueError, error.what());
  }
}

/// Names in a tuple that outlives them, in the order of the struct.
ViewArguments view_in(const py::tuple& v) {
  const auto at = [&](std::size_t i) { return py::handle(PyTuple_GetItem(v.ptr(), i)); };
  return {at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7), at(8), at(9)};
}

}  // namespace

void define_scene(py::module_& into) {
  py::register_exception_translator(translate);
  Counted module(into);
  module.def(
      "scene_of_mesh",
      [](py::handle vertices,
         py::handle faces,
         py::handle colors,
         py::handle smooth,
         py::handle material,
         py::handle threads) {
        return FileScene::of_mesh({vertices, faces, colors, smooth, material}, threads_in(threads));
      });
  module.def(
      "scene_of_meshes",
      [](py::handle vertices,
         py::handle faces,
         py::handle counts,
         const py::list& materials,
         py::handle threads) {
        return FileScene::of_meshes({vertices, faces, counts, materials}, threads_in(threads));
      });
  module.def("scene_of_file",
             [](py::handle path,
                bool colors,
                py::handle points,
                py::handle smooth,
                py::handle material,
                py::handle threads) {
               return FileScene::read(
                   path, meshes_in(colors, points, smooth), material, threads_in(threads));
             });
  module.def("scene_of", &FileScene::of_state);
  py::class_<FileScene> made(into, "SceneCore");
  Counted scene(made);
  scene.def("state", &FileScene::state);
  scene.def("core", [](const FileScene& self) { return Core{self.model()}; });
  scene.def("of_world",
            [](const FileScene& self, const Core& world) { return self.of_world(world.model); });
  scene.def("camera", &FileScene::camera);
  scene.def("lights", &FileScene::lights);
  scene.def("colors", &FileScene::colors);
  scene.def("solids", &FileScene::solids);
  scene.def("camera_rays", [](const FileScene& self, const py::tuple& view) {
    return self.camera_rays(view_in(view));
  });
  scene.def(
      "render",
      [](const FileScene& self,
         const py::tuple& view,
         py::handle samples,
         py::handle error,
         py::handle seed,
         py::handle depth,
         bool transparent,
         py::handle threads) {
        return self.render({view_in(view), samples, error, seed, depth, transparent, threads});
      });
  module.def("write_image", write_picture);
}

}  // namespace grelha::python
