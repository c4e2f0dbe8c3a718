#include "frontend/jobs/kept.hpp"

#include <filesystem>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/place.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/jobs/partial.hpp"

namespace grelha {
namespace {

namespace fs = std::filesystem;

constexpr int kPlacesToKeep = 10;

/// The picture's name, or the one it would have in this folder.
std::string picture_name(const RenderCommand& command) {
  if (command.image != kStdout && !is_special_file(command.image))
    return command.image;
  return default_image(command.scene, format_of(command.image, command.format));
}

}  // namespace

std::string partial_picture(const RenderCommand& command) {
  const fs::path name = picture_name(command);
  const auto format = format_of(name.string(), command.format);
  if (!format)
    return "";
  return (name.parent_path() /
          (name.stem().string() + ".partial." + std::string(ending_of(*format))))
      .string();
}

std::string kept_name(const RenderCommand& command,
                      const std::function<bool(const std::string&)>& fits) {
  const std::string name = picture_name(command) + ".partial";
  for (int i = 0; i < kPlacesToKeep; ++i) {
    const std::string numbered = i == 0 ? name : name + std::to_string(i);
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(numbered, ignored)) || fits(numbered))
      return numbered;
  }
  return "";
}

}  // namespace grelha
