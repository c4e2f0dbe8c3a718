#pragma once

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Says how far two pictures lie apart, and writes the pictures of that. Returns the exit status.
int compare_images(const CompareCommand& command);

}  // namespace grelha
