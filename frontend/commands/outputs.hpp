#pragma once
// The scenes a command reads, the files it writes, and which files they must not be.

#include <string>
#include <utility>
#include <vector>

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Calls `use(option, file)` for every file a render may write, named or not.
template <class Command, class Use>
void each_output(Command& command, const Use& use) {
  use("-o", command.image);
  use("--stats", command.stats);
  use("--samples-map", command.samples_map);
  use("--error-map", command.error_map);
  use("--checkpoint", command.work.checkpoint);
}

/// An option and the file it names.
using Output = std::pair<std::string, std::string>;

/// Returns the outputs that are named.
std::vector<Output> outputs_of(const RenderCommand& command);

/// Creates missing folders, and throws now the errors of writing that would otherwise come after a
/// long render, as far as they can be known.
void prepare_outputs(const RenderCommand& command);

/// Throws UsageError when binary data would go to a terminal.
void check_no_terminal(const std::string& file);

/// Throws UsageError when one of the outputs is a file that is read, by whatever name.
void check_not_read(const std::vector<Output>& outputs, const std::vector<std::string>& read);

/// Throws UsageError when two outputs are one file, be it of one command or of two.
void check_distinct(const std::vector<RenderCommand>& commands);

/// Throws UsageError when a picture of this size is too large for its format.
void check_image_size(std::optional<ImageFormat> format, int width, int height, bool alpha = false);

/// Lists the files that the arguments name. A file names itself (- is /dev/stdin). A folder names
/// its .nff and .p3f files or, where it has none, its .ply and .stl files (each also .gz), by name.
/// Throws FileError for a folder that cannot be read or has none.
std::vector<std::string> scene_files(const std::vector<std::string>& arguments);

/// A line for each folder where scene_files() leaves out meshes beside scenes.
std::vector<std::string> left_out(const std::vector<std::string>& arguments);

/// One command for each scene, with the names of its files: -o may be a folder, and {} in a name
/// stands for the scene's. Throws UsageError when a file would be written that is read, or one
/// twice.
std::vector<RenderCommand> commands_for(const RenderCommand& command);

}  // namespace grelha
