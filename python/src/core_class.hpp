#pragma once
// What grelha/_world.py and grelha/_scene.py call: the classes Core and SceneCore.

#include <pybind11/pybind11.h>

#include "src/model.hpp"

namespace grelha::python {

/// What a World of Python's has. It does not change: update() makes another.
struct Core {
  SharedModel model;
};

/// Arguments stand in order: the names, defaults and docstrings are those of grelha.World.
void define_core(pybind11::module_& module);

}  // namespace grelha::python
