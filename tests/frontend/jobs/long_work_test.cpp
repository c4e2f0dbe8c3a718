// Parts, checkpoints and signals as a user of the program meets them.
#include "frontend/jobs/partial.hpp"
#include "frontend/jobs/stop_signals.hpp"
#include "tests/support/running.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

namespace grelha {
namespace {

using test::kBall;
using test::Outcome;

class LongWork : public testing::Test {
 protected:
  LongWork() { folder_.write("ball.nff", kBall); }

  Outcome run(const std::string& arguments, const std::string& before = "") {
    return test::run(folder_, arguments, before);
  }
  void expect_line(const Outcome& outcome, int status, const std::string& line) {
    EXPECT_EQ(outcome.status, status);
    EXPECT_EQ(outcome.err, line + '\n');
  }

  TemporaryFolder folder_;
};

TEST_F(LongWork, PartsMergeToTheBytesOfTheWhole) {
  const std::string job = "render ball.nff --quiet --lens 2 --shadows random:2 ";
  ASSERT_EQ(run(job + "--samples 20 -o whole.png").status, 0);
  ASSERT_EQ(run(job + "--samples 20 -o whole.grelha").status, 0);
  ASSERT_EQ(run(job + "--samples 0:5/20 -o a.grelha --threads 1").status, 0);
  ASSERT_EQ(run(job + "--samples 5:20/20 --rows 0:3 -o b.grelha --isa scalar").status, 0);
  ASSERT_EQ(run(job + "--samples 5:20/20 --rows 3:16 -o c.grelha --accel none").status, 0);
  const Outcome merged = run("merge c.grelha a.grelha b.grelha -o merged.png");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(merged.out, "merged.png: rows 0:16, samples 0:20 from 3 parts\n");
  EXPECT_EQ(folder_.read("merged.png"), folder_.read("whole.png"));
  EXPECT_EQ(run("merge b.grelha c.grelha -o rest.grelha --quiet").out, "");
  ASSERT_EQ(run("merge rest.grelha a.grelha -o merged.grelha").status, 0);
  EXPECT_EQ(folder_.read("merged.grelha"), folder_.read("whole.grelha"));
}

TEST_F(LongWork, SamplesOfAPartAreThoseTheSceneTakes) {
  ASSERT_EQ(run("render ball.nff --aa jitter:3 -o whole.pfm").status, 0);
  ASSERT_EQ(run("render ball.nff --aa jitter:3 --samples 0:4 -o a.grelha").status, 0);
  ASSERT_EQ(run("render ball.nff --aa jitter:3 --samples 4:9 -o b.grelha").status, 0);
  ASSERT_EQ(run("merge a.grelha b.grelha -o merged.pfm").status, 0);
  EXPECT_EQ(folder_.read("merged.pfm"), folder_.read("whole.pfm"));
  expect_line(run("render ball.nff --samples 0:4 -o c.grelha"),
              2,
              "grelha: error: --samples: 0:4 are not among the 1 samples of a pixel (I:J/N: of N)");
  expect_line(run("render ball.nff --rows 8:17 -o c.grelha"),
              2,
              "grelha: error: --rows: 8:17 are not among the 16 rows of the picture");
}

TEST_F(LongWork, RefusesPartsThatDoNotFitByName) {
  folder_.write("other.nff", std::string(kBall) + "s 0 0 0 2\n");
  ASSERT_EQ(run("render ball.nff --rows 0:8 -o a.grelha").status, 0);
  ASSERT_EQ(run("render ball.nff --rows 7:16 -o b.grelha").status, 0);
  ASSERT_EQ(run("render ball.nff --rows 9:16 -o c.grelha").status, 0);
  ASSERT_EQ(run("render other.nff --rows 8:16 -o other.grelha").status, 0);
  ASSERT_EQ(run("render ball.nff --rows 8:16 --depth 4 -o depth.grelha").status, 0);
  expect_line(run("merge a.grelha b.grelha -o x.png"),
              2,
              "grelha: error: b.grelha and a.grelha both have rows 7:8, samples 0:1");
  expect_line(run("merge a.grelha c.grelha -o x.png"),
              2,
              "grelha: error: no part has rows 8:9, samples 0:1");
  expect_line(run("merge a.grelha -o x.png"),
              2,
              "grelha: error: the parts are rows 0:8, samples 0:1, the picture is rows 0:16, "
              "samples 0:1: join them to a .grelha");
  expect_line(run("merge a.grelha other.grelha -o x.png"),
              2,
              "grelha: error: other.grelha is of another scene than a.grelha");
  expect_line(run("merge a.grelha depth.grelha -o x.png"),
              2,
              "grelha: error: depth.grelha has depth=4, a.grelha has depth=5");
  expect_line(run("merge a.grelha gone.grelha -o x.png"),
              1,
              "gone.grelha: error: cannot open: No such file or directory");
  expect_line(run("merge a.grelha ball.nff -o x.png"),
              1,
              "ball.nff: error: not a .grelha partial this program reads");
  std::string bytes = folder_.read("a.grelha");
  bytes[bytes.size() / 2] ^= 4;
  folder_.write("bad.grelha", bytes);
  expect_line(
      run("merge bad.grelha -o x.grelha"), 1, "bad.grelha: error: damaged: its checksum is wrong");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("x.png")));
}

