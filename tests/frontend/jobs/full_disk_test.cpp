// No room for a picture that is done, nor for its checkpoint.
#include <filesystem>

#include "frontend/files/memory_limit.hpp"
#include "frontend/jobs/checkpoint.hpp"
#include "tests/frontend/jobs/long_work.hpp"

namespace grelha {
namespace {

namespace fs = std::filesystem;
using test::kJobs;
using test::Outcome;

/// A disk without room is mounted at full/, or so it seems to the program; tmp/ is for what is
/// temporary.
class FullDisk : public test::LongWork {
 protected:
  FullDisk() {
    fs::create_directory(folder_.file("full"));
    fs::create_directory(folder_.file("tmp"));
  }
  void SetUp() override {
    if (!memory_can_be_limited())
      GTEST_SKIP() << "sanitizers want to be loaded first";
  }
  Outcome run_full(const std::string& arguments,
                   const std::string& before = "",
                   const std::string& temporary = "tmp") {
    return run(
        arguments,
        "TMPDIR='" + folder_.file(temporary) + "' LD_PRELOAD='" GRELHA_FULL_DISK "' " + before);
  }
  /// The one file below tmp/.
  std::string kept_elsewhere() {
    std::string found;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.file("tmp")))
      if (entry.is_regular_file())
        found += entry.path().string();
    return found;
  }
};

constexpr char kNoRoom[] = "full/x.pfm: error: cannot write: No space left on device\n";

TEST_F(FullDisk, KeepsAFinishedPictureElsewhere) {
  for (const std::string job : kJobs) {
    SCOPED_TRACE(job);
    ASSERT_EQ(run(job + "-o whole.pfm").status, 0);
    const Outcome outcome = run_full(job + "-o full/x.pfm");
    const std::string saved = kept_elsewhere();
    ASSERT_TRUE(saved.ends_with("/x.partial.grelha")) << saved;
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err,
              "grelha: all of the picture is kept in " + saved +
                  ": the same command with --checkpoint " + saved + " writes it\n" + kNoRoom);
    EXPECT_EQ(run(job + "-o full/x.pfm --checkpoint " + saved).status, 0);
    EXPECT_EQ(folder_.read("full/x.pfm"), folder_.read("whole.pfm"));
    if (job.find("--error") != job.npos)  // a finer error may go on
      fs::remove_all(fs::path(saved).parent_path());
    EXPECT_TRUE(fs::is_empty(folder_.file("tmp"))) << "done with, its folder too";
    fs::remove(folder_.file("full/x.pfm"));
  }
}

TEST_F(FullDisk, KeepsWhatASignalStopped) {
  const std::string job = std::string(kJobs[0]) + "-o full/x.pfm ";
  for (const std::string option : {"", "--checkpoint full/kept"}) {
    Outcome outcome;
    for (double seconds = .05; kept_elsewhere().empty(); seconds *= 1.3) {
      ASSERT_LT(seconds, 20);
      outcome = run_full(
          job + option,
          "timeout --foreground --preserve-status -s INT " + std::to_string(seconds) + ' ');
      fs::remove(folder_.file("full/x.pfm"));
    }
    const std::string saved = kept_elsewhere();
    if (outcome.status == 1) {
      fs::remove_all(fs::path(saved).parent_path());
      continue;  // so fast that it had come to the end
    }
    EXPECT_EQ(outcome.status, 130);
    EXPECT_NE(outcome.err.find("and saved in " + saved + ": the same command with --checkpoint " +
                               saved + " goes on from there"),
              outcome.err.npos)
        << outcome.err;
    EXPECT_EQ(run(job + "--checkpoint " + saved).status, 0);
    EXPECT_TRUE(fs::is_empty(folder_.file("tmp")));
  }
}

TEST_F(FullDisk, WithoutAnyRoomThereIsOneLine) {
  const std::string scene = folder_.file("ball.nff");
  fs::copy(scene, folder_.file("full/ball.nff"));
  const Outcome outcome = test::run(
      folder_,
      "render ball.nff --quiet -o x.pfm",
      "cd full && TMPDIR='" + folder_.file("full") + "' LD_PRELOAD='" GRELHA_FULL_DISK "' ");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "x.pfm: error: cannot write: No space left on device\n");
  std::string left;
  for (const auto& entry : fs::directory_iterator(folder_.file("full")))
    left += entry.path().filename().string() + ' ';
  EXPECT_EQ(left, "ball.nff ");
}

}  // namespace
}  // namespace grelha
