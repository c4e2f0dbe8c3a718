#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "frontend/nff/nff_input.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

/// The lines of `v` and `camera`. They may stand in any order and anywhere; finish() checks the
/// required lines at the end of the file.
class NffView {
 public:
  /// All keywords of the view.
  static std::span<const std::string_view> words();
  /// Reads the entity if `word` is one of the view's; false if it is not.
  bool read(std::string_view word, NffInput& input, LensHint& lens);
  /// The camera, or a ParseError at what is wrong with it. `end` is the end of the file.
  Camera finish(NffInput& input, std::string_view end) const;

 private:
  void begin(std::string_view word, NffInput& input);
  void read_angle(NffInput& input);
  void read_resolution(NffInput& input);
  void read_aperture(NffInput& input, LensHint& lens);

  Camera camera_;
  /// the words themselves; empty: not there
  std::string_view view_, from_, at_, up_, angle_, resolution_;
};

/// `l`, `light`, `al`, `la`, `ls` and `L`. Colors of lights that have none wait until all lights
/// are known.
class NffLights {
 public:
  explicit NffLights(SceneFile& file) : file_(file) {}
  void read_point(NffInput& input, std::string_view keyword);  ///< after `l`
  void read_light(NffInput& input, std::string_view keyword);  ///< after `light`
  void read_area(NffInput& input, std::string_view keyword);   ///< after `al`
  void read_shape(NffInput& input, std::string_view keyword);  ///< after `la` or `ls`
  /// After `L`: the emission of the polygons behind it, until an `L` of power 0.
  void read_glow(NffInput& input);
  bool glows() const { return glow_ != Float3{}; }
  /// After `p` or `pp`, while polygons shine: a parallelogram is an area light. False, and nothing
  /// is read, for any other polygon.
  bool read_glowing(NffInput& input, std::string_view keyword);
  void finish();

 private:
  static std::optional<Float3> color_on_line(NffInput& input);
  void add(NffInput& input, std::string_view keyword, const Light& light);
  void add_scaled(NffInput& input, std::string_view keyword, const Light& light);
  void finish_scaled();

  SceneFile& file_;
  std::vector<std::size_t> colorless_;
  Float3 glow_{};
  std::vector<std::size_t> scaled_;  ///< of Scene::lights: their powers are those of falling light
};

}  // namespace grelha
