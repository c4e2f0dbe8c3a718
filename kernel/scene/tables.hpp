#pragma once
// Tables of materials and lights, as shading reads them.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "grelha/geometry.hpp"
#include "grelha/scene_spans.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {

inline float largest_channel(const Float3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Materials one array per component, so that lanes gather what they need and no more; and what
/// those that primitives have ask for.
struct MaterialTable {
  explicit MaterialTable(const SceneSpans& scene);
  MaterialView view() const;
  std::array<std::vector<float>, kMaterialFields> fields;
  bool reflects = false;
  bool refracts = false;
  bool fresnel = false;
  bool emits = false;
  bool highlights = false;
  bool glossy = false;
  bool gains = false;
  /// greatest radiance towards an eye: of a point, per light of 1; and of the brightest emitter
  float lit = 0;
  float emitted = 0;

 private:
  void set_fields(std::size_t i, const Material& m);
  /// Notes the effects that a used material asks for.
  void record_effects(const Material& m);
};

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
