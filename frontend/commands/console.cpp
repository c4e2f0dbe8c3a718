#include "frontend/commands/console.hpp"

#include <iostream>

#include "frontend/files/parse_error.hpp"
#include "frontend/files/shown.hpp"

namespace grelha {

void warn(const std::string& line) {
  std::cerr << shown_on_a_line(line) << '\n';
}

void print(const std::string& text) {
  std::cout << shown(text) << std::flush;
  if (!std::cout)
    throw FileError("stdout", "cannot write");
}

void tell(const std::string& text, bool results_on_stdout) {
  if (results_on_stdout)
    std::cerr << shown(text);
  else
    print(text);
}

}  // namespace grelha
