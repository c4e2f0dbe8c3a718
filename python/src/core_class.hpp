#pragma once
// What grelha/_world.py and grelha/_scene.py call: the classes Core and SceneCore.

#include <utility>

#include <pybind11/pybind11.h>

#include "src/hear.hpp"
#include "src/model.hpp"

namespace grelha::python {

/// A module or class whose functions count as CallUnderWay.
template <class Scope>
class Counted {
 public:
  explicit Counted(Scope& scope) : scope_(scope) {}
  template <class Function>
  void def(const char* name, Function&& function) {
    scope_.def(name, std::forward<Function>(function), pybind11::call_guard<CallUnderWay>());
  }

 private:
  Scope& scope_;
};

/// What a World of Python's has. A model that anything else shares does not change.
struct Core {
  SharedModel model;
};

/// Arguments stand in order: the names, defaults and docstrings are those of grelha.World.
void define_core(pybind11::module_& module);

}  // namespace grelha::python
