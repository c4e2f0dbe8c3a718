#include "frontend/cli/help.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace grelha {
namespace {

constexpr std::size_t kColumns = 80, kIndent = 22;

/// The options asked for most; a command with few options shows them all.
constexpr std::size_t kFewOptions = 10;
constexpr std::array<std::string_view, 11> kCommon{"--output",
                                                   "--size",
                                                   "--samples",
                                                   "--error",
                                                   "--aa",
                                                   "--shadows",
                                                   "--lens",
                                                   "--glossy",
                                                   "--orbit",
                                                   "--json",
                                                   "--threads"};

/// `left` in its column and `text` behind it, wrapped.
std::string row(std::string left, const std::string& text) {
  std::string out;
  if (left.size() + 2 > kIndent) {
    out = left + '\n';
    left.clear();
  }
  std::string line = left + std::string(kIndent - left.size(), ' ');
  std::istringstream words(text);
  bool fresh = true;
  for (std::string w; words >> w;) {
    if (!fresh && line.size() + 1 + w.size() > kColumns) {
      out += line + '\n';
      line.assign(kIndent, ' ');
      fresh = true;
    }
    line += (fresh ? "" : " ") + w;
    fresh = false;
  }
  return out + line + '\n';
}

std::string row(const OptionHelp& o) {
  return row((o.names.front().starts_with("--") ? "      " : "  ") + join(o.names, ", ") +
                 (o.placeholder.empty() ? "" : " " + o.placeholder),
             o.text);
}

}  // namespace

std::string join(const std::vector<std::string>& words, const char* between) {
  std::string all;
  for (const std::string& w : words)
    all += (all.empty() ? "" : between) + w;
  return all;
}

bool CommandHelp::prints(const OptionHelp& option) const {
  const auto is_common = [](const std::string& n) { return std::ranges::count(kCommon, n) > 0; };
  return options.size() <= kFewOptions || std::ranges::any_of(option.names, is_common);
}

std::string help_text(const CommandHelp& command, bool all) {
  std::string text = "Usage: grelha " + command.name +
                     (command.usage.empty() ? "" : " " + command.usage) + " [OPTIONS]\n" +
                     command.text + "\n\n";
  std::size_t hidden = 0;
  for (const OptionHelp& o : command.options) {
    if (all || command.prints(o))
      text += row(o);
    else
      ++hidden;
  }
  if (hidden > 0)
    text += row("      --help-all", std::to_string(hidden) + " more options");
  return text + (command.footer.empty() ? "" : "\n" + command.footer + '\n');
}

std::string program_help(const std::vector<CommandHelp>& commands, bool all) {
  std::string text =
      "Usage: grelha COMMAND [OPTIONS]\nData-oriented SIMD ray tracer on a uniform grid.\n\n";
  for (const CommandHelp& c : commands)
    text += row("  " + c.name, c.text);
  text += row("  -V, --version", "say which version this is");
  text +=
      "\nExamples:\n"
      "  grelha render scenes/data/balls.nff -o balls.png\n"
      "  grelha info scenes/data/balls.nff\n"
      "  grelha scene mount --size 7 -o mount.nff\n"
      "  grelha compare a.png b.png --max-rmse 0.01\n"
      "  grelha merge upper.grelha lower.grelha -o whole.png\n"
      "Each command has its own --help and --help-all. Exit status: 0; 1 when reading\n"
      "or writing a file fails; 2 for bad usage, a scene that cannot be one, or a\n"
      "warning with --strict; 129, 130 and 143 when stopped by SIGHUP, SIGINT and\n"
      "SIGTERM.\n";
  if (all)
    for (const CommandHelp& c : commands)
      (text += '\n') += help_text(c, true);
  return text;
}

}  // namespace grelha
