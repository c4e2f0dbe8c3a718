// The module _grelha.
#include "src/core_class.hpp"
#include "src/hear.hpp"
#ifdef GRELHA_SCENES
#include "src/scene_class.hpp"
#endif

PYBIND11_MODULE(_grelha, module) {
  using namespace grelha::python;
  module.doc() = "What grelha calls. Arguments stand in order; see help(grelha).";
  module.attr("__version__") = GRELHA_VERSION;
  define_core(module);
#ifdef GRELHA_SCENES
  define_scene(module);
#endif
  count_calls();
}
