// Signals and time stop the program, and the same command goes on.
#include "frontend/files/atomic_file.hpp"
#include "frontend/files/unfinished.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "frontend/jobs/stop_signals.hpp"
#include "tests/frontend/jobs/long_work.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace grelha {
namespace {

using test::kJobs;
using test::LongWork;
using test::Outcome;

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
    const bool by_error = job.find("--error") != job.npos;
    EXPECT_EQ(std::filesystem::exists(folder_.file("kept")), by_error)
        << "done with, unless a finer error may go on";
    std::filesystem::remove(folder_.file("kept"));
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
    for (double seconds = .05;
         run(std::string(any) + "-o x.pfm",
             "timeout --foreground --preserve-status -s INT " + std::to_string(seconds))
             .status != 0;
         seconds *= 1.3) {
      EXPECT_FALSE(std::filesystem::exists(folder_.file("x.pfm")));
      // nothing was done yet
      if (!std::filesystem::exists(folder_.file("x.partial.grelha")))
        continue;
      ++stopped;
      EXPECT_NO_THROW(read_checkpoint(folder_.file("x.partial.grelha")));
      EXPECT_EQ(folder_.read("x.partial.pfm").size(), folder_.read("whole.pfm").size());
    }
    EXPECT_GE(stopped, 1);
    EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
    std::filesystem::remove(folder_.file("x.pfm"));
    EXPECT_EQ(folder_.list(), "ball.nff whole.pfm") << "done with";
  }
}

