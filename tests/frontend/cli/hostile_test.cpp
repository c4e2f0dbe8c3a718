// Files made to waste time or memory: the program ends with each in 15 s of processor time and 512
// MiB.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include "frontend/files/memory_limit.hpp"
#include "tests/support/gzip.hpp"
#include "tests/support/running.hpp"

namespace grelha {
namespace {

#ifdef NDEBUG
constexpr double kMostSeconds = 15;
#else
constexpr double kMostSeconds = 60;  // nothing is optimised
#endif
constexpr long kMostKilobytes = 512 * 1024;

struct Measured {
  bool exited = false;
  int status = 0;
  double seconds = 0;  ///< of all threads
  long kilobytes = 0;
  std::string err;
};

/// Runs the program in the folder; the processor time is bounded by the system, lest a hang hangs
/// the test.
Measured measure(const TemporaryFolder& folder, std::vector<std::string> words) {
  words.insert(words.begin(), GRELHA_PROGRAM);
  const TemporaryFolder log;
  const std::string err = log.file("err");
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (std::string& word : words)
      arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const rlimit seconds{rlim_t(4 * kMostSeconds), rlim_t(4 * kMostSeconds)};
    const bool ready =
        chdir(folder.path().c_str()) == 0 && std::freopen("/dev/null", "w", stdout) &&
        std::freopen(err.c_str(), "w", stderr) && setrlimit(RLIMIT_CPU, &seconds) == 0;
    if (ready)
      execv(arguments[0], arguments.data());
    _exit(127);
  }
  Measured run;
  rusage usage{};
  int status = 0;
  if (wait4(child, &status, 0, &usage) != child)
    return run;
  run.exited = WIFEXITED(status);
  run.status = run.exited ? WEXITSTATUS(status) : WTERMSIG(status);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + double(t.tv_usec) * 1e-6; };
  run.seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.kilobytes = usage.ru_maxrss;
  run.err = log.read("err");
  return run;
}

class Hostile : public testing::Test {
 protected:
  /// `said`: expected substring of the output on stderr; "" if there must be none.
  void expect_bounded(const std::vector<std::string>& words, int status, const std::string& said) {
    const Measured run = measure(folder_, words);
    const std::string what = words[0] + ' ' + words[1];
    EXPECT_TRUE(run.exited) << what << ": signal " << run.status;
    EXPECT_EQ(run.status, status) << what << '\n' << run.err;
    EXPECT_NE(run.err.find(said), std::string::npos) << what << '\n' << run.err;
    EXPECT_EQ(said.empty(), run.err.empty()) << what << '\n' << run.err;
    const auto lines = std::count(run.err.begin(), run.err.end(), '\n');
    EXPECT_LE(lines, 25) << what;
    if (!memory_can_be_limited())
      return;  // sanitizers take their own time and memory
    EXPECT_LT(run.seconds, kMostSeconds) << what;
    EXPECT_LT(run.kilobytes, kMostKilobytes) << what;
  }
  /// info, and a small picture.
  void expect_both_bounded(const std::string& name, int status, const std::string& said) {
    expect_bounded({"info", name}, status, said);
    expect_bounded({"render", name, "-o", "x.png", "--quiet", "--size", "64x64"}, status, said);
    EXPECT_EQ(std::filesystem::exists(folder_.file("x.png")), status == 0) << name;
  }
  TemporaryFolder folder_;
};

using Radius = std::function<double(int)>;

std::string star(int corner_count, const Radius& radius) {
  std::string text = std::string(test::kBall) + "p " + std::to_string(corner_count) + '\n';
  for (int i = 0; i < corner_count; ++i) {
    const double angle = 2 * std::numbers::pi * i / corner_count, r = radius(i);
    char line[64];
    std::snprintf(line, sizeof line, "%.9g %.9g 0\n", r * std::cos(angle), r * std::sin(angle));
    text += line;
  }
  return text;
}

TEST_F(Hostile, StarsOfManyCorners) {
  folder_.write("regular.nff", star(1000000, [](int i) { return i % 2 == 0 ? 1. : .5; }));
  expect_both_bounded("regular.nff", 0, "");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> length(1, 2);
  folder_.write("spikes.nff", star(500000, [&](int) { return length(random); }));
  expect_both_bounded("spikes.nff", 0, "");
  // Spikes over six decades: ears are long and thin, and each overlaps many corners, so grid cells
  // are full.
  std::uniform_real_distribution<double> decades(-6, 0);
  folder_.write("uneven.nff", star(1000000, [&](int) { return std::pow(10, decades(random)); }));
  expect_both_bounded("uneven.nff", 0, "");
  folder_.write("round.nff", star(1000000, [](int) { return 1.; }));
  expect_both_bounded("round.nff", 0, "");
}

/// The same with one corner pulled across thousands of spikes, and corners anywhere.
TEST_F(Hostile, PolygonsOfManyCrossings) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> decades(-6, 0);
  std::string text = star(500000, [&](int) { return std::pow(10, decades(random)); });
  const std::size_t corner = text.find('\n', text.find("p 500000") + 200) + 1;
  text.replace(corner, text.find('\n', corner) - corner, ".9 -.1 0");
  folder_.write("pulled.nff", text);
  expect_both_bounded("pulled.nff", 0, "it is filled by the even-odd rule");
  for (const int corner_count : {1400, 1000000}) {
    std::string noise = std::string(test::kBall) + "p " + std::to_string(corner_count) + '\n';
    for (int i = 0; i < corner_count; ++i)
      noise += std::to_string(random() % 100000) + ' ' + std::to_string(random() % 100000) + " 0\n";
    folder_.write("noise.nff", noise);
    expect_both_bounded("noise.nff", 0, corner_count > 1400 ? "it is left out" : "it is filled");
  }
}

