#pragma once
// What Python sees: the classes World and Scene, and the module's functions.

#include <pybind11/pybind11.h>

#include "src/file_scene.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// A World of Python's. update() gives it another model; calls that run keep the one they have.
struct PythonWorld {
  SharedModel model;
};

void define_world(py::module_& module);

}  // namespace grelha::python
