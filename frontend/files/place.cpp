#include "frontend/files/place.hpp"

#include <sys/stat.h>

#include <filesystem>

namespace grelha {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as Linux follows

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

}  // namespace

std::string resolve_links(const std::string& path) {
  std::error_code error;
  fs::path at = fs::canonical(path, error);
  if (!error)
    return at.string();
  at = path;
  for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(at, error)); ++i) {
    const fs::path to = fs::read_symlink(at, error);
    // there, but by no name: what /dev/stdout leads to may be a pipe
    if (error || fs::exists(at, error))
      return path;
    at = to.is_absolute() ? to : folder_of(at) / to;
  }
  return at.string();
}

Location location_of(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) == 0)
    return {info.st_dev, info.st_ino, ""};
  const fs::path target = resolve_links(path);
  if (stat(folder_of(target).c_str(), &info) == 0)
    return {info.st_dev, info.st_ino, target.filename().string()};
  std::error_code ignored;
  return {0, 0, fs::absolute(target, ignored).lexically_normal().string()};
}

bool is_special_file(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

}  // namespace grelha
