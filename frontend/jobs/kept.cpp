#include "frontend/jobs/kept.hpp"

#include <cstdlib>
#include <filesystem>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"

namespace grelha {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSavedNames = 10;

/// The picture's name, or the one it would have in this folder.
std::string picture_name(const RenderCommand& command) {
  if (command.image != kStdout && !is_special_file(command.image))
    return command.image;
  return default_image(command.scene, format_of(command.image, command.format));
}

bool path_exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

constexpr std::string_view kFreshFolder = "grelha-XXXXXX";  // X: any letter or digit

}  // namespace

void remove_kept(const std::string& work) {
  std::error_code none;
  fs::remove(work, none);
  const fs::path folder = fs::absolute(work, none).parent_path();
  const std::string name = folder.filename().string();
  if (name.size() == kFreshFolder.size() && name.starts_with(kFreshFolder.substr(0, 7)))
    fs::remove(folder, none);  // where it is empty
}

SavedNames saved_names(const RenderCommand& command,
                       const std::function<bool(const std::string&)>& fits) {
  const fs::path name = picture_name(command);
  const auto format = format_of(name.string(), command.format);
  SavedNames names;
  for (int i = 0; i < kMaxSavedNames; ++i) {
    const std::string stem = (name.parent_path() / name.stem()).string() + ".partial" +
                             (i == 0 ? "" : std::to_string(i));
    names.picture = format ? stem + '.' + std::string(ending_of(*format)) : "";
    names.work = stem + ".grelha";
    if (!path_exists(names.work) || fits(names.work))
      return names;
  }
  return {};
}

std::string write_fallback(const std::string& work,
                           const std::function<void(const std::string&)>& write) {
  std::error_code none;
  const fs::path own = fs::absolute(work, none).parent_path(), name = fs::path(work).filename();
  // a new folder, into which no other user can have put a file
  std::string fresh = (fs::temp_directory_path(none) / kFreshFolder).string();
  const bool is_fresh = mkdtemp(fresh.data()) != nullptr;
  for (const fs::path& folder : {fs::path(is_fresh ? fresh : ""), fs::current_path(none)}) {
    const fs::path target = folder / name;
    if (folder.empty() || path_exists(target) || fs::equivalent(folder, own, none))
      continue;
    try {
      write(target.string());
      return target.string();
    } catch (const FileError&) {  // there is no room either
      fs::remove(fresh, none);    // where it is empty
    }
  }
  return "";
}

}  // namespace grelha
