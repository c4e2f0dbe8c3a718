#pragma once
// Every file the readers look at, seen on its way: the linker puts ours in place of fopen() and
// stat() (CMakeLists.txt).

#include <filesystem>

namespace grelha::fuzz {

/// While one of these lives a look at a file whose place, all links followed, is not in the folder
/// is a broken promise; and so is one that ends without any, for then the readers have other ways
/// now.
class WatchedFiles {
 public:
  explicit WatchedFiles(const std::filesystem::path& folder);
  ~WatchedFiles();
  WatchedFiles(const WatchedFiles&) = delete;
};

}  // namespace grelha::fuzz
