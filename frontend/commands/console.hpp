#pragma once
// Terminal output and exit statuses.

#include <cstddef>
#include <functional>
#include <string>

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Exit statuses. Beyond kSignalled: the number of the signal that stopped the program. kNotMet:
/// with --strict, a picture is written and does not meet its --error.
inline constexpr int kOk = 0, kFileFailed = 1, kBadInput = 2, kNotMet = 3, kSignalled = 128;

// All output passes through printed(), so no file name reaches a terminal unescaped.

/// Writes a line to stderr.
void warn(const std::string& line);

/// Writes results to stdout. Throws FileError when they cannot be written.
void print(const std::string& text);

/// Writes text to stdout, or to stderr where stdout has the results.
void report_line(const std::string& text, bool results_on_stdout);

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
