// Parts and previews as a user of the program meets them.
#include "tests/frontend/jobs/long_work.hpp"

#include <filesystem>

namespace grelha {
namespace {

using test::kBall;
using test::kJobs;
using test::LongWork;
using test::Outcome;

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

/// The second scene comes from a pipe, whose writer waits for the first scene's checkpoint.
TEST_F(LongWork, OfSeveralScenesCheckpointsOfOthersStay) {
  folder_.write("foreign", "of another run");
  const Outcome outcome = run("render ball.nff later.nff -o {}.pfm --checkpoint {}.kept",
                              "mkfifo later.nff; (while ! test -e ball.kept; do sleep .01; done; "
                              "mv foreign ball.kept; cat ball.nff >later.nff) & ");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(folder_.list(), "ball.kept ball.nff ball.pfm later.nff later.pfm");
  EXPECT_EQ(folder_.read("ball.kept"), "of another run");
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
