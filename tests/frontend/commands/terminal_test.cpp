// The program in a terminal: how wide its bar is.
#include "frontend/commands/progress.hpp"
#include "tests/support/running.hpp"
#include "tests/support/terminal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <vector>

namespace grelha {
namespace {

TEST(Progress, TellsShareAndRemainingTime) {
  const auto text = [](double share, double elapsed_s) {
    return progress_text("load", share, elapsed_s, 80);
  };
  EXPECT_EQ(text(0, 1), "load   [........................................]   0 %");
  EXPECT_EQ(text(.5, 3), "load   [####################....................]  50 %  3 s left");
  EXPECT_EQ(text(1, 3), "load   [########################################] 100 %  0 s left");
  EXPECT_EQ(text(.25, 30),
            "load   [##########..............................]  25 %  1 min 30 s left");
  EXPECT_EQ(text(.1, 800),
            "load   [####....................................]  10 %  2 h 0 min left");
}

TEST(Progress, FitsAnyWidth) {
  EXPECT_EQ(progress_text("render", .5, 3, 40), "render [#######........]  50 %  3 s left");
  EXPECT_EQ(progress_text("render", .5, 3, 30), "render [##...]  50 %  3 s left");
  EXPECT_EQ(progress_text("render", .5, 3, 24), "render  50 %  3 s left");
  EXPECT_EQ(progress_text("render", .5, 3, 14), "render  50 %");
  EXPECT_EQ(progress_text("render", .5, 3, 6), " 50 %");
  for (int columns = 5; columns < 120; ++columns)
    for (const double share : {0., .001, .5, 1.})
      EXPECT_LE(int(progress_text("render", share, 5000, columns).size()), columns) << share;
}

/// Returns the texts between carriage returns, without the escape sequences that clear the rest of
/// a line.
std::vector<std::string> drawn(const std::string& output) {
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < output.size(); ++i) {
    if (output.compare(i, 3, "\033[K") == 0)
      i += 2;
    else if (output[i] == '\r')
      lines.emplace_back();
    else
      lines.back() += output[i];
  }
  return lines;
}

constexpr char kControlC = 3;
constexpr const char* kSeconds = "render ball.nff -o x.pfm --threads 1 --size 200x200 --samples ";

TEST(Terminal, TheBarIsNoWiderThanTheWindowAlsoWhenItIsResized) {
  if (!test::there_are_terminals())
    GTEST_SKIP() << "this system gives no pseudo-terminals";
  const TemporaryFolder folder;
  folder.write("ball.nff", test::kBall);
  std::size_t narrow = 0, narrower = 0;
  for (int samples = 500; narrower == 0 && samples <= 64000;
       samples *= 4) {  // until it takes the fraction of a second
    test::Terminal terminal(folder, kSeconds + std::to_string(samples), 50);
    const std::string before = terminal.read_until(" left");
    terminal.resize(30);
    const std::string after = terminal.read_all();
    EXPECT_EQ(terminal.status(), 0);
    for (const std::string& line : drawn(before))
      narrow = std::max(narrow, line.size());
    // What was under way while the window changed may be of the old width: the first line after.
    const std::vector<std::string> lines = drawn(after);
    for (std::size_t i = 2; i < lines.size(); ++i)
      if (lines[i].starts_with("render "))
        narrower = std::max(narrower, lines[i].size());
  }
  EXPECT_GT(narrow, 30u);
  EXPECT_LE(narrow, 47u) << "^C fits behind it, without the last column";
  EXPECT_GT(narrower, 0u) << "no bar was drawn after the window was resized";
  EXPECT_LE(narrower, 27u);
}

using Clock = std::chrono::steady_clock;

/// One piece of work here is 8 rows of 64 samples of a picture 4000 wide: seconds.
TEST(Terminal, ControlCIsAnsweredAtOnceWhateverIsInWork) {
  if (!test::there_are_terminals())
    GTEST_SKIP() << "this system gives no pseudo-terminals";
  const TemporaryFolder folder;
  folder.write("ball.nff", test::kBall);
  test::Terminal terminal(folder, "render ball.nff -j 1 --samples 64 --size 8000x4000", 80);
  terminal.read_until("render [");
  const auto typed = Clock::now();
  terminal.type(kControlC);
  const std::string answer = terminal.read_until("once more ends it at once");
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - typed).count(), .1);
  EXPECT_NE(answer.find("\r\033[Kgrelha: stopping"), answer.npos) << answer;
  terminal.type(kControlC);
  terminal.read_all();
  EXPECT_EQ(terminal.status(), 128 + SIGINT);
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - typed).count(), .5)
      << "the second ends it at once";
}

/// The stop itself waits for the piece in work; what there is stays, beside the picture's name.
TEST(Terminal, ControlCLeavesThePictureSoFar) {
  if (!test::there_are_terminals())
    GTEST_SKIP() << "this system gives no pseudo-terminals";
  const TemporaryFolder folder;
  folder.write("ball.nff", test::kBall);
  test::Terminal terminal(folder, "render ball.nff -j 1 --samples 3000 --size 300x200", 80);
  terminal.read_until("left");
  terminal.type(kControlC);
  const std::string said = terminal.read_all();
  EXPECT_EQ(terminal.status(), 128 + SIGINT);
  EXPECT_NE(
      said.find(" % done and saved in ball.partial.grelha: the same command goes on from there; "
                "ball.partial.png is the picture so far"),
      said.npos)
      << said;
  EXPECT_EQ(folder.list(), "ball.nff ball.partial.grelha ball.partial.png");
}

TEST(Terminal, IsNoPlaceForAPicture) {
  if (!test::there_are_terminals())
    GTEST_SKIP() << "this system gives no pseudo-terminals";
  const TemporaryFolder folder;
  folder.write("ball.nff", test::kBall);
  test::Terminal terminal(folder, "render ball.nff -o -", 80);
  EXPECT_EQ(terminal.read_all(),
            "grelha: error: -o -: stdout is a terminal: expected a pipe or a file behind it\r\n");
  EXPECT_EQ(terminal.status(), 2);
}

TEST(Terminal, ADumbOneGetsNoBar) {
  if (!test::there_are_terminals())
    GTEST_SKIP() << "this system gives no pseudo-terminals";
  const TemporaryFolder folder;
  folder.write("ball.nff", test::kBall);
  test::Terminal terminal(folder, std::string(kSeconds) + "800", 80, "dumb");
  const std::string output = terminal.read_all();
  EXPECT_EQ(terminal.status(), 0);
  EXPECT_EQ(output.find('\033'), output.npos) << output;
  EXPECT_EQ(std::count(output.begin(), output.end(), '\n'), 1) << output;
}

}  // namespace
}  // namespace grelha