TEST_F(LongWork, RefusesOptionsThatContradict) {
  const auto refused = [&](const std::string& options, const std::string& why) {
    expect_line(run("render ball.nff " + options), 2, "grelha: error: " + why);
  };
  refused("--rows 0:8",
          "-o: expected a name ending in .grelha for a part of a picture, found \"ball.png\"");
  refused(
      "--rows 8:8 -o a.grelha",
      "--rows: expected A:B, whole numbers, 0 or more, A below B, B at most 65536, found \"8:8\"");
  refused(
      "--samples 0:8/7 -o a.grelha",
      "--samples: expected A:B, whole numbers, 0 or more, A below B, B at most 7, found \"0:8\"");
  refused("--samples :8 -o a.grelha",
          "--samples: expected A:B, whole numbers, 0 or more, A below B, B at most 65536, found "
          "\":8\"");
  refused("--rows 0:8 --error .1 -o a.grelha",
          "parts are of pictures with as many samples in every pixel: no --error, --time or --aa "
          "adaptive");
  refused("--aa adaptive:.1,2 -o a.grelha",
          "parts are of pictures with as many samples in every pixel: no --error, --time or --aa "
          "adaptive");
  refused("--error .1 -o a.grelha",
          "parts are of pictures with as many samples in every pixel: no --error, --time or --aa "
          "adaptive");
  refused("--preview 1 -o a.grelha", "--preview wants a picture to write, not a .grelha");
  refused("--preview 0", "--preview: expected seconds above 0 and up to 1e9, found \"0\"");
  refused("-o a.grelha --checkpoint ./a.grelha",
          "--checkpoint and -o: expected two files, found \"a.grelha\" twice");
}

/// Some 0.3 s of work for one thread each: as many samples in every pixel, by error, so many
/// samples in all, by subdivision.
constexpr const char* kJobs[] = {
    "render ball.nff --quiet --size 120x80 --samples 650 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9 --shadows random:2 --error .0002 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9 --time samples:7000000 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9,0,40 --aa adaptive:.02,5 --threads 1 "};
constexpr const char* kJob = kJobs[0];

TEST_F(LongWork, SignalsStopItAndTheSameCommandGoesOn) {
  const std::pair<std::string, int> signals[] = {
      {"HUP", 129}, {"TERM", 143}, {"INT", 130}, {"INT", 130}};
  for (std::size_t i = 0; i < std::size(kJobs); ++i) {
    const char* const any = kJobs[i];
    const auto& [name, status] = signals[i];
    SCOPED_TRACE(any);
    ASSERT_EQ(run(std::string(any) + "-o whole.pfm").status, 0);
    const std::string job = std::string(any) + "-o x.pfm --checkpoint kept";
    int stopped = 0;
    Outcome outcome;
    // A little more time each turn, so that a slow machine comes to an end as well.
    const std::string stop = "timeout --foreground --preserve-status -s " + name + ' ';
    for (double seconds = .03; (outcome = run(job, stop + std::to_string(seconds))).status != 0;
         seconds *= 1.3) {
      // Ended at once, before it had begun or when it was about to end; or before there was
      // anything to save.
      const bool early = outcome.err.find(" before ball.nff") != outcome.err.npos ||
                         outcome.err.find(" while ") != outcome.err.npos;
      if (outcome.status == status && (outcome.err.empty() || early)) {
        std::filesystem::remove(folder_.file("x.pfm"));
        continue;
      }
      ASSERT_EQ(outcome.status, status);
      ++stopped;
      EXPECT_TRUE(
          outcome.err.starts_with(test::kStopping + ("grelha: stopped by SIG" + name) + ", "))
          << outcome.err;
      EXPECT_NE(outcome.err.find(" % done and saved in kept: the same command goes on from there"),
                outcome.err.npos)
          << outcome.err;
      EXPECT_NO_THROW(read_checkpoint(folder_.file("kept")));
      EXPECT_FALSE(std::filesystem::exists(folder_.file("x.pfm")));
    }
    EXPECT_GE(stopped, 1);
    EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    EXPECT_FALSE(std::filesystem::exists(folder_.file("kept"))) << "done with";
    std::filesystem::remove(folder_.file("x.pfm"));
  }
}

