#include "frontend/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grelha {

namespace {

constexpr int kBarWidth = 40;
constexpr std::chrono::milliseconds kRedraw{100};

std::string duration_text(double seconds) {
  const long long s = std::llround(std::min(seconds, 1e9));
  if (s < 60) return std::to_string(s) + " s";
  if (s < 3600) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
  return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) + " min";
}

}  // namespace

std::string progress_text(double share, double elapsed_s) {
  share = std::clamp(share, 0.0, 1.0);
  const int full = int(share * kBarWidth);
  const std::string percent = std::to_string(int(share * 100));
  std::string text = '[' + std::string(std::size_t(full), '#') + std::string(std::size_t(kBarWidth - full), '.') +
                     "] " + std::string(3 - std::min<std::size_t>(3, percent.size()), ' ') + percent + " %";
  if (share > 0) text += "  " + duration_text(elapsed_s * (1 - share) / share) + " left";
  return text;
}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share) {
  const auto now = Clock::now();
  if (!shown_ || now - last_ < kRedraw) return;
  last_ = now;
  drawn_ = true;
  const std::chrono::duration<double> elapsed = now - start_;
  const double as_from_zero = share > first_ ? elapsed.count() * share / (share - first_) : 0;
  std::fprintf(stderr, "\r%-6s %s\033[K", name_, progress_text(share, as_from_zero).c_str());
}

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace grelha
