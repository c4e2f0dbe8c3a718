#pragma once
// Terminal output and exit statuses.

#include <string>

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

}  // namespace grelha
