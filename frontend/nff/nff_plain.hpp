#pragma once

#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Reads `s`, `p`, `pp`, `c` and `f`, the entities of large files. Also reads `material`, and `st`,
/// `pt` and `ppt`, the same entities with a texture that is left out.
class NffSimple {
 public:
  NffSimple(NffInput& input, SceneFile& file) : input_(input), file_(file), build_(file) {}

  /// After such a word: reads its entity.
  void read(std::string_view keyword);

  /// Index of the last material; without any, a dull white one, which is warned of.
  std::uint32_t material(std::string_view keyword);

 private:
  void read_sphere(std::string_view keyword);
  void read_polygon(std::string_view keyword, bool patch, bool textured);
  void leave_out_texture(std::string_view keyword);
  void read_cone(std::string_view keyword);
  void read_fill(std::string_view keyword);

  NffInput& input_;
  SceneFile& file_;
  SceneBuilder build_;
  std::vector<Float3> corner_points_, normals_;
};

}  // namespace grelha
