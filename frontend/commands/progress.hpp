#pragma once

#include <chrono>
#include <string>

namespace grelha {

/// `render [#####.....]  50 %  3 s left`: the text of a bar after `elapsed_s` seconds with `share`
/// (0 to 1) done. At most `columns` wide: the bar shrinks first, then time and name are left out.
std::string progress_text(const std::string& name, double share, double elapsed_s, int columns);

/// A bar on stderr that redraws itself in place a few times a second, as wide as the terminal is
/// then, and wipes itself off at the end.
class ProgressBar {
 public:
  /// `share`: the share done before the bar began. `name`: of the task.
  explicit ProgressBar(bool visible, double share = 0, const char* name = "render")
      : visible_(visible), first_(share), name_(name) {}
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(double share);

 private:
  using Clock = std::chrono::steady_clock;
  const bool visible_;
  const double first_;
  const char* const name_;
  bool printed_ = false;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// Returns whether stderr is a terminal that can redraw a line.
bool stderr_is_terminal();

}  // namespace grelha
