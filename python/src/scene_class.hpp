#pragma once
// Pictures and files of the module. A module of rays alone is built without.

#include "src/arrays.hpp"

namespace grelha::python {

void define_scene(py::module_& module);

}  // namespace grelha::python
