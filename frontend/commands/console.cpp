#include "frontend/commands/console.hpp"

#include <iostream>

#include "frontend/files/parse_error.hpp"
#include "frontend/files/text.hpp"

namespace grelha {

void warn(const std::string& line) {
  std::cerr << printable_line(line) << '\n';
}

void print(const std::string& text) {
  std::cout << printable_text(text) << std::flush;
  if (!std::cout)
    throw FileError("stdout", "cannot write");
}

void report_line(const std::string& text, bool results_on_stdout) {
  if (results_on_stdout)
    std::cerr << printable_text(text);
  else
    print(text);
}

}  // namespace grelha
