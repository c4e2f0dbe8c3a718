#pragma once

#include "frontend/commands/commands.hpp"

namespace grelha {

/// Throws UsageError.
Command parse_command(int argc, const char* const* argv);

}  // namespace grelha
