#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "frontend/commands/commands.hpp"
#include "frontend/commands/console.hpp"

namespace grelha {

/// Writes warnings to stderr, and counts them for --strict.
class WarningLog {
 public:
  /// Must not outlive this.
  std::function<void(const std::string&)> reporting() {
    return [this](const std::string& line) { report_line(line); };
  }
  /// Throws UsageError where a warning is one too many.
  void check_none(const InputOptions& input) const {
    if (input.strict && count_ > 0)
      throw UsageError("--strict: expected no warning, found " + std::to_string(count_));
  }

 private:
  void report_line(const std::string& line) {
    ++count_;
    warn(line);
  }

  std::size_t count_ = 0;
};

}  // namespace grelha
