#pragma once
// The built program, run by a shell in a folder.

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace grelha::test {

/// A ball before a blue background, 24 x 16.
constexpr char kBall[] =
    "b 0 0 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 24 16\n"
    "l 5 5 5 1 1 1\nf 1 0 0 1 0 1 0 1\ns 0 0 0 1\n";

/// The program's immediate answer to a signal.
constexpr char kStopping[] = "grelha: stopping; once more ends it at once\n";

struct Outcome {
  int status;
  std::string out, err;
};

/// Runs the program inside `folder`. Its output goes to files elsewhere, so that the folder holds
/// what it wrote itself. `before`: of the shell's line, as `ulimit -f 8;`.
inline Outcome run(const TemporaryFolder& folder,
                   const std::string& arguments,
                   const std::string& before = "") {
  TemporaryFolder log;
  const std::string line = "cd '" + folder.path().string() + "' && " + before +
                           " '" GRELHA_PROGRAM "' " + arguments + " >'" + log.file("out") +
                           "' 2>'" + log.file("err") + "' </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, log.read("out"), log.read("err")};
}

}  // namespace grelha::test
