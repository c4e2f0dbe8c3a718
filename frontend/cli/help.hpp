#pragma once
// The commands and the options for users as data, taken from options.cpp. --help, the man page and
// the completions of bash are generated from it.

#include <string>
#include <vector>

namespace grelha {

struct OptionHelp {
  std::vector<std::string> names;  ///< "-o", "--output"
  /// the value in the usage line: FILE, or words with | between them; empty for a switch
  std::string placeholder;
  std::string text;
};

struct CommandHelp {
  std::string name, text;
  std::string usage;  ///< the arguments behind the command: "SCENE..."
  std::vector<OptionHelp> options;
  std::string footer;  ///< examples, exit status; lines
  /// Returns whether --help shows the option, or only --help-all, the man page and the completions.
  bool prints(const OptionHelp& option) const;
};

std::string join(const std::vector<std::string>& words, const char* between = " ");

/// At most 80 columns wide; `all`: with the options that --help leaves out.
std::string help_text(const CommandHelp& command, bool all);
/// Help of the program itself; `all`: with everything of every command.
std::string program_help(const std::vector<CommandHelp>& commands, bool all);

std::string man_page(const std::vector<CommandHelp>& commands);
std::string bash_completion(const std::vector<CommandHelp>& commands);

}  // namespace grelha
