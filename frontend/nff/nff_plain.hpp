#pragma once

#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/scene_file.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// After `f`: 8 fields (one color) or 11 (diffuse and specular color), then roughness (12) or two
/// more and an emission (14). Warns of other numbers of fields and of names behind them, and uses
/// the fields it can. After `material` the same, but it looks for up to 11 fields on further lines,
/// as for `mat`.
Material read_nff_fill(NffInput& input, std::string_view keyword);

/// After `mat`: 11, 12 or 14 fields.
Material read_nff_mat(NffInput& input, std::string_view keyword);

/// The material of objects before the first `f`.
Material default_material();

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
