// The module _grelha.
#include <exception>

#include "frontend/files/parse_error.hpp"
#include "src/documents.hpp"
#include "src/file_scene.hpp"
#include "src/world_class.hpp"

namespace grelha::python {
namespace {

using namespace pybind11::literals;

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
  const auto all = "threads"_a = 0;
  py::class_<FileScene> scene(module, "Scene", documents::kScene);
  scene.def(py::init([](py::object vertices, py::object faces, py::object threads) {
              return FileScene::of_mesh(vertices, faces, threads_in(threads));
            }),
            "vertices"_a,
            "faces"_a,
            py::kw_only(),
            all);
  scene.def_property_readonly(
      "world",
      [](const FileScene& self) { return PythonWorld{self.model()}; },
      "A World of all primitives.");
  for (const char* const name : {"vertices", "faces"})
    scene.def_property_readonly(
        name,
        [name](const FileScene& self) {
          return py::object(py::cast(PythonWorld{self.model()}).attr(name));
        },
        "As of World.");
  scene.def_property_readonly(
      "camera", &FileScene::camera, "A dict of eye, at, up, angle, width and height.");
  scene.def(
      "render",
      [](const FileScene& self,
         py::object width,
         py::object height,
         py::object samples,
         py::object error,
         py::object seed,
         py::object depth,
         py::object eye,
         py::object at,
         py::object up,
         py::object angle,
         py::object threads) {
        return self.render(
            {width, height, samples, error, seed, depth, eye, at, up, angle, threads});
      },
      "width"_a = py::none(),
      "height"_a = py::none(),
      py::kw_only(),
      "samples"_a = py::none(),
      "error"_a = py::none(),
      "seed"_a = 0,
      "depth"_a = 5,
      "eye"_a = py::none(),
      "at"_a = py::none(),
      "up"_a = py::none(),
      "angle"_a = py::none(),
      all,
      documents::kRender);
}

}  // namespace
}  // namespace grelha::python

PYBIND11_MODULE(_grelha, module) {
  using namespace grelha::python;
  py::options options;
  options.disable_function_signatures();
  module.doc() = documents::kModule;
  module.attr("__version__") = GRELHA_VERSION;
  py::register_exception_translator(translate);
  define_world(module);
  define_scene(module);
  module.def(
      "read",
      [](py::object path, py::object threads) {
        return FileScene::read(path, threads_in(threads));
      },
      "path"_a,
      py::kw_only(),
      "threads"_a = 0,
      documents::kRead);
  module.def("write_image", write_picture, "path"_a, "image"_a, documents::kWrite);
}
