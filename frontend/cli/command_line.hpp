#pragma once

#include <vector>

#include "frontend/cli/help.hpp"
#include "frontend/commands/commands.hpp"

namespace grelha {

/// Throws UsageError.
Command parse_command(int argc, const char* const* argv);

/// Every command, as parse_command() knows it.
std::vector<CommandHelp> all_commands();

}  // namespace grelha
