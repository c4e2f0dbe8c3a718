#pragma once
// The man page and the completions of bash.

#include <string>
#include <vector>

#include "frontend/cli/help.hpp"

namespace grelha {

std::string man_page(const std::vector<CommandHelp>& commands);
std::string bash_completion(const std::vector<CommandHelp>& commands);

}  // namespace grelha
