#include "frontend/cli/console.hpp"

#include <iostream>

#include "frontend/files/parse_error.hpp"

namespace grelha {

void warn(const std::string& line) {
  std::cerr << line << '\n';
}

void print(const std::string& text) {
  std::cout << text << std::flush;
  if (!std::cout)
    throw FileError("stdout", "cannot write");
}

void tell(const std::string& text, bool results_on_stdout) {
  if (results_on_stdout)
    std::cerr << text;
  else
    print(text);
}

}  // namespace grelha
