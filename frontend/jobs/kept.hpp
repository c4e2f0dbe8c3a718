#pragma once
// Files that a stopped render leaves beside its picture: the unfinished picture, and the work from
// which the same command continues.

#include <functional>
#include <string>

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Two files with a common name. Those of a picture for stdout or a device are named after the
/// scene.
struct SavedNames {
  std::string work;     ///< `dir/x.partial.grelha` of `dir/x.png`; empty: there is no free name
  std::string picture;  ///< `dir/x.partial.png`; empty for a .grelha
};

/// Adds a number behind `partial` where other pictures are saved. Takes the first name that is free
/// or whose work `fits`.
SavedNames saved_names(const RenderCommand& command,
                       const std::function<bool(const std::string&)>& fits);

/// Writes the work to another folder if the picture's has no room: a new one in the system's
/// temporary folder, or the current folder. Returns the path, or "".
std::string write_fallback(const std::string& work,
                           const std::function<void(const std::string&)>& write);

/// Removes a file of saved work, and the folder that write_fallback() made for it.
void remove_kept(const std::string& work);

}  // namespace grelha
