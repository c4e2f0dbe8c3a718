#pragma once
// What a stopped render leaves beside the place of its picture: the picture so far, and what the
// same command goes on from.

#include <functional>
#include <string>

#include "frontend/commands/commands.hpp"

namespace grelha {

/// `dir/x.png` gives `dir/x.partial.png`; empty for a .grelha. What goes to stdout or a device is
/// named after the scene.
std::string partial_picture(const RenderCommand& command);

/// `dir/x.png.partial`, or with a number behind it where other pictures are kept: the first name
/// that nothing has, or that `fits`. Empty when there is none.
std::string kept_name(const RenderCommand& command,
                      const std::function<bool(const std::string&)>& fits);

}  // namespace grelha
