#pragma once
// What a stopped render leaves beside the place of its picture: the picture so far, and what the
// same command goes on from.

#include <functional>
#include <string>

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Two files of one name. What goes to stdout or a device is named after the scene.
struct KeptNames {
  std::string work;     ///< `dir/x.partial.grelha` of `dir/x.png`; empty: there is no free name
  std::string picture;  ///< `dir/x.partial.png`; empty for a .grelha
};

/// With a number behind `partial` where other pictures are kept: the first name that nothing has,
/// or whose work `fits`.
KeptNames kept_names(const RenderCommand& command,
                     const std::function<bool(const std::string&)>& fits);

/// Has the work written in another folder, where the picture's has no room: one in the system's
/// folder for what is temporary, or the current one. Returns where, or "".
std::string write_elsewhere(const std::string& work,
                            const std::function<void(const std::string&)>& write);

}  // namespace grelha
