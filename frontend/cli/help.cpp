// Generates the man page and the shell completions from the data of help.hpp.

#include "frontend/cli/help.hpp"

#include <algorithm>
#include <array>
#include <iterator>
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

namespace {

std::string replace_all(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

/// Escapes text for roff: hyphens that can be copied, and no line that starts a request.
std::string roff(const std::string& text) {
  const std::string out = replace_all(replace_all(text, "\\", "\\e"), "-", "\\-");
  const bool reads_as_command = out.starts_with('.') || out.starts_with('\'');
  return (reads_as_command ? "\\&" : "") + out;
}

std::vector<std::string> value_words(const OptionHelp& o) {
  std::vector<std::string> words;
  if (o.placeholder.find('|') == std::string::npos)
    return words;
  std::istringstream in(o.placeholder);
  // of area:N area:, and nothing of RADIUS
  for (std::string w; std::getline(in, w, '|');)
    if (w[0] < 'A' || w[0] > 'Z')
      words.push_back(w.substr(0, std::min(w.find(':'), w.size() - 1) + 1));
  return words;
}

std::string names_of(const std::vector<CommandHelp>& commands) {
  std::vector<std::string> names;
  std::ranges::transform(commands, std::back_inserter(names), &CommandHelp::name);
  return join(names);
}

constexpr const char* kMade = "made by the build from the options themselves";

}  // namespace

std::string man_page(const std::vector<CommandHelp>& commands) {
  std::string text =
      ".\\\" " + std::string(kMade) +
      "\n.TH GRELHA 1 \"" GRELHA_DATE "\" \"grelha " GRELHA_VERSION
      "\" \"User Commands\"\n"
      ".SH NAME\ngrelha \\- data\\-oriented SIMD ray tracer on a uniform grid\n.SH SYNOPSIS\n";
  for (const CommandHelp& c : commands)
    text += ".B grelha " + c.name + "\n.RI \"" + roff(c.usage) + " [\" OPTIONS ]\n.br\n";
  text +=
      ".B grelha\n.RB [ \\-\\-help | \\-\\-help\\-all | \\-V | \\-\\-version ]\n"
      ".SH DESCRIPTION\nRenders scenes in NFF and the dialects built on it, and PLY and STL "
      "meshes, each also gzipped, to PNG, Radiance HDR, PFM or OpenEXR.\n"
      "Neither the number of threads nor the processor changes a bit of a picture.\n";
  for (const CommandHelp& c : commands) {
    std::string upper = c.name;
    std::transform(upper.begin(), upper.end(), upper.begin(), [](char k) {
      return k >= 'a' && k <= 'z' ? char(k - 32) : k;
    });
    text += ".SH GRELHA " + upper + "\n" + roff(c.text) + ".\n";
    for (const OptionHelp& o : c.options) {
      text += ".TP\n";
      std::string names;
      for (const std::string& n : o.names)
        names += (names.empty() ? "\\fB" : ", \\fB") + roff(n) + "\\fR";
      text += names + (o.placeholder.empty() ? "" : " \\fI" + roff(o.placeholder) + "\\fR") + "\n" +
              roff(o.text) + "\n";
    }
    if (c.footer.empty())
      continue;
    text += ".PP\n.nf\n";
    std::istringstream lines(c.footer);
    // whoever reads this has the scenes where FILES says
    for (std::string line; std::getline(lines, line);)
      text +=
          roff(replace_all(replace_all(line, "scenes/data/", ""), "scenes/data", "scenes")) + '\n';
    text += ".fi\n";
  }
  text +=
      ".SH FILES\n.TP\n.I PREFIX/share/grelha/scenes\nscenes to begin with; PREFIX is /usr for the "
      "Debian package grelha\n"
      ".TP\n.I PREFIX/share/doc/grelha\npages, examples and recipes; in Debian the package "
      "grelha\\-doc\n"
      ".TP\n.I *.grelha\npart of a picture, or what a checkpoint keeps\n"
      ".TP\n.IR NAME .partial.png \", \" NAME .partial.grelha\nwhat a stopped render leaves: the "
      "unfinished picture, and what the same command goes on from\n"
      ".TP\n.RI . FILE .grelha\\-tmp\na FILE while it is written\n";
  return text +
         ".SH EXIT STATUS\n0; 1 when reading or writing a file fails; 2 for bad usage or a scene "
         "that cannot be one;\n"
         "3 when \\-\\-strict is given and a picture does not meet its \\-\\-error;\n"
         "129, 130 and 143 when stopped by SIGHUP, SIGINT and SIGTERM.\n"
         ".SH SEE ALSO\n.BR gzip (1),\n.BR mpirun (1),\n.BR sbatch (1)\n";
}

std::string bash_completion(const std::vector<CommandHelp>& commands) {
  std::string values, options;
  for (const CommandHelp& c : commands) {
    std::vector<std::string> all{"--help", "--help-all"};
    for (const OptionHelp& o : c.options) {
      all.insert(all.end(), o.names.begin(), o.names.end());
      for (const std::string& n : o.names)
        if (!value_words(o).empty())
          values += "    " + c.name + ',' + n + ") words=\"" + join(value_words(o)) + "\" ;;\n";
    }
    options += "    " + c.name + ") words=\"" + join(all) + "\" ;;\n";
  }
  return "# bash completion of grelha, " + std::string(kMade) +
         "\n_grelha() {\n"
         "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} words=\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         names_of(commands) +
         " --help --help-all --version -V\" -- \"$cur\"))\n"
         "    return\n"
         "  fi\n"
         "  case ${COMP_WORDS[1]},$prev in\n" +
         values +
         "    scene,scene) [[ $cur == -* ]] || words=$(grelha scene --list 2>/dev/null | cut -d ' "
         "' -f 1) ;;\n"
         "  esac\n"
         "  [ -n \"$words\" ] || [[ $cur != -* ]] || case ${COMP_WORDS[1]} in\n" +
         options +
         "  esac\n"
         "  [ -z \"$words\" ] || COMPREPLY=($(compgen -W \"$words\" -- \"$cur\"))\n"
         "  [[ ${COMPREPLY[0]-} != *: ]] || compopt -o nospace 2>/dev/null || true\n"
         "}\n"
         "complete -o bashdefault -o default -F _grelha grelha\n";
}

}  // namespace grelha
