#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "frontend/files/text.hpp"
#include "frontend/scene/scene_file.hpp"
#include "frontend/scene/warnings.hpp"
#include "grelha/geometry.hpp"

namespace grelha {

/// A number and the word it was read from.
struct NumberWord {
  float value = 0;
  std::string_view word;
};

/// Reads the words of an NFF file as the values of an entity. Any other word throws a ParseError
/// there. `what` completes "expected a number for ...".
class NffInput {
 public:
  NffInput(Words& all_words, WarningList& all_warnings, const Frame& of_scene)
      : words(all_words), warning_list(all_warnings), frame(of_scene) {}

  /// infinite and NaN pass: the caller drops what cannot be drawn
  float number(const char* what);
  float bounded(const char* what);  ///< for what cannot be dropped: camera, lights, materials
  Float3 point(const char* what);   ///< three numbers, without checks
  Float3 bounded_point(const char* what);
  /// A position or a length, converted to the frame of the scene.
  Float3 framed_point(const char* what);
  Float3 bounded_framed_point(const char* what);
  float length(const char* what);
  double wide_number(const char* what);  ///< in the file's own frame
  /// A count of things that take at least `least_bytes` each, checked against the rest of the file.
  std::size_t count(const char* what, std::size_t least_bytes);

  /// All numbers left on this line, then whole further lines as long as fewer than `enough` were
  /// found and numbers follow. Every value is bounded.
  std::vector<NumberWord> numbers(std::size_t enough, const char* what);

  Position position(std::string_view word) const { return words.position(word); }
  [[noreturn]] void fail(std::string_view word, const std::string& expected) const;
  void warn_once(std::string_view kind, std::string_view word, const std::string& message);

  Words& words;
  WarningList& warning_list;
  const Frame frame;

 private:
  void check_bounds(std::string_view word, float value, const char* what) const;
};

}  // namespace grelha
