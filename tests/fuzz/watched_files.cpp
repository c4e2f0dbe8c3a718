#include "tests/fuzz/watched_files.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstdio>

#include "tests/fuzz/target.hpp"

namespace {

std::filesystem::path watched;  // canonical; empty: no file is watched
std::size_t looks = 0;

void look_at(const char* path) {
  if (watched.empty())
    return;
  ++looks;
  std::error_code error;
  const std::filesystem::path file = std::filesystem::weakly_canonical(path, error);
  const bool inside =
      !error && std::mismatch(watched.begin(), watched.end(), file.begin(), file.end()).first ==
                    watched.end();
  grelha::fuzz::promise(inside, std::string("no file outside the scene's folder, but ") + path);
}

}  // namespace

extern "C" {
std::FILE* __real_fopen(const char* path, const char* mode);
std::FILE* __wrap_fopen(const char* path, const char* mode) {
  if (mode[0] == 'r')
    look_at(path);  // libFuzzer writes what it found from within
  return __real_fopen(path, mode);
}
int __real_stat(const char* path, struct stat* about);
int __wrap_stat(const char* path, struct stat* about) {
  look_at(path);
  return __real_stat(path, about);
}
}

namespace grelha::fuzz {

WatchedFiles::WatchedFiles(const std::filesystem::path& folder) {
  watched = std::filesystem::canonical(folder);
  looks = 0;
}
WatchedFiles::~WatchedFiles() {
  watched.clear();
  promise(looks > 0, "files are opened where it is watched: by fopen() and stat()");
}

}  // namespace grelha::fuzz
