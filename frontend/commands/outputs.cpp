#include "frontend/commands/outputs.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"

#include <unistd.h>

namespace grelha {
namespace {

struct Use {
  std::string option, file;
  const RenderCommand* command;
};

[[noreturn]] void reject(const Use& first, const Use& second) {
  if (first.command == second.command)
    throw UsageError(second.option + " and " + first.option + ": expected two files, found \"" +
                     first.file + "\" twice");
  throw UsageError(second.option + ": " + first.command->scene + " and " + second.command->scene +
                   " would both be written to " + second.file +
                   "; {} in a name stands for the scene's");
}

void make_folder(const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::create_directories(folder, error) && error)
    throw FileError(folder, "cannot make this folder: " + error.message());
}

}  // namespace

std::vector<Output> outputs_of(const RenderCommand& command) {
  std::vector<Output> found;
  each_output(command, [&](const char* option, const std::string& file) {
    if (!file.empty())
      found.emplace_back(option, file);
  });
  return found;
}

void prepare_outputs(const RenderCommand& command) {
  check_no_terminal(command.image);
  for (const std::string& folder : command.folders)
    make_folder(folder);
  for (const auto& [option, file] : outputs_of(command))
    check_writable(file, option == "--checkpoint");
}

void check_no_terminal(const std::string& file) {
  if (file == kStdout && isatty(STDOUT_FILENO) == 1)
    throw UsageError("-o -: stdout is a terminal: expected a pipe or a file behind it");
}

void check_not_read(const std::vector<Output>& outputs, const std::vector<std::string>& read) {
  std::map<Location, std::string> locations;
  for (const std::string& file : read)
    locations.try_emplace(location_of(file), file);
  for (const auto& [option, file] : outputs) {
    const auto found = locations.find(location_of(file));
    if (found == locations.end() || is_special_file(file))
      continue;
    throw UsageError(option + ": expected another file than " + found->second +
                     ", which is read, found \"" + file + '"');
  }
}

void check_distinct(const std::vector<RenderCommand>& commands) {
  std::map<Location, Use> written;
  for (const RenderCommand& command : commands)
    for (const auto& [option, file] : outputs_of(command)) {
      if (is_special_file(file))
        continue;
      const Use use{option, file, &command};
      const auto [other, fresh] = written.try_emplace(location_of(file), use);
      if (!fresh)
        reject(other->second, use);
    }
}

void check_image_size(std::optional<ImageFormat> format, int width, int height, bool alpha) {
  if (format && !image_fits(*format, width, height, alpha ? 4 : 3))
    throw UsageError("a picture of " + std::to_string(width) + 'x' + std::to_string(height) +
                     " is too large for .png and .hdr, write " +
                     (alpha ? "an .exr" : "a .pfm or .exr"));
}

namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

bool ends_with_any(std::string name, std::initializer_list<std::string_view> extensions) {
  std::transform(name.begin(), name.end(), name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  });
  if (name.ends_with(".gz"))
    name.resize(name.size() - 3);
  return std::any_of(
      extensions.begin(), extensions.end(), [&](std::string_view e) { return name.ends_with(e); });
}

struct FolderFiles {
  Names scenes, meshes;
};

FolderFiles files_in(const std::string& folder) {
  FolderFiles found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().string();
    if (it->is_fifo(error))
      continue;  // reading a FIFO blocks until a writer comes: it must be named itself
    if (ends_with_any(name, {".nff", ".p3f"}))
      found.scenes.push_back(name);
    if (ends_with_any(name, {".ply", ".stl"}))
      found.meshes.push_back(name);
  }
  if (error)
    throw FileError(folder, "cannot read: " + error.message());
  return found;
}

/// Returns the scenes in a folder, or its meshes if it has no scene: a mesh beside a scene is
/// mostly part of that scene.
Names files_of(const std::string& folder) {
  auto [scenes, meshes] = files_in(folder);
  Names& files = scenes.empty() ? meshes : scenes;
  if (files.empty())
    throw FileError(folder, "no .nff, .p3f, .ply or .stl file in this folder");
  std::sort(files.begin(), files.end());
  return files;
}

/// What {} stands for.
std::string name_of(const std::string& scene) {
  return fs::path(default_image(scene)).stem().string();
}

std::string image_for(const std::string& scene,
                      const std::string& output,
                      std::optional<ImageFormat> format) {
  if (output.empty())
    return default_image(scene, format);
  if (is_folder(output))
    return (fs::path(output) / default_image(scene, format)).string();
  return output;
}

}  // namespace

Names scene_files(const Names& arguments) {
  Names files;
  for (const std::string& argument : arguments) {
    if (!is_folder(argument))
      files.push_back(argument == "-" ? "/dev/stdin" : argument);
    else
      for (std::string& file : files_of(argument))
        files.push_back(std::move(file));
  }
  return files;
}

std::vector<std::string> left_out(const Names& arguments) {
  Names lines;
  for (const std::string& folder : arguments) {
    if (!is_folder(folder))
      continue;
    auto [scenes, meshes] = files_in(folder);
    std::erase_if(
        meshes, [&](const auto& m) { return std::ranges::find(arguments, m) != arguments.end(); });
    if (!scenes.empty() && !meshes.empty())
      lines.push_back(
          folder + ": left out " + std::to_string(meshes.size()) +
          " .ply or .stl beside scenes, whose parts they may be: name what is a scene itself");
  }
  return lines;
}

std::vector<RenderCommand> commands_for(const RenderCommand& command) {
  const Names scenes = scene_files(command.scenes);
  std::vector<RenderCommand> all;
  for (const std::string& scene : scenes) {
    RenderCommand one = command;
    one.scenes = {scene};
    one.scene = scene;
    one.image = image_for(scene, command.image, command.format);
    if (command.turntable == 0)  // else {} stands for the view
      one.image = filled_in(one.image, name_of(scene));
    one.work.save_until_end = scenes.size() > 1;
    const auto want_folder = [&one](const std::string& pattern, const std::string& file) {
      const fs::path folder = fs::path(file).parent_path();
      if (!folder.empty() &&
          (pattern.ends_with('/') || pattern.find(kPlaceholder) != std::string::npos))
        one.folders.push_back(folder.string());
    };
    want_folder(command.image, one.image);
    each_output(one, [&](const char*, std::string& file) {
      const std::string pattern = file;
      if (command.turntable == 0)
        file = filled_in(file, name_of(scene));
      want_folder(pattern, file);
    });
    check_not_read(outputs_of(one), scenes);
    all.push_back(std::move(one));
  }
  check_distinct(all);
  return all;
}

}  // namespace grelha
