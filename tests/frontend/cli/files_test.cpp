// Tests which existing files each command may overwrite and which it may not.
#include "frontend/commands/layers.hpp"
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/memory_limit.hpp"
#include "frontend/images/image_file.hpp"
#include "frontend/input/read_scene.hpp"
#include "grelha/query.hpp"
#include "tests/support/running.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace grelha {
namespace {

using test::kBall;
using test::Outcome;

class Files : public testing::Test {
 protected:
  Files() { folder_.write("ball.nff", kBall); }
  Outcome run(const std::string& arguments, const std::string& before = "timeout 20 ") {
    return test::run(folder_, arguments, before);
  }
  void expect_refused(const std::string& arguments, const std::string& why) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(outcome.err, "grelha: error: " + why + '\n') << arguments;
  }
  TemporaryFolder folder_;
};

TEST_F(Files, PlacesAreEqualWhereverNamesAreNot) {
  std::filesystem::create_directory(folder_.file("in"));
  std::filesystem::create_symlink("in", folder_.file("also-in"));
  std::filesystem::create_symlink("in/new", folder_.file("link"));
  std::filesystem::create_hard_link(folder_.file("ball.nff"), folder_.file("hard"));
  const auto same = [&](const std::string& a, const std::string& b) {
    return location_of(folder_.file(a)) == location_of(folder_.file(b));
  };
  EXPECT_TRUE(same("ball.nff", "in/../hard"));
  EXPECT_TRUE(same("in/new", "also-in/./new"));
  EXPECT_TRUE(same("in/new", "link"));
  EXPECT_TRUE(same("no/new", "no/./new"));
  EXPECT_FALSE(same("in/new", "new"));
  EXPECT_FALSE(same("in/new", "in/old"));
  EXPECT_FALSE(same("ball.nff", "new"));
}

