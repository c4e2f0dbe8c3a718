#pragma once
// Command lines as text.

#include <sstream>
#include <string>
#include <vector>

#include "frontend/cli/command_line.hpp"

namespace grelha::test {

inline Command parse(const std::string& line) {
  std::vector<std::string> words{"grelha"};
  std::istringstream in(line);
  for (std::string word; in >> word;)
    words.push_back(word);
  std::vector<const char*> argv;
  for (const auto& word : words)
    argv.push_back(word.c_str());
  return parse_command(int(argv.size()), argv.data());
}

inline std::string error_of(const std::string& line) {
  try {
    parse(line);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace grelha::test
