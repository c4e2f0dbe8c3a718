#pragma once
// How far reading is.

#include <algorithm>
#include <cstddef>
#include <functional>

#include "grelha/render.hpp"

namespace grelha {

/// A share that never falls, though a scene may come to name another large file when it seemed all
/// but read.
class LoadProgress {
 public:
  /// `report` is told the share done, and returns false to stop; empty: nobody asks.
  explicit LoadProgress(const std::function<bool(double)>& report) : report_(report) {}

  /// So much more is to come, or less.
  void expect(double bytes) { left_ += bytes; }
  /// So much of it is done. Throws Stopped.
  void done(double bytes) {
    share_ += (1 - share_) * (left_ > bytes ? bytes / left_ : 1);
    left_ = std::max(0., left_ - bytes);
    waiting();
  }
  /// Nothing is done. Throws Stopped.
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

/// Tells of bytes as they are parsed, a million at a time: of a small file that names a large one,
/// nothing.
class ParseProgress {
 public:
  ParseProgress(LoadProgress* progress, const char* begin) : progress_(progress), told_(begin) {}
  void at(const char* here) {
    constexpr std::ptrdiff_t kStride = 1 << 20;
    while (progress_ && here - told_ >= kStride) {
      told_ += kStride;
      progress_->done(kParsing * double(kStride));
    }
  }

 private:
  LoadProgress* progress_;
  const char* told_;
};

}  // namespace grelha