TEST_F(LongWork, WhatOtherPicturesLeftStays) {
  const std::string job = "render ball.nff --size 120x80 --samples 1500 -j 1 --seed ";
  const auto stop = [&](const std::string& seed) {
    for (double seconds = .05; seconds < 20; seconds *= 1.3) {
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
  EXPECT_EQ(stop("1"), "saved in ball.partial.grelha");
  EXPECT_EQ(stop("2"), "saved in ball.partial1.grelha");
  EXPECT_EQ(folder_.list(),
            "ball.nff ball.partial.grelha ball.partial.png ball.partial1.grelha ball.partial1.png");
  const std::string other =
      "grelha: ball.partial.grelha stays, which keeps another picture: it has "
      "seed=1, this render has seed=";
  EXPECT_TRUE(
      run(job + "2").err.starts_with(other + "2\ngrelha: goes on from ball.partial1.grelha, "));
  EXPECT_EQ(run(job + "3 --strict").err, other + "3\n") << "which is no warning";
  EXPECT_EQ(run(job + "3 --quiet").err, "");
  EXPECT_EQ(folder_.list(), "ball.nff ball.partial.grelha ball.partial.png ball.png");
  const std::string picture = folder_.read("ball.partial.png");
  const std::string stopped = stop("4 --checkpoint kept");
  EXPECT_EQ(stopped, "saved in kept");
  EXPECT_EQ(run(job + "4 --checkpoint kept").status, 0);
  EXPECT_EQ(folder_.list(), "ball.nff ball.partial.grelha ball.partial.png ball.png");
  EXPECT_TRUE(folder_.read("ball.partial.png") == picture);
  EXPECT_TRUE(run(job + "1").err.starts_with("grelha: goes on from ball.partial.grelha, "));
  EXPECT_EQ(folder_.list(), "ball.nff ball.png");
  folder_.write("ball.partial.grelha", "a letter");
  EXPECT_EQ(run(job + "3").err, "");
  EXPECT_EQ(folder_.read("ball.partial.grelha"), "a letter");
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
    std::filesystem::remove(folder_.file("kept"));
  }
}

/// From a finished picture, and from one that was stopped somewhere, to the bytes of a run that had
/// this error from the beginning. What has other settings is refused.
TEST_F(LongWork, AnotherErrorGoesOnFromACheckpoint) {
  const std::string job = "render ball.nff --size 120x80 --lens 9 --threads 1 ";
  const std::string fine = job + "--error .0003 ";
  ASSERT_EQ(run(fine + "-o whole.pfm").status, 0);
  ASSERT_EQ(run(job + "--error .02 -o coarse.pfm --checkpoint kept").status, 0);
  ASSERT_EQ(run(job + "--error .02 -o again.pfm --checkpoint kept").status, 0);
  EXPECT_EQ(folder_.read("again.pfm"), folder_.read("coarse.pfm"));
  expect_line(run(fine + "--seed 1 -o x.pfm --checkpoint kept"),
              2,
              "grelha: error: --checkpoint: kept has error=0.02 seed=0, this render has "
              "error=3e-04 seed=1: name another file, or remove this one to begin again");
  ASSERT_EQ(run(fine + "-o x.pfm --checkpoint kept").status, 0);
  EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
  std::filesystem::remove(folder_.file("kept"));
  int stopped = 0;
  for (double seconds = .03; stopped < 3 && seconds < 3; seconds *= 1.3) {
    stopped += run(job + "--error .0005 -o x.pfm --checkpoint kept",
                   "timeout --foreground --preserve-status -s INT " + std::to_string(seconds) + ' ')
                   .status == 130;
  }
  ASSERT_EQ(run(fine + "-o x.pfm --checkpoint kept").status, 0);
  EXPECT_EQ(folder_.read("x.pfm"), folder_.read("whole.pfm"));
}

/// The first limit ends a picture, and the program says which.
TEST_F(LongWork, SaysWhatEndedAPicture) {
  const std::string job = "render ball.nff --size 120x80 --lens 9 -o x.pfm ";
  const auto ended = [&](const std::string& by) {
    const Outcome outcome = run(job + by);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(outcome.out.rfind("; ") + 2);
  };
  EXPECT_EQ(ended("--error .02 --samples 65536 --time 1000"), "ended by the error asked for\n");
  EXPECT_EQ(ended("--error .0001 --samples 64"), "ended by the number of samples\n");
  EXPECT_EQ(ended("--error .0001 --time samples:200000"), "ended by the number of samples\n");
  EXPECT_EQ(ended("--error .000002 --time .2"), "ended by the time\n");
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
  for (const char* left : {"t.partial.png", "t.partial.grelha"})
    std::filesystem::remove(folder_.file(left));
  EXPECT_EQ(folder_.list(), "ball.nff t.nff t.ply t.png");
  const Outcome info =
      run("info t.nff t.nff", "timeout --foreground --preserve-status -s TERM .03");
  EXPECT_EQ(info.status, 143);
  EXPECT_LE(std::count(info.err.begin(), info.err.end(), '\n'), 2)
      << "the second is not begun: " << info.err;
}

/// A signal ends a program that creates one file after another: none stays.
TEST_F(LongWork, StoppedWhileItCreatesFilesLeavesNothing) {
  const std::string before = folder_.list();
  const std::string target = folder_.file("x.png");
  for (int i = 0; i < 300; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      handle_stop_signals(remove_and_end);
      for (;;)
        AtomicFile file(target);
    }
    ASSERT_GT(child, 0);
    usleep(static_cast<useconds_t>(1000 + 37 * i % 2000));
    kill(child, SIGTERM);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(folder_.list(), before) << i;
  }
}

TEST_F(LongWork, StoppedWritersLeaveNothing) {
  ASSERT_EQ(run("render ball.nff -o part.grelha --size 1500x1500 --quiet").status, 0);
  const std::string before = folder_.list();
  for (const std::string job : {"HUP scene mount --size 8 -o x.nff",
                                "INT scene mount --size 8 -o x.nff",
                                "TERM merge part.grelha -o x.png -q"}) {
    const std::size_t space = job.find(' ');
    const std::string target = job.find("x.png") == std::string::npos ? "x.nff" : "x.png";
    std::string finished;  // by a program that the signal met at its end
    const std::string stop = "timeout --foreground --preserve-status -s " + job.substr(0, space);
    int stopped = 0;
    for (double seconds = .01;
         run(job.substr(space), stop + ' ' + std::to_string(seconds) + ' ').status != 0;
         seconds *= 1.2) {
      ++stopped;
      if (std::string bytes = folder_.read(target); !bytes.empty())
        finished = std::move(bytes);
      std::filesystem::remove(folder_.file(target));
      EXPECT_EQ(folder_.list(), before) << job;
    }
    EXPECT_GT(stopped, 0);
    EXPECT_TRUE(finished.empty() || finished == folder_.read(target)) << job;
    std::filesystem::remove(folder_.file(target));
  }
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

}  // namespace
}  // namespace grelha