TEST_F(Files, NothingIsWrittenOverWhatIsRead) {
  std::filesystem::create_hard_link(folder_.file("ball.nff"), folder_.file("hard"));
  std::filesystem::create_symlink("ball.nff", folder_.file("link.png"));
  std::filesystem::create_symlink("ball.nff", folder_.file("twin.nff"));
  folder_.write("mesh.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
  folder_.write("two.nff", std::string(kBall) + "ply mesh.ply\n");
  const std::string before = folder_.list();
  for (const char* name : {"ball.nff", "./ball.nff", "hard"})
    expect_refused(
        std::string("render ball.nff --stats ") + name,
        std::string("--stats: expected another file than ball.nff, which is read, found \"") +
            name + '"');
  expect_refused("render twin.nff -o link.png",
                 "-o: expected another file than twin.nff, which is read, found \"link.png\"");
  expect_refused("render ball.nff two.nff -o {}.png --checkpoint {}.kept --stats twin.nff",
                 "--stats: expected another file than ball.nff, which is read, found \"twin.nff\"");
  expect_refused(
      "render two.nff -o x.png --stats ./mesh.ply",
      "--stats: expected another file than mesh.ply, which is read, found \"./mesh.ply\"");
  EXPECT_EQ(folder_.list(), before);
  EXPECT_EQ(folder_.read("ball.nff"), kBall);
}

TEST_F(Files, NothingIsWrittenTwice) {
  std::filesystem::create_symlink("x.png", folder_.file("link.png"));
  expect_refused("render ball.nff -o x.png --stats ./x.png",
                 "--stats and -o: expected two files, found \"x.png\" twice");
  expect_refused("render ball.nff -o x.png --error .1 --samples-map link.png",
                 "--samples-map and -o: expected two files, found \"x.png\" twice");
  expect_refused("render ball.nff -o x.png --stats s --checkpoint ./s",
                 "--checkpoint and --stats: expected two files, found \"s\" twice");
  EXPECT_EQ(run("render ball.nff -o x.png --quiet --stats /dev/null --checkpoint kept").status, 0);
}

TEST_F(Files, ACheckpointIsARegularFile) {
  ASSERT_EQ(mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("/dev/null", folder_.file("null"));
  for (const char* name : {"pipe", "null"}) {
    const Outcome outcome = run(std::string("render ball.nff -o x.png --checkpoint ") + name);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err, std::string(name) + ": error: cannot write: not a regular file\n");
  }
}

TEST_F(Files, APictureGoesIntoAPipe) {
  ASSERT_EQ(mkfifo(folder_.file("pipe.png").c_str(), 0600), 0);
  EXPECT_EQ(run("render ball.nff -o pipe.png --quiet",
                "(timeout 20 cat pipe.png >got.png &) && timeout 20 ")
                .status,
            0);
  EXPECT_EQ(run("render ball.nff -o whole.png --quiet", "sleep .3 && ").status, 0);
  EXPECT_EQ(folder_.read("got.png"), folder_.read("whole.png"));
}

TEST_F(Files, WhatCannotBeWrittenIsNotReplaced) {
  folder_.write("x.png", "old");
  std::filesystem::permissions(folder_.file("x.png"), std::filesystem::perms::owner_read);
  std::string other = "timeout 20 ";
  if (geteuid() == 0) {  // root may write to any file: someone else then
    std::filesystem::permissions(folder_.path(), std::filesystem::perms::all);
    other += "setpriv --reuid 65534 --clear-groups ";
    if (run("--version", other).status != 0)
      GTEST_SKIP() << "no setpriv, or a program only root may run";
  }
  EXPECT_EQ(run("render ball.nff -o x.png", other).err,
            "x.png: error: cannot write: Permission denied\n");
  EXPECT_EQ(folder_.read("x.png"), "old");
}

TEST_F(Files, FoldersForPicturesAreMade) {
  EXPECT_EQ(run("render ball.nff -o pictures/ --quiet").status, 0);
  EXPECT_EQ(run("render ball.nff -o deep/er/{}.pfm --stats counts/{}.json --quiet").status, 0);
  for (const char* name : {"pictures/ball.png", "deep/er/ball.pfm", "counts/ball.json"})
    EXPECT_NE(folder_.read(name), "") << name;
  EXPECT_EQ(run("render ball.nff -o no/x.png").err,
            "no/x.png: error: cannot write: No such file or directory\n")
      << "a slip, more likely";
  EXPECT_EQ(run("render ball.nff -o ball.nff/").err,
            "ball.nff: error: cannot make this folder: Not a directory\n");
}

TEST_F(Files, ASceneComesThroughAPipe) {
  ASSERT_EQ(run("render ball.nff -o whole.pfm --quiet").status, 0);
  EXPECT_EQ(run("render /dev/stdin -o a.pfm --quiet", "sh -c \"cat ball.nff | \\$0 \\$*\" ").err,
            "");
  EXPECT_EQ(run("render - --quiet", "sh -c \"gzip <ball.nff | \\$0 \\$*\" ").err, "");
  EXPECT_EQ(folder_.read("a.pfm"), folder_.read("whole.pfm"));
  EXPECT_EQ(folder_.list(), "a.pfm ball.nff stdin.png whole.pfm");
  EXPECT_EQ(run("render - -o b.pfm").err, "/dev/stdin: error: cannot read: not a regular file\n")
      << "it is /dev/null";
}

TEST_F(Files, ASignalEndsTheWaitForAPipe) {
  ASSERT_EQ(mkfifo(folder_.file("pipe.nff").c_str(), 0600), 0);
  // In the foreground, lest it signals the group as well: the second signal would end the program
  // at once.
  const std::string stop = "timeout --foreground --preserve-status -k 5 -s HUP .5 ";
  for (const std::string writer : {"", "(sleep 2 >pipe.nff &) && "}) {
    const Outcome outcome = run("render pipe.nff", writer + stop);
    EXPECT_EQ(outcome.status, 129);
    EXPECT_EQ(outcome.err,
              std::string(test::kStopping) + "grelha: stopped by SIGHUP while reading pipe.nff\n");
  }
}

/// Meshes and files found in a folder must be regular files: a pipe there might never get a writer.
TEST_F(Files, NoOtherPipeIsWaitedFor) {
  std::filesystem::create_directory(folder_.file("in"));
  folder_.write("in/scene.nff", std::string(kBall) + "ply mesh.ply\n");
  ASSERT_EQ(mkfifo(folder_.file("in/mesh.ply").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(folder_.file("in/pipe.nff").c_str(), 0600), 0);
  EXPECT_EQ(run("info in").err,
            "in/mesh.ply: error: cannot read: not a regular file (named at in/scene.nff:12:5)\n");
}

TEST_F(Files, AMeshThatIsNotThereIsNotOutside) {
  std::filesystem::create_directory(folder_.file("in"));
  folder_.write("in/scene.nff", std::string(kBall) + "ply nothere.ply\n");
  const std::string why = "nothere.ply: error: cannot open: No such file or directory (named at ";
  EXPECT_EQ(run("info in/scene.nff").err, "in/" + why + "in/scene.nff:12:5)\n");
  EXPECT_EQ(run("info scene.nff", "cd in &&").err, why + "scene.nff:12:5)\n");
}

TEST_F(Files, TheFileThereIsNoMemoryForIsNamed) {
  if (!memory_can_be_limited())
    GTEST_SKIP() << "sanitizers own more memory than there is";
  folder_.write("large.nff", std::string(kBall) + std::string(std::size_t(100) << 20, ' '));
  folder_.write("large.ply", std::string(std::size_t(100) << 20, ' '));
  folder_.write("mesh.nff", std::string(kBall) + "ply large.ply\n");
  const std::string why = ": error: out of memory: needed more than 0.0671 GB (--max-memory)\n";
  EXPECT_EQ(run("info ball.nff large.nff --max-memory 64M").err, "large.nff" + why);
  EXPECT_EQ(run("info mesh.nff --max-memory 64M").err, "large.ply" + why);
}

TEST_F(Files, AnEmptyNameIsNone) {
  for (const std::string option : {"--checkpoint", "--stats"})
    expect_refused("render ball.nff " + option + " ''",
                   option + ": expected a file name, found \"\"");
  expect_refused("scene balls -o ''", "-o: expected a file name, found \"\"");
  for (const std::string command : {"render", "info"})
    expect_refused(command + " ''", "SCENE: expected a file name, found \"\"");
  expect_refused("compare ball.nff ''", "B: expected a file name, found \"\"");
  expect_refused("merge '' -o x.png", "PARTS: expected a file name, found \"\"");
}

TEST_F(Files, NamesTooLongAreOneLineOfOurs) {
  const std::string name(300, 'n');
  EXPECT_EQ(run("render ball.nff -o " + name + ".png").err,
            name + ".png: error: cannot write: File name too long\n");
  EXPECT_EQ(run("render " + name + ".nff -o x.png").err,
            name + ".nff: error: cannot open: File name too long\n");
  EXPECT_EQ(run("render ball.nff --checkpoint " + name).err,
            name + ": error: cannot write: File name too long\n");
}

/// With `-o -` the program writes to stdout the same bytes as to a file, and nothing else.
TEST_F(Files, ResultsGoToStdout) {
  ASSERT_EQ(run("render ball.nff -o a.png --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o a.hdr --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o a.grelha --quiet").status, 0);
  ASSERT_EQ(run("scene balls --size 2 -o b.nff").status, 0);
  const std::string before = folder_.list();
  const Outcome png = run("render ball.nff -o -");
  EXPECT_EQ(png.status, 0);
  EXPECT_EQ(png.out, folder_.read("a.png"));
  EXPECT_TRUE(png.err.starts_with("stdout: 1 sphere; ")) << png.err;
  EXPECT_EQ(run("render ball.nff -o - --format hdr --quiet").out, folder_.read("a.hdr"));
  EXPECT_EQ(run("merge a.grelha -o - --format hdr --quiet").out, folder_.read("a.hdr"));
  EXPECT_EQ(run("merge a.grelha -o -").err, "stdout: rows 0:16, samples 0:1 from 1 part\n");
  EXPECT_EQ(run("scene balls --size 2 -o -").out, folder_.read("b.nff"));
  EXPECT_EQ(folder_.list(), before) << "no file called - is made";
  const Outcome stats = run("render ball.nff -o a.png --stats -");
  EXPECT_TRUE(stats.out.starts_with("{\n") && stats.out.ends_with("}\n")) << stats.out;
  EXPECT_TRUE(stats.err.starts_with("a.png: 1 sphere; ")) << stats.err;
  EXPECT_EQ(run("render ball.nff --format pfm --quiet").status, 0);
  EXPECT_EQ(folder_.read("ball.pfm").substr(0, 3), "PF\n");
}

TEST_F(Files, StdoutHoldsOneResult) {
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    expect_refused(arguments, why);
  };
  refused("render ball.nff -o - --stats -",
          "--stats and -o: expected two files, found \"-\" twice");
  folder_.write("two.nff", kBall);
  refused(
      "render ball.nff two.nff -o -",
      "-o: ball.nff and two.nff would both be written to -; {} in a name stands for the scene's");
  refused("scene boat -o -", "-o: expected a file, for a mesh is written beside it, found \"-\"");
  const Outcome full = run("render ball.nff -o - --quiet", "sh -c '\"$0\" \"$@\" >/dev/full' ");
  EXPECT_EQ(full.status, 1);
  EXPECT_EQ(
      full.err,
      "grelha: all of the picture is kept in ball.partial.grelha: the same command writes it\n"
      "stdout: error: cannot write: No space left on device\n");
  EXPECT_TRUE(run("render ball.nff -o -")
                  .err.starts_with("grelha: goes on from ball.partial.grelha, 100.0 % done\n"));
}

/// Who closed the pipe wants no picture: nothing is kept, unless it was asked for.
TEST_F(Files, AReaderThatIsGoneLeavesNothing) {
  ASSERT_EQ(mkfifo(folder_.file("pipe").c_str(), 0600), 0);
  const std::string to_no_reader = "sh -c 'exec 3<>pipe 4>pipe 3<&-; exec \"$0\" \"$@\" >&4' ";
  const std::string gone = "stdout: error: cannot write: Broken pipe\n";
  const std::string job = "render ball.nff -o - --quiet";
  const Outcome outcome = run(job, to_no_reader);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, gone);
  EXPECT_EQ(folder_.list(), "ball.nff pipe");
  EXPECT_NE(run(job + " --checkpoint kept", to_no_reader).err.find(gone), std::string::npos);
  EXPECT_EQ(folder_.list(), "ball.nff kept pipe");
}

