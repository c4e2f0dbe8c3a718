// The module _grelha.
#include <string>

#include "src/core_class.hpp"
#include "src/hear.hpp"
#ifdef GRELHA_SCENES
#include "src/scene_class.hpp"
#endif

namespace grelha::python {
namespace {

/// Throws ImportError for a numpy whose arrays would be read as zeros: before 2.12 pybind11 looks
/// for the size of a number where numpy 2 has none.
void expect_numpy() {
  if (PYBIND11_VERSION_MAJOR > 2 || PYBIND11_VERSION_MINOR >= 12)
    return;
  const std::string version = py::str(py::module_::import("numpy").attr("__version__"));
  if (std::stoi(version) >= 2)
    throw py::import_error("grelha: expected numpy before 2, found " + version +
                           "; install \"numpy<2\", or build grelha with pybind11 2.12 or later");
}

}  // namespace
}  // namespace grelha::python

PYBIND11_MODULE(_grelha, module) {
  using namespace grelha::python;
  expect_numpy();
  module.doc() = "What grelha calls. Arguments stand in order; see help(grelha).";
  module.attr("__version__") = GRELHA_VERSION;
  module.attr("pybind11") = py::make_tuple(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
  define_core(module);
#ifdef GRELHA_SCENES
  define_scene(module);
#endif
  count_calls();
}
