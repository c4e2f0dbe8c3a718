#pragma once

#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// `l`, `light`, `al` and `L`. Colors of lights that have none wait until all lights are known.
class NffLights {
 public:
  explicit NffLights(SceneFile& file) : file_(file) {}
  void read_point(NffInput& input);                            ///< after `l`
  void read_light(NffInput& input, std::string_view keyword);  ///< after `light`
  void read_area(NffInput& input, std::string_view keyword);   ///< after `al`
  /// After `L`: the emission of the polygons behind it, until an `L` of power 0.
  void read_glow(NffInput& input, std::string_view keyword);
  bool glows() const { return glow_ != Float3{}; }
  /// After `p` or `pp`, while polygons shine: a parallelogram is an area light. False, and nothing
  /// is read, for any other polygon.
  bool read_glowing(NffInput& input, std::string_view keyword);
  void finish();

 private:
  void add_point(Float3 position, Float3 color);
  void add_area(NffInput& input, std::string_view keyword, AreaLight light);
  void finish_glowing();

  SceneFile& file_;
  std::vector<std::size_t> colorless_;
  Float3 glow_{};
  std::vector<std::size_t> glowing_;  ///< of SceneFile::area_lights
};

}  // namespace grelha
