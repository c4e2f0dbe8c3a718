#pragma once

#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// `l`, `light` and `al`. Colors of lights that have none wait until all lights are known.
class NffLights {
 public:
  explicit NffLights(SceneFile& file) : file_(file) {}
  void read_point(NffInput& input);                            ///< after `l`
  void read_light(NffInput& input, std::string_view keyword);  ///< after `light`
  void read_area(NffInput& input, std::string_view keyword);   ///< after `al`
  void finish();

 private:
  void add_point(Float3 position, Float3 color);
  void add_area(NffInput& input, std::string_view keyword, AreaLight light);

  SceneFile& file_;
  std::vector<std::size_t> colorless_;
};

}  // namespace grelha
