#include "frontend/commands/outputs.hpp"

#include <unistd.h>

#include <filesystem>
#include <map>

#include "frontend/files/atomic_file.hpp"
#include "frontend/files/parse_error.hpp"
#include "frontend/images/image_file.hpp"

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

}  // namespace grelha
