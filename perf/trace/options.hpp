#pragma once
// What `trace` was asked for: scenes, kinds of rays, sizes.

#include <cstddef>
#include <string>
#include <vector>

namespace grelha::perf {

/// A scene of the table.
struct Row {
  std::string name, file;  ///< file, below the folder of real scenes; if it is not there:
  std::string generator;
  int size;
};

struct Options {
  std::vector<Row> rows;
  std::vector<std::size_t> kinds;
  int size = 1024, rounds = 5;
  std::string scenes = GRELHA_SHARED_SCENES;
};

/// False: a word is not understood.
bool parse(int argc, char** argv, Options& options);

}  // namespace grelha::perf