/// The metadata of a picture suffices to reproduce it, and does not depend on options that change
/// no bit of the picture.
TEST_F(Files, PicturesSayWhatTheyAre) {
  const auto text = [&](const std::string& options) {
    EXPECT_EQ(run("render ball.nff --quiet -o x.png --size 9x7 " + options).status, 0);
    return folder_.read("x.png");
  };
  const std::string png = text("--samples 3 --seed 5");
  for (const std::string& chunk :
       {std::string("Software\0grelha ", 16),
        std::string("Title\0ball", 10),
        std::string("Scene\0XXH3 ", 11),
        std::string("Settings\0size=9x7 samples=3 sampler=sobol seed=5 depth=5", 56)})
    EXPECT_NE(png.find("tEXt" + chunk), png.npos) << chunk;
  EXPECT_EQ(png.find("sRGB"), png.npos);
  EXPECT_EQ(png,
            text("--samples 3 --seed 5 -j 1 --isa scalar --packet 1 --accel none --stats s.json"));
  EXPECT_NE(text("--srgb").find("sRGB"), png.npos);
  folder_.write("copy.nff", kBall);
  EXPECT_EQ(run("render ./copy.nff --quiet -o y.png --size 9x7 --samples 3 --seed 5").status, 0);
  EXPECT_NE(folder_.read("y.png"), png) << "of another name";
  EXPECT_EQ(run("compare x.png y.png --max-rmse 0").status, 1);
  const std::string timed = text("--time .01"),
                    count = timed.substr(timed.find("time=samples:"), 40);
  EXPECT_EQ(text("--time " + count.substr(5, count.find(' ') - 5)), timed) << count;
}

