#pragma once
// The man page and the shells' completions.

#include <string>
#include <vector>

#include "frontend/cli/help.hpp"

namespace grelha {

std::string man_page(const std::vector<CommandHelp>& commands);
std::string bash_completion(const std::vector<CommandHelp>& commands);
std::string zsh_completion(const std::vector<CommandHelp>& commands);
std::string fish_completion(const std::vector<CommandHelp>& commands);

}  // namespace grelha
