#pragma once

#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_builder.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// Reads `s`, `p`, `pp`, `c` and `f`, the entities of large files. They depend on nothing before
/// them but the last material. Also reads `material`, and `st`, `pt` and `ppt`, the same entities
/// with a texture that is left out.
class NffSimple {
 public:
  /// `most_vertices`: a polygon of more is not read.
  NffSimple(NffInput& input, SceneFile& file, std::size_t most_vertices = std::size_t(-1))
      : input_(input), file_(file), build_(file), most_vertices_(most_vertices) {}

  /// After such a word: reads its entity. Returns false, and reads nothing, after any other word.
  bool read(std::string_view keyword);

  /// Index of the last material; without any, a dull white one, which is warned of.
  std::uint32_t material(std::string_view keyword);

 private:
  void read_sphere(std::string_view keyword);
  bool read_polygon(std::string_view keyword, bool patch, bool textured);
  void leave_out_texture(std::string_view keyword);
  void read_cone(std::string_view keyword);
  void read_fill(std::string_view keyword);

  NffInput& input_;
  SceneFile& file_;
  SceneBuilder build_;
  std::size_t most_vertices_;
  std::vector<Float3> corner_points_, normals_;
};

/// Returns true for the words that NffSimple reads without a warning.
inline bool is_simple_word(std::string_view word) {
  return word == "p" || word == "s" || word == "pp" || word == "c" || word == "f";
}

}  // namespace grelha