/// Checks the layers of each pixel against the exact sphere; the colour of a pixel tells if it
/// shows the ball.
TEST_F(Files, LayersAreOfWhatThePictureShows) {
  ASSERT_EQ(run("render ball.nff -o a.exr --layers depth,normal,id --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o a.pfm --quiet").status, 0);
  EXPECT_EQ(run("compare a.exr a.pfm --max-rmse 0").status, 0);
  const std::string bytes = folder_.read("a.exr");
  for (const char* channel : {"Z", "id", "normal.X", "normal.Y", "normal.Z"})
    EXPECT_NE(bytes.find(channel + std::string(1, '\0')), bytes.npos) << channel;
  const SceneFile file = read_scene(folder_.file("ball.nff"), [](const std::string&) {});
  const World world(file.scene, {});
  const Layers layers =
      first_hits(world, file.camera, {}, {.depth = true, .normal = true, .id = true});
  const Image picture = read_image(folder_.file("a.pfm"));
  int met = 0;
  for (std::size_t i = 0; i < layers.id.size(); ++i) {
    const bool background = picture.rgb[3 * i] == 0 && picture.rgb[3 * i + 2] == 1;
    EXPECT_EQ(layers.id[i], background ? kNoPrimitive : 0u) << i;
    EXPECT_EQ(std::isinf(layers.depth[i]), background) << i;
    const float* const n = layers.normal.data() + 3 * i;
    EXPECT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], background ? 0 : 1, 1e-5) << i;
    if (background)
      continue;
    ++met;
    EXPECT_GE(layers.depth[i], 4) << "the eye is 5 from the middle of a ball of radius 1";
    EXPECT_LE(layers.depth[i], std::sqrt(24.f) * 1.0001f);
    EXPECT_GE(n[2], 0) << "towards the eye";
  }
  EXPECT_GT(met, 50);
}

