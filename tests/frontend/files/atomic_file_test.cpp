#include "frontend/files/atomic_file.hpp"

#include "tests/support/file_error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace grelha {
namespace {

using test::error_of;

TEST(AtomicFile, AppearsOnCommitOnly) {
  TemporaryFolder folder;
  folder.write("a", "old");
  {
    AtomicFile file(folder.file("a"));
    file.stream() << "new";
    file.stream().flush();
    EXPECT_EQ(folder.read("a"), "old");
  }
  EXPECT_EQ(folder.read("a"), "old");
  EXPECT_EQ(folder.list(), "a");
  write_file(folder.file("a"), "new");
  EXPECT_EQ(folder.read("a"), "new");
  EXPECT_EQ(folder.list(), "a");
}

TEST(AtomicFile, FailuresNameThePathAndLeaveNothing) {
  TemporaryFolder folder;
  const auto missing = folder.file("no/a.png");
  EXPECT_EQ(error_of([&] { write_file(missing, "x"); }),
            missing + ": error: cannot write: No such file or directory");
  std::filesystem::create_directory(folder.file("d"));
  EXPECT_EQ(error_of([&] { write_file(folder.file("d"), "x"); }),
            folder.file("d") + ": error: cannot write: Is a directory");
  const auto below_file = folder.write("f", "") + "/a";
  EXPECT_EQ(error_of([&] { check_writable(below_file); }),
            below_file + ": error: cannot write: Not a directory");
  check_writable(folder.file("fine"));
  EXPECT_EQ(folder.list(), "d f");
}

TEST(AtomicFile, ReadOnlyFolder) {
  TemporaryFolder folder;
  std::filesystem::permissions(
      folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const std::string error = error_of([&] { write_file(folder.file("a"), "x"); });
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  if (error == "no error")
    GTEST_SKIP() << "this user may write everywhere";
  EXPECT_EQ(error, folder.file("a") + ": error: cannot write: Permission denied");
}

TEST(AtomicFile, AFullDiskIsAnErrorAndDevicesStay) {
  if (!std::filesystem::exists("/dev/full"))
    GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(error_of([] { write_file("/dev/full", "x"); }),
            "/dev/full: error: cannot write: No space left on device");
  EXPECT_EQ(error_of([] { write_file("/dev/full", std::string(100000, 'x')); }),
            "/dev/full: error: cannot write: No space left on device");
  write_file("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, WritesThroughALink) {
  TemporaryFolder folder;
  folder.write("real", "old");
  std::filesystem::create_symlink("real", folder.file("link"));
  write_file(folder.file("link"), "new");
  EXPECT_EQ(folder.read("real"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
}

TEST(AtomicFile, ALinkToNothingStaysAndItsTargetIsWritten) {
  TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  std::filesystem::create_symlink("in/second", folder.file("link"));
  std::filesystem::create_symlink("real", folder.file("in/second"));
  write_file(folder.file("link"), "new");
  EXPECT_EQ(folder.read("in/real"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("in/second")));
}

TEST(AtomicFile, KeepsTheModeOfWhatItReplaces) {
  TemporaryFolder folder;
  using std::filesystem::perms;
  const perms mode = perms::owner_read | perms::owner_write | perms::others_read;
  std::filesystem::permissions(folder.write("a", "old"), mode);
  write_file(folder.file("a"), "new");
  EXPECT_EQ(folder.read("a"), "new");
  EXPECT_EQ(std::filesystem::status(folder.file("a")).permissions(), mode);
}

TEST(AtomicFile, WritesOverWhatAKilledProgramLeft) {
  TemporaryFolder folder;
  if (const pid_t child = fork(); child == 0) {
    AtomicFile file(folder.file("a"));
    file.stream() << "half" << std::flush;
    _exit(0);  // no destructor
  } else {
    waitpid(child, nullptr, 0);
  }
  ASSERT_EQ(folder.list(), ".a.grelha-tmp");
  write_file(folder.file("a"), "new");
  EXPECT_EQ(folder.list(), "a");
  EXPECT_EQ(folder.read("a"), "new");
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotClash) {
  TemporaryFolder folder;
  const std::string name(250, 'n');  // longer than a name with something added to it may be
  {
    AtomicFile first(folder.file(name)), second(folder.file(name));
    first.stream() << "first", second.stream() << "second";
    first.commit();
    EXPECT_EQ(folder.read(name), "first");
    AtomicFile third(folder.file(name));
    third.stream() << "third";
    second.commit();
    EXPECT_EQ(folder.read(name), "second");
    third.commit();
  }
  EXPECT_EQ(folder.read(name), "third");
  EXPECT_EQ(folder.list(), name);
}

/// Whoever may write in the folder could put them in its place; a link would have its target
/// written over.
TEST(AtomicFile, LeavesAloneWhatStandsBesideItAndIsNoFile) {
  TemporaryFolder folder;
  folder.write("mine", "mine");
  std::filesystem::create_symlink("mine", folder.file(".a.grelha-tmp"));
  ASSERT_EQ(mkfifo(folder.file(".a.grelha-tmp1").c_str(), 0600), 0);
  write_file(folder.file("a"), "new");
  EXPECT_EQ(folder.read("a") + folder.read("mine"), "newmine");
  EXPECT_EQ(folder.list(), ".a.grelha-tmp .a.grelha-tmp1 a mine");
}

}  // namespace
}  // namespace grelha
