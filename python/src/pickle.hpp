#pragma once
// A model as plain arrays, and back.

#include "src/model.hpp"

namespace grelha::python {

py::tuple state_of(const Model& model);
/// Throws ValueError for what state_of() did not make.
SharedModel model_of(const py::tuple& state);
/// The same, to be built when its materials and lights are there.
ModelParts parts_of_state(const py::tuple& state);

}  // namespace grelha::python
