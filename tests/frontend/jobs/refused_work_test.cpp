// Checkpoints of other work, full disks and folders that cannot be written. A part of
// long_work_test.
#include "frontend/jobs/checkpoint.hpp"
#include "tests/frontend/jobs/long_work.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace grelha {
namespace {

using test::kBall;
using test::kJobs;
using test::LongWork;
using test::Outcome;

TEST_F(LongWork, ACheckpointOfAnotherKindIsLeftAlone) {
  const std::string advice = ": name another file, or remove this one to begin again\n",
                    error = "grelha: error: --checkpoint: kept has ";
  std::filesystem::create_symlink("/dev/full", folder_.file("full.pfm"));
  const auto refusal = [&](const std::string& options) {
    const Outcome outcome = run("render ball.nff --quiet --checkpoint kept " + options);
    EXPECT_EQ(outcome.status, 2);
    const bool fits = outcome.err.starts_with(error) && outcome.err.ends_with(advice);
    return fits
               ? outcome.err.substr(error.size(), outcome.err.size() - error.size() - advice.size())
               : outcome.err;
  };
  ASSERT_EQ(run("render ball.nff --quiet -o full.pfm --checkpoint kept --error .1").status, 1);
  const std::string bytes = folder_.read("kept");
  EXPECT_EQ(refusal(""), "error=0.1 no samples=, this render has samples=1 no error=");
  EXPECT_EQ(
      refusal("--aa adaptive:.1,2"),
      "error=0.1 no samples= no adaptive=, this render has samples=1 adaptive=0.1,2 no error=");
  EXPECT_EQ(refusal("--error .1 --seed 4"), "seed=0, this render has seed=4");
  expect_line(run("merge kept -o x.png"),
              1,
              "kept: error: the checkpoint of a picture by --error, --time or --aa adaptive, which "
              "has no parts");
  EXPECT_EQ(folder_.read("kept"), bytes);
  std::string bad = bytes;
  bad[bad.size() / 2] ^= 4;
  folder_.write("kept", bad);
  expect_line(run("render ball.nff --quiet --checkpoint kept --error .1"),
              1,
              "kept: error: damaged: its checksum is wrong");
  EXPECT_EQ(folder_.read("kept"), bad);
}

TEST_F(LongWork, ACheckpointOfAnotherPictureIsLeftAlone) {
  ASSERT_EQ(run("render ball.nff --rows 0:8 -o kept.grelha").status, 0);
  const std::string bytes = folder_.read("kept.grelha"),
                    advice = ": name another file, or remove this one to begin again";
  const std::string error = "grelha: error: --checkpoint: kept.grelha ";
  expect_line(run("render ball.nff --checkpoint kept.grelha"),
              2,
              error + "is of another part, rows 0:8, samples 0:1" + advice);
  expect_line(run("render ball.nff --checkpoint kept.grelha --seed 2 --rows 0:8 -o x.grelha"),
              2,
              error + "has seed=0, this render has seed=2" + advice);
  folder_.write("other.nff", std::string(kBall) + "s 0 0 0 2\n");
  expect_line(run("render other.nff --checkpoint kept.grelha --rows 0:8 -o x.grelha"),
              2,
              error + "is of another scene" + advice);
  expect_line(run("render ball.nff --checkpoint other.nff"),
              1,
              "other.nff: error: not a .grelha partial this program reads");
  EXPECT_EQ(folder_.read("kept.grelha"), bytes);
  EXPECT_EQ(run("render ball.nff --checkpoint kept.grelha --rows 0:8 -o x.grelha").status, 0)
      << "all done: there is only the file to write";
  EXPECT_EQ(folder_.read("x.grelha"), bytes);
}

/// The picture of 64 x 64 has 48 KiB, its sums 96. Files may have 70: the shell counts in 512
/// bytes. The thread sanitizer keeps a file of its own in TMPDIR, which it must not fill either; it
/// does without where it cannot.
TEST_F(LongWork, AFullDiskIsOneLine) {
  const std::string full = "ulimit -f 140; TMPDIR=/nowhere",
                    job = "render ball.nff --quiet --size 64x64 --samples 65 ";
  expect_line(run(job + "-o x.grelha", full), 1, "x.grelha: error: cannot write: File too large");
  expect_line(run(job + "-o x.pfm --checkpoint kept --checkpoint-every 1e-9", full),
              0,
              "kept: error: cannot write: File too large (rendering goes on)");
  EXPECT_EQ(folder_.list(), "ball.nff x.pfm");
  ASSERT_EQ(run(job + "-o a.grelha").status, 0);
  expect_line(
      run("merge a.grelha -o b.grelha", full), 1, "b.grelha: error: cannot write: File too large");
  EXPECT_EQ(folder_.list(), "a.grelha ball.nff x.pfm");
}

/// Two runs at the same time; each saves continually, and either may end first.
TEST_F(LongWork, RunsThatShareACheckpointAreTold) {
  const std::string program = " '" GRELHA_PROGRAM "' ",
                    job = std::string(kJobs[0]) + "--checkpoint kept --checkpoint-every 1e-9 -o ";
  const Outcome outcome = run(job + "x.pfm", "(" + program + job + "y.pfm 2>/dev/null &) && ");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  while (!std::filesystem::exists(folder_.file("y.pfm")))  // the other ends soon
    usleep(10000);
  EXPECT_EQ(outcome.err.find("No such file"), outcome.err.npos) << outcome.err;
  EXPECT_NE(outcome.err.find("kept: warning: another run saves there as well, and each writes over "
                             "the other's: give each its own --checkpoint\n"),
            outcome.err.npos)
      << outcome.err;
  EXPECT_TRUE(folder_.read("x.pfm") == folder_.read("y.pfm"));
}

TEST_F(LongWork, MergeDoesNotWriteOverAPart) {
  ASSERT_EQ(run("render ball.nff --rows 0:8 -o a.grelha").status, 0);
  ASSERT_EQ(run("render ball.nff --rows 8:16 -o b.grelha").status, 0);
  const std::string part = folder_.read("a.grelha");
  std::filesystem::create_symlink("a.grelha", folder_.file("link.grelha"));
  for (const std::string output : {"a.grelha", "./a.grelha", "link.grelha"})
    expect_line(run("merge b.grelha a.grelha -o " + output),
                2,
                "grelha: error: -o: expected another file than a.grelha, which is read, found \"" +
                    output + '"');
  EXPECT_EQ(folder_.read("a.grelha"), part);
  EXPECT_EQ(run("merge b.grelha a.grelha -o c.grelha").status, 0);
}

TEST_F(LongWork, APictureThatCannotBeWrittenLeavesTheCheckpoint) {
  if (!std::filesystem::exists("/dev/full"))
    GTEST_SKIP() << "no /dev/full";
  std::filesystem::create_symlink("/dev/full", folder_.file("full.pfm"));
  expect_line(run("render ball.nff --quiet -o full.pfm --checkpoint kept"),
              1,
              "full.pfm: error: cannot write: No space left on device");
  ASSERT_EQ(run("render ball.nff --quiet -o whole.pfm").status, 0);
  EXPECT_EQ(share_done(read_partial(folder_.file("kept")).sums), 1);
  ASSERT_EQ(run("render ball.nff --quiet -o x.pfm --checkpoint kept").status, 0);
  EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
}

TEST_F(LongWork, AFolderThatCannotBeWrittenIsToldBeforeTheWork) {
  // to root no folder is read-only
  const std::string file = geteuid() == 0 ? "/proc/x.grelha" : "locked/x.grelha";
  std::filesystem::create_directory(folder_.file("locked"));
  std::filesystem::permissions(
      folder_.file("locked"),
      std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  for (const std::string option : {"-o ", "--checkpoint "}) {
    const Outcome outcome =
        run("render ball.nff --samples 65536 --size 4000x4000 " + option + file);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_TRUE(outcome.err.starts_with(file + ": error: cannot write: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  }
}

}  // namespace
}  // namespace grelha