/// A comb across both axes, its teeth over three decades: the row of their feet lies on the side of
/// an ear as long as the comb.
TEST_F(Hostile, CombOfAMillionCorners) {
  constexpr int kVertices = 1000000;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> decades(-3, 0);
  std::string text = std::string(test::kBall) + "p " + std::to_string(kVertices) + '\n';
  text += "-.001 .001 0\n.999 1.001 0\n";
  for (int i = kVertices - 2; i-- > 0;) {
    const double at = double(i) / kVertices, tooth = i % 2 == 0 ? std::pow(10, decades(random)) : 0;
    char line[64];
    std::snprintf(line, sizeof line, "%.9g %.9g 0\n", at + tooth, at - tooth);
    text += line;
  }
  folder_.write("comb.nff", text);
  expect_both_bounded("comb.nff", 0, "");
}

TEST_F(Hostile, MillionsOfUnknownWords) {
  std::string alike = test::kBall, unlike = test::kBall, numbers = test::kBall;
  for (int i = 0; i < 1000000; ++i) {
    alike += "sphere 0 0 0 1\n";
    unlike += "word" + std::to_string(i) + " 0\n";
    numbers += "1 2 3\n";
  }
  folder_.write("alike.nff", alike);
  folder_.write("unlike.nff", unlike);
  folder_.write("numbers.nff", numbers);
  expect_both_bounded("alike.nff", 0, "unknown word \"sphere\"");
  expect_both_bounded("unlike.nff", 0, "unknown word \"word7\"");
  expect_both_bounded("numbers.nff", 0, "numbers that belong to no entity");
}

TEST_F(Hostile, HeadersOfManyElements) {
  std::string elements = "ply\nformat ascii 1.0\n", properties = elements + "element e 0\n",
              stray = elements;
  for (int i = 0; i < 300000; ++i) {
    elements += "element e" + std::to_string(i) + " 0\n";
    properties += "property int p" + std::to_string(i) + '\n';
    stray += "stray" + std::to_string(i) + '\n';
  }
  folder_.write("elements.ply", elements + "end_header\n");
  folder_.write("properties.ply", properties + "end_header\n");
  folder_.write("stray.ply", stray + "end_header\n");
  expect_both_bounded("elements.ply", 0, "nothing to draw");
  expect_both_bounded("properties.ply", 0, "nothing to draw");
  expect_both_bounded("stray.ply", 0, "no line of a PLY header begins with \"stray7\"");
}

TEST_F(Hostile, HintsBeyondBounds) {
  for (const char* samples : {"1000000000", "4000000000", "1e300"}) {
    folder_.write("spp.nff", std::string(test::kBall) + "spp " + samples + '\n');
    expect_both_bounded("spp.nff", 0, "are more than 65536, which are taken");
  }
}

TEST_F(Hostile, NulBytes) {
  std::string text = std::string(test::kBall) + "s 0 0 0 1";
  text.append(std::size_t(100) << 20, '\0');
  folder_.write("nul.nff", text);
  expect_both_bounded("nul.nff", 2, "bytes without a digit");
  text.resize(1 << 20);
  folder_.write("nul.nff", text);
  expect_both_bounded("nul.nff", 0, "NUL bytes");
}

/// 10 GiB of zeros in 10 MB of gzip, of one letter, and as a file with a hole.
TEST_F(Hostile, FilesThatInflateWithoutEnd) {
  for (const char letter : {'\0', 'a', '\n'}) {
    const std::string member = test::gzip(std::string(std::size_t(16) << 20, letter));
    std::string bomb;
    for (int i = 0; i < 640; ++i)
      bomb += member;
    folder_.write("bomb.nff.gz", bomb);
    folder_.write("bomb.ply.gz", bomb);
    folder_.write("names.nff", std::string(test::kBall) + "ply bomb.ply.gz\n");
    expect_both_bounded("bomb.nff.gz", 2, "without a digit");
    expect_both_bounded(
        "bomb.ply.gz", 2, letter == 'a' ? "expected \"ply\" on the first line" : "without a digit");
    expect_both_bounded("names.nff", 2, "bomb.ply.gz:");
  }
  folder_.write("hole.nff", "s 0 0 0 1\n");
  std::filesystem::resize_file(folder_.file("hole.nff"), std::uintmax_t(1) << 31);
  expect_both_bounded("hole.nff", 2, "without a digit");
}

TEST_F(Hostile, BoxesWhoseOrderIsAskedOfAll) {
  std::string text = test::kBall;
  for (int i = 0; i < 20000; ++i) {
    const std::string x = std::to_string(i % 100), y = std::to_string(i / 100 + 1);
    // both orders allow them
    text += "aabb " + x + ' ' + x + ".5 " + y + ' ' + y + ".5 300 300.5\n";
  }
  folder_.write("boxes.nff", text + "aabb 0 4 -1 1 2 3\n");
  expect_both_bounded("boxes.nff", 0, "");
}

TEST_F(Hostile, CloudsOfPoints) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 5000000\nproperty float x\nproperty "
      "float y\n"
      "property float z\nend_header\n";
  text.append(std::size_t(5000000) * 12, '\0');
  folder_.write("cloud.ply", text);
  expect_both_bounded("cloud.ply", 0, "");
}

}  // namespace
}  // namespace grelha
