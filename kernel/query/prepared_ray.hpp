#pragma once
// One ray of a query whose walk no hit ends.

#include "kernel/grid/world_impl.hpp"
#include "kernel/traverse/one_ray.hpp"

namespace grelha {

/// A ray whose direction has a length that tests can work with; t counts multiples of single.unit.
struct PreparedRay {
  scalar::Single single;
  bool valid = false;  ///< false: it hits nothing

  PreparedRay(const SceneView& scene, const Ray& ray) : valid(prepare(single, ray, true)) {
    single.geometry = &scene.geometry;
  }
  PreparedRay(const PreparedRay&) = delete;  ///< `single` points into itself
  ExactRay exact() const { return single.given.ray(0); }
  /// Its t in the caller's unit.
  ExactRay given(const ExactRay& ray) const {
    return ray.in_units_of(1 / static_cast<double>(*single.unit));
  }
};

/// Calls visit(id) for the primitives of a cell that stand in arrays.
template <class Visit>
void each_in_arrays(const CellLists& lists, std::size_t cell, const Visit& visit) {
  ArrayShapes::for_each([&]<class Shape>() {
    const typename Shape::CellList& list = lists.of<Shape>();
    for (std::uint32_t i = list.first ? list.first[cell] : 0;
         list.first && i < list.first[cell + 1];
         ++i)
      visit(list.id[i]);
  });
}

}  // namespace grelha
