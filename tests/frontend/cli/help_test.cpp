#include "frontend/cli/command_line.hpp"
#include "frontend/cli/help.hpp"

#include "frontend/files/text.hpp"
#include "tests/support/parsing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

namespace grelha {
namespace {

using test::parse;

std::size_t widest(const std::string& text) {
  std::istringstream in(text);
  std::size_t most = 0;
  for (std::string line; std::getline(in, line);)
    most = std::max(most, line.size());
  return most;
}

TEST(Help, IsAWordToo) {
  const auto text = [](const std::string& line) { return std::get<TextCommand>(parse(line)).text; };
  EXPECT_EQ(text("help"), text("--help"));
  EXPECT_EQ(text("help render"), text("render --help"));
}

TEST(Help, FitsAScreenAndSaysHow) {
  for (const char* line :
       {"--help", "render --help", "info -h", "compare --help", "scene --help"}) {
    const std::string text = std::get<TextCommand>(parse(line)).text;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 24) << line;
    EXPECT_LE(widest(text), 80u) << line;
    EXPECT_NE(text.find("Usage: grelha"), std::string::npos) << line;
    EXPECT_NE(text.find("Example"), std::string::npos) << line;
  }
  EXPECT_EQ(std::get<TextCommand>(parse("render --help")).text.find("--layers"), std::string::npos);
  for (const char* line : {"render --help-all", "--help-all"}) {
    const std::string text = std::get<TextCommand>(parse(line)).text;
    EXPECT_NE(text.find("--layers"), std::string::npos) << line;
    for (const char* unlisted : {"--packet", "--isa", "--accel"})
      EXPECT_EQ(text.find(unlisted), std::string::npos) << line << ' ' << unlisted;
    EXPECT_LE(widest(text), 80u) << line;
  }
  EXPECT_EQ(std::get<TextCommand>(parse("--version")).text.find("grelha "), 0u);
}

TEST(Nearest, CountsEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("", "ab"), 2u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("ab", "ba"), 1u) << "a swap";
  EXPECT_EQ(edit_distance("abcd", "badc"), 2u);
  constexpr std::string_view words[] = {"s", "resolution", "angle"};
  EXPECT_EQ(nearest("angel", words), "angle");
  EXPECT_EQ(nearest("resoluton", words), "resolution");
  EXPECT_EQ(nearest("ANGLE", words), "angle");
  EXPECT_EQ(nearest("resol", words), "resolution") << "its beginning";
  EXPECT_EQ(nearest("re", words), "") << "two letters begin too many words";
  EXPECT_EQ(nearest("x", words), "") << "one letter of one is another word";
  EXPECT_EQ(nearest("teapot", words), "");
  EXPECT_EQ(nearest(std::string(1000000, 'a'), words), "");
}

/// Words of an option list that look like options: what --help-all shows.
std::set<std::string> options_in(const std::string& text) {
  std::set<std::string> found;
  const std::regex option(R"((^|[\s,])(--?[a-z][a-z-]*))");
  for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it)
    found.insert((*it)[2]);
  return found;
}

TEST(Pages, HoldEveryOptionThatHelpShows) {
  const auto commands = all_commands();
  const std::string man = man_page(commands), bash = bash_completion(commands);
  ASSERT_GE(commands.size(), 4u);
  std::size_t options = 0;
  for (const CommandHelp& c : commands) {
    for (const std::string& option : options_in(help_text(c, true))) {
      ++options;
      EXPECT_NE((" " + bash).find(" " + option), std::string::npos) << c.name << ' ' << option;
      const std::string in_man = std::regex_replace(option, std::regex("-"), "\\-");
      EXPECT_NE(man.find("\\fB" + in_man + "\\fR"), std::string::npos) << c.name << ' ' << option;
    }
    EXPECT_NE(man.find("grelha " + c.name), std::string::npos);
  }
  EXPECT_GE(options, 30u);
  EXPECT_NE(bash.find("render,--points) words=\"auto\""), std::string::npos);
  EXPECT_EQ(bash.find("RADIUS"), std::string::npos) << "no value";
}

/// Words that other programs take, and options in the wrong place.
TEST(Errors, HintAtWhatWasMeant) {
  const std::pair<const char*, const char*> table[] = {
      {"--quiet render a",
       "expected a command before \"--quiet\": grelha render SCENE --quiet ... (see --help)"},
      {"--size=4x4 render a",
       "expected a command before \"--size=4x4\": grelha render SCENE --size ... (see --help)"},
      {"-o a.png render a",
       "expected a command before \"-o\": grelha render SCENE -o ... (see --help)"},
      {"--json info a",
       "expected a command before \"--json\": grelha info SCENE --json ... (see --help)"},
      {"scene.nff",
       "command: expected one of render, info, compare, merge, scene, found \"scene.nff\"; did you "
       "mean grelha render scene.nff?"},
      {"a/Part.STL.gz --size 2x2",
       "command: expected one of render, info, compare, merge, scene, found \"a/Part.STL.gz\"; did "
       "you mean grelha render a/Part.STL.gz?"},
      {"render a --spp 4",
       "render: expected an option, found \"--spp\"; did you mean --samples? (see --help)"},
      {"render a --width=4",
       "render: expected an option, found \"--width=4\"; did you mean --size? (see --help)"},
      {"render a --gamma 2.2",
       "render: expected an option, found \"--gamma\"; did you mean --srgb? (see --help)"},
      {"render a -s 2x2",
       "render: expected an option, found \"-s\"; did you mean --size? (see --help)"},
      {"info a --spp 4", "info: expected an option, found \"--spp\" (see --help)"},
      {"render a --background #ff00",
       "--background: expected R,G,B, #rrggbb or a name such as white, found \"#ff00\""},
      {"render a --background #gggggg",
       "--background: expected R,G,B, #rrggbb or a name such as white, found \"#gggggg\""},
      {"render a --background pinkish",
       "--background: expected R,G,B, #rrggbb or a name such as white, found \"pinkish\""},
  };
  for (const auto& [line, message] : table)
    EXPECT_EQ(test::error_of(line), message) << line;
}

}  // namespace
}  // namespace grelha