/// Without --checkpoint as well: the picture so far beside the picture's name, never under it, and
/// the same command goes on.
TEST_F(LongWork, StoppingLeavesSomethingToGoOnFrom) {
  for (const char* const any : kJobs) {
    SCOPED_TRACE(any);
    ASSERT_EQ(run(std::string(any) + "-o whole.pfm").status, 0);
    int stopped = 0;
    for (double seconds = .1;
         run(std::string(any) + "-o x.pfm",
             "timeout --foreground --preserve-status -s INT " + std::to_string(seconds))
             .status != 0;
         seconds *= 1.3) {
      EXPECT_FALSE(std::filesystem::exists(folder_.file("x.pfm")));
      // nothing was done yet
      if (!std::filesystem::exists(folder_.file("x.pfm.partial")))
        continue;
      ++stopped;
      EXPECT_NO_THROW(read_checkpoint(folder_.file("x.pfm.partial")));
      EXPECT_EQ(folder_.read("x.partial.pfm").size(), folder_.read("whole.pfm").size());
    }
    EXPECT_GE(stopped, 1);
    EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    std::filesystem::remove(folder_.file("x.pfm"));
    EXPECT_EQ(folder_.list(), "ball.nff whole.pfm") << "done with";
  }
}

TEST_F(LongWork, WhatOtherPicturesLeftStays) {
  const std::string job = "render ball.nff --size 120x80 --samples 600 -j 1 --seed ";
  const auto stop = [&](const std::string& seed) {
    for (double seconds = .1; seconds < 20; seconds *= 1.3) {
      const Outcome outcome = run(
          job + seed, "timeout --foreground --preserve-status -s INT " + std::to_string(seconds));
      if (outcome.status == 0)
        return std::string("finished");
      const std::size_t at = outcome.err.find("saved in ");
      if (at != outcome.err.npos)
        return outcome.err.substr(at, outcome.err.find(':', at) - at);
    }
    return std::string("too slow");
  };
  EXPECT_EQ(stop("1"), "saved in ball.png.partial");
  EXPECT_EQ(stop("2"), "saved in ball.png.partial1");
  EXPECT_TRUE(run(job + "2").err.starts_with("grelha: goes on from ball.png.partial1, "));
  EXPECT_TRUE(std::filesystem::exists(folder_.file("ball.png.partial"))) << "the first's";
  EXPECT_FALSE(std::filesystem::exists(folder_.file("ball.png.partial1")));
  folder_.write("ball.png.partial", "a letter");
  EXPECT_EQ(run(job + "3").err, "");
  EXPECT_EQ(folder_.read("ball.png.partial"), "a letter");
}

TEST_F(LongWork, MapsAreThoseOfAnUndisturbedRun) {
  const std::string maps = " --samples-map s.pfm --error-map e.pfm ";
  for (const std::string kind : {"--error .01 ", "--time samples:300000 "}) {
    const std::string job = "render ball.nff --quiet --size 120x80 --lens 9 " + kind;
    ASSERT_EQ(run(job + maps + "-o whole.pfm").status, 0);
    const std::string samples = folder_.read("s.pfm"), error = folder_.read("e.pfm");
    std::filesystem::create_symlink("/dev/full", folder_.file("full.pfm"));
    ASSERT_EQ(run(job + "-o full.pfm --checkpoint kept --checkpoint-every .001").status, 1);
    ASSERT_EQ(run(job + maps + "-o x.pfm --checkpoint kept").status, 0)
        << "all is done: there are only the files to write";
    EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    EXPECT_EQ(folder_.read("s.pfm"), samples);
    EXPECT_EQ(folder_.read("e.pfm"), error);
    std::filesystem::remove(folder_.file("full.pfm"));
  }
}

TEST_F(LongWork, TimeCountsOverRuns) {
  const std::string job =
      "render ball.nff --size 120x80 --lens 9 --threads 1 --time 1.2 -o x.pfm --checkpoint kept";
  // Each run gets .5 s. The fourth at the latest finds the time used up, on a machine that saves at
  // once; a slow one gets more turns.
  int turns = 0;
  Outcome outcome;
  while ((outcome = run(job, "timeout --foreground --preserve-status -s INT .5 ")).status == 130)
    ASSERT_LT(++turns, 20);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GE(turns, 1);
  const std::size_t at = outcome.out.find(" samples, ");
  ASSERT_NE(at, outcome.out.npos) << outcome.out;
  const std::string count = outcome.out.substr(outcome.out.rfind(' ', at - 1) + 1,
                                               at - outcome.out.rfind(' ', at - 1) - 1);
  ASSERT_EQ(
      run("render ball.nff --size 120x80 --lens 9 -o again.pfm --time samples:" + count).status, 0);
  EXPECT_EQ(folder_.read("again.pfm"), folder_.read("x.pfm"));
}

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
  EXPECT_EQ(refusal("--error .2"), "error=0.1, this render has error=0.2");
  EXPECT_EQ(refusal("--time 2"), "error=0.1 no time=, this render has time=2 no error=");
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

