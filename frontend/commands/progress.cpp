#include "frontend/commands/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace grelha {

namespace {

constexpr int kBarWidth = 40, kLeastBar = 5;
constexpr int kDefaultWidth = 80;
constexpr std::size_t kNameWidth = 6;  ///< of the longest: "render"
constexpr std::chrono::milliseconds kRedraw{100};

std::string duration_text(double seconds) {
  const long long s = std::llround(std::min(seconds, 1e9));
  if (s < 60)
    return std::to_string(s) + " s";
  if (s < 3600)
    return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
  return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) + " min";
}

/// Columns for the `^C` that a terminal shows behind the bar, and the last one. It stays free, for
/// some terminals go on to the next line when it is written.
constexpr int kFreeColumns = 3;

/// Asked anew for every line: the window may have been resized.
int stderr_width() {
  struct winsize size {};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return (known ? size.ws_col : kDefaultWidth) - kFreeColumns;
}

}  // namespace

std::string progress_text(const std::string& name, double share, double elapsed_s, int columns) {
  share = std::clamp(share, 0.0, 1.0);
  const std::string number = std::to_string(int(share * 100));
  const std::string percent =
      std::string(3 - std::min<std::size_t>(3, number.size()), ' ') + number + " %";
  std::string left =
      share > 0 ? "  " + duration_text(elapsed_s * (1 - share) / share) + " left" : "";
  std::string named = name + std::string(kNameWidth - std::min(kNameWidth, name.size()), ' ') + ' ';
  const auto columns_left = [&] {
    return columns - int(named.size() + percent.size() + left.size());
  };
  if (columns_left() < 0)
    left.clear();
  if (columns_left() < 0)
    named.clear();
  const int width = std::min(kBarWidth, columns_left() - int(std::string_view("[] ").size()));
  if (width < kLeastBar)
    return named + percent + left;
  const int full = int(share * width);
  return named + '[' + std::string(std::size_t(full), '#') +
         std::string(std::size_t(width - full), '.') + "] " + percent + left;
}

ProgressBar::~ProgressBar() {
  if (printed_)
    std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share) {
  const auto now = Clock::now();
  if (!visible_ || now - last_ < kRedraw)
    return;
  last_ = now;
  printed_ = true;
  const std::chrono::duration<double> elapsed = now - start_;
  const double as_from_zero = share > first_ ? elapsed.count() * share / (share - first_) : 0;
  std::fprintf(
      stderr, "\r%s\033[K", progress_text(name_, share, as_from_zero, stderr_width()).c_str());
}

bool stderr_is_terminal() {
  const char* const kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

}  // namespace grelha
