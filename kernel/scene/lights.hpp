#pragma once
// The lights of a picture as shading sees them.

#include <array>
#include <span>
#include <vector>

#include "grelha/geometry.hpp"
#include "kernel/scene/materials.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

/// Lights and the background.
class LightTable {
 public:
  LightTable(std::span<const Light> lights, const Float3& background);
  /// Puts them into a view of the materials, which points to this table.
  void show(const MaterialTable& materials, ShadingView& view) const;

 private:
  std::vector<float> fields_;  ///< [kLightFloats * lights], see ShadingView
  Float3 background_;
  bool area_ = false;
  float sum_ = 0;  ///< of the lights' largest channels
};

}  // namespace grelha
