// The module _grelha.
#include <exception>

#include "frontend/files/parse_error.hpp"
#include "src/core_class.hpp"
#include "src/file_scene.hpp"
#include "src/hear.hpp"

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

void define_scene(py::module_& module) {
  module.def("scene_of_mesh", [](py::handle vertices, py::handle faces, py::handle threads) {
    return FileScene::of_mesh(vertices, faces, threads_in(threads));
  });
  module.def("scene_of_file", [](py::handle path, py::handle threads) {
    return FileScene::read(path, threads_in(threads));
  });
  module.def("scene_of", &FileScene::of_state);
  py::class_<FileScene> scene(module, "SceneCore");
  scene.def("state", &FileScene::state);
  scene.def("core", [](const FileScene& self) { return Core{self.model()}; });
  scene.def("camera", &FileScene::camera);
  scene.def("render",
            [](const FileScene& self,
               py::handle width,
               py::handle height,
               py::handle samples,
               py::handle error,
               py::handle seed,
               py::handle depth,
               py::handle eye,
               py::handle at,
               py::handle up,
               py::handle angle,
               py::handle threads) {
              return self.render(
                  {width, height, samples, error, seed, depth, eye, at, up, angle, threads});
            });
}

}  // namespace
}  // namespace grelha::python

PYBIND11_MODULE(_grelha, module) {
  using namespace grelha::python;
  module.doc() = "What grelha calls. Arguments stand in order; see help(grelha).";
  module.attr("__version__") = GRELHA_VERSION;
  py::register_exception_translator(translate);
  define_core(module);
  define_scene(module);
  module.def("write_image", write_picture);
  py::module_::import("atexit").attr("register")(py::cpp_function(finish_left_work));
}
