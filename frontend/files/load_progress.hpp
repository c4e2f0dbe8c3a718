#pragma once
// Progress of reading a scene.

#include <algorithm>
#include <cstddef>
#include <functional>

#include "grelha/render.hpp"

namespace grelha {

/// The share that is read. It never falls, even when a scene names another large file near its end.
class LoadProgress {
 public:
  /// `report` receives the share done and returns false to stop; it may be empty.
  explicit LoadProgress(const std::function<bool(double)>& report) : report_(report) {}

  /// Adds to the bytes still to come; a negative number subtracts.
  void expect(double bytes) { left_ += bytes; }
  /// Counts bytes as done. Throws Stopped.
  void done(double bytes) {
    share_ += (1 - share_) * (left_ > bytes ? bytes / left_ : 1);
    left_ = std::max(0., left_ - bytes);
    waiting();
  }
  /// Reports the same share again, while waiting. Throws Stopped.
  void waiting() const {
    if (report_ && !report_(share_))
      throw Stopped();
  }
  void finish() { done(left_); }

 private:
  const std::function<bool(double)>& report_;
  double share_ = 0, left_ = 0;
};

inline constexpr double kParsing = 5;  ///< times as long as reading the bytes that are parsed

/// Reports bytes as they are parsed, a million at a time. A small file that names a large one
/// reports nothing.
class ParseProgress {
 public:
  ParseProgress(LoadProgress* progress, const char* begin)
      : progress_(progress), reported_(begin) {}
  void at(const char* here) {
    constexpr std::ptrdiff_t kStride = 1 << 20;
    while (progress_ && here - reported_ >= kStride) {
      reported_ += kStride;
      progress_->done(kParsing * double(kStride));
    }
  }

 private:
  LoadProgress* progress_;
  const char* reported_;
};

}  // namespace grelha
