// Part of the build: writes the man page and the completions into a folder.
#include "frontend/cli/command_line.hpp"
#include "frontend/cli/help.hpp"

#include <cstdio>
#include <fstream>

int main(int argc, char** argv) {
  if (argc != 2)
    return std::fputs("usage: grelha_pages FOLDER\n", stderr), 2;
  const auto commands = grelha::all_commands();
  const std::string folder = std::string(argv[1]) + '/';
  bool written = true;
  const auto write = [&](const char* name, const std::string& text) {
    written &= bool(std::ofstream(folder + name) << text << std::flush);
  };
  write("grelha.1", man_page(commands));
  write("grelha.bash", bash_completion(commands));
  return written ? 0 : 1;
}
