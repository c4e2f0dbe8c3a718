#pragma once

#include <span>
#include <string_view>

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

}  // namespace grelha
