#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "frontend/files/parse_error.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {

inline constexpr std::string_view kNulIsSpace = "the text holds NUL bytes, which count as blanks";

/// Prints each kind of warning once, and at most kMost kinds, so that the output for a file of
/// noise stays readable. Where there are more, a last line says so.
class WarningList {
 public:
  explicit WarningList(const Warn& warn) : warn_(warn) {}
  /// Returns whether `kind` is new: only then is the (costlier) message worth making.
  bool first(std::string_view kind) {
    if (is_cut_)
      return false;
    const std::string key(kind.substr(0, 64));
    if (kinds_.size() < kMost)
      return kinds_.insert(key).second;
    is_cut_ = !kinds_.contains(key);
    if (is_cut_)
      add_line(file_ + ": warning: more than " + std::to_string(kMost) +
               " kinds of warnings; no more follow");
    return false;
  }
  void add_line(const Position& at, std::string_view message) {
    file_ = at.file;
    add_line(at.text() + ": warning: " + std::string(message));
  }
  void add_line(const std::string& line) {
    if (warn_)
      warn_(line);
  }

 private:
  static constexpr std::size_t kMost = 20;
  const Warn& warn_;
  std::set<std::string> kinds_;
  std::string file_;  ///< of the last warning
  bool is_cut_ = false;
};

}  // namespace grelha