TEST_F(Files, ComparesLightWithLight) {
  ASSERT_EQ(run("render ball.nff -o a.png --srgb --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o b.hdr --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o c.png --quiet").status, 0);
  const Outcome bent = run("compare a.png b.hdr --max-rmse .01");
  EXPECT_EQ(bent.err, "a.png holds sRGB values, b.hdr light: compared as light\n");
  EXPECT_EQ(bent.status, 0) << bent.out;
  EXPECT_EQ(run("compare b.hdr c.png --max-rmse .01").err, "");
  EXPECT_EQ(run("compare a.png a.png --max-rmse 0").err, "") << "of one kind: as they are";
}

/// A scene, a mesh, outputs, and an option by names that would clear a screen or begin a line.
TEST_F(Files, NoNameReachesATerminalAsItIs) {
  const std::string name = "a\x1b[2J\nb\x9b\x7f\xC2\x9B\xC3\xA9";
  std::filesystem::create_directory(folder_.file(name));
  folder_.write(name + ".nff", kBall);
  folder_.write(name + ".ply", "ply\n");
  folder_.write("of mesh.nff", kBall + ("ply " + name + ".ply\nfoo\x1b[2J 1\n"));
  folder_.write("noise.nff", kBall + ("\x1b[2J 1\nenv \x1b[2J\n" + name + " 3\n"));
  const std::string quoted = "'" + name + "'";
  const std::vector<std::string> lines{
      "render " + quoted + ".nff --size 4x4",
      "render " + quoted + ".nff -o " + quoted + "/x.png --size 4x4",
      "render " + quoted + ".nff -o " + quoted + ".xyz",
      "render " + quoted + ".nff -o none/" + quoted + ".png",
      "render ball.nff -o ball.pfm --size 4x4 --stats " + quoted,
      "render ball.nff --checkpoint " + quoted,
      "render ball.nff --size " + quoted,
      "render ball.nff --" + quoted,
      "render none" + quoted,
      "render " + quoted,
      "info " + quoted + ".nff",
      "info --json " + quoted + ".nff ball.nff",
      "info 'of mesh.nff'",
      "info noise.nff",
      "scene " + quoted,
      "scene balls --size 1 -o none/" + quoted,
      "compare " + quoted + ".png " + quoted,
      "merge " + quoted + ".grelha ball.nff -o x.pfm",
      quoted};
  for (const std::string& line : lines) {
    const test::Outcome outcome = run(line);
    const std::string said = outcome.out + outcome.err;
    EXPECT_NE(outcome.status, -1) << line;
    for (const char c : said)
      EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= ' ') << said;
    for (const char* sign : {"\x7f", "\x9b", "\xAE"})
      EXPECT_EQ(said.find(sign), said.npos) << said;
    if (outcome.status != 0) {
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
  }
}

}  // namespace
}  // namespace grelha