TEST_F(LongWork, SignalsStopReadingAndBuilding) {
  // 820,000 triangles: some .1 s each
  ASSERT_EQ(run("scene terrain --size 40 -o t.nff").status, 0);
  bool seen[2] = {};
  Outcome outcome;
  for (double seconds = .01;
       (outcome = run("render t.nff --quiet --size 8x8",
                      "timeout --foreground --preserve-status -s INT " + std::to_string(seconds)))
           .status != 0;
       seconds *= 1.4) {
    ASSERT_EQ(outcome.status, 130) << outcome.err;
    const std::string stopped = test::kStopping + std::string("grelha: stopped by SIGINT");
    const bool reading = outcome.err == stopped + " while reading t.nff\n";
    const bool building = outcome.err == stopped + " while building the grids of t.nff\n";
    // Nothing said: it had not begun.
    EXPECT_TRUE(reading || building || outcome.err.empty() ||
                outcome.err.starts_with(stopped + ", ") ||
                outcome.err == stopped + " before t.nff\n")
        << outcome.err;
    seen[0] |= reading;
    seen[1] |= building;
  }
  EXPECT_TRUE(seen[0] && seen[1]);
  for (const char* left : {"t.partial.png", "t.png.partial"})
    std::filesystem::remove(folder_.file(left));
  EXPECT_EQ(folder_.list(), "ball.nff t.nff t.ply t.png");
  const Outcome info =
      run("info t.nff t.nff", "timeout --foreground --preserve-status -s TERM .03");
  EXPECT_EQ(info.status, 143);
  EXPECT_LE(std::count(info.err.begin(), info.err.end(), '\n'), 2)
      << "the second is not begun: " << info.err;
}

/// A signal may reach any thread, and any thread may ask; the thread sanitizer sees whether that is
/// a race.
TEST(StopSignals, OfOneThreadAreSeenByAnother) {
  const StopSignals signals;
  std::thread stopped([] { std::raise(SIGTERM); });
  while (StopSignals::seen() == 0)
    std::this_thread::yield();
  EXPECT_EQ(StopSignals::seen(), SIGTERM);
  stopped.join();
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

TEST_F(LongWork, OfSeveralScenesTheFinishedAreNotRenderedAgain) {
  const std::string job =
      "render ball.nff later.nff -o {}.pfm --checkpoint {}.kept --stats {}.json ";
  EXPECT_EQ(run(job).status, 1);
  EXPECT_EQ(folder_.list(), "ball.json ball.kept ball.nff ball.pfm");
  EXPECT_NE(folder_.read("ball.json").find("\"primary\": 384"), std::string::npos);
  const std::string picture = folder_.read("ball.pfm");
  folder_.write("later.nff", kBall);
  EXPECT_EQ(run(job).err, "");
  EXPECT_EQ(folder_.list(), "ball.json ball.nff ball.pfm later.json later.nff later.pfm");
  EXPECT_NE(folder_.read("ball.json").find("\"primary\": 0"), std::string::npos);
  EXPECT_TRUE(folder_.read("ball.pfm") == picture && folder_.read("later.pfm") == picture);
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

TEST_F(LongWork, PreviewsShowThePictureSoFar) {
  const char* const endless[] = {"--samples 65536",
                                 "--error .000002",
                                 "--time 1000",
                                 "--samples 4000 --lens 9 --aa adaptive:.001,8"};
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(endless[i]);
    ASSERT_EQ(run(std::string(kJobs[i]) + "-o whole.pfm").status, 0);
    // Stopped by a signal nothing can be done about: what is there is a preview, whole and of the
    // right size.
    for (double seconds = .1; seconds < 100 && !std::filesystem::exists(folder_.file("x.pfm"));
         seconds *= 1.5)
      run(std::string("render ball.nff --size 120x80 -o x.pfm --preview .01 ") + endless[i],
          "timeout -s KILL " + std::to_string(seconds));
    EXPECT_EQ(folder_.read("x.pfm").size(), folder_.read("whole.pfm").size());
    EXPECT_NE(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    EXPECT_NE(folder_.read("x.pfm").find_first_not_of('\0', 20), std::string::npos)
        << "something is to be seen";
    ASSERT_EQ(run(std::string(kJobs[i]) + "-o x.pfm --preview .01").status, 0);
    EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    std::filesystem::remove(folder_.file("x.pfm"));
  }
}

}  // namespace
}  // namespace grelha
