#pragma once
// Several scenes in one command: which files, and where their pictures go.

#include <string>
#include <vector>

#include "frontend/commands/commands.hpp"

namespace grelha {

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
