// What `grelha compare` says and writes.
#include "tests/frontend/cli/program.hpp"

#include <gtest/gtest.h>

#include <string>

namespace grelha {
namespace {

using test::Outcome;
using test::Program;

TEST_F(Program, ComparesAndSetsItsStatus) {
  ASSERT_EQ(run("render ball.nff -o a.pfm --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o b.png --quiet").status, 0);
  ASSERT_EQ(run("render ball.nff -o c.png --quiet --size 8x8").status, 0);
  EXPECT_EQ(run("compare a.pfm a.pfm --max-rmse 0").out,
            "RMSE 0, largest difference 0 at (0, 0), 0 of 384 pixels differ\n");
  EXPECT_EQ(run("compare a.pfm a.pfm --max-rmse 0").status, 0);
  EXPECT_EQ(run("compare a.pfm b.png --max-rmse 0.01").status, 0) << "half a byte at most";
  EXPECT_EQ(run("compare a.pfm b.png --max-rmse 0").status, 1);
  const Outcome sizes = run("compare a.pfm c.png");
  EXPECT_EQ(sizes.status, 2);
  EXPECT_EQ(sizes.err, "grelha: error: the pictures have unequal sizes, 24x16 and 8x8\n");
  EXPECT_EQ(run("compare a.pfm no.png").status, 1);
}

TEST_F(Program, ComparesWhatAScreenShows) {
  using namespace std::string_literals;
  folder_.write("two.pfm", "PF\n1 1\n-1\n\0\0\0\x40\0\0\0\x40\0\0\0\x40"s);
  folder_.write("four.pfm", "PF\n1 1\n-1\n\0\0\x80\x40\0\0\x80\x40\0\0\x80\x40"s);
  EXPECT_EQ(run("compare two.pfm four.pfm --max-rmse 1").status, 1);
  EXPECT_EQ(run("compare two.pfm four.pfm --max-rmse 0 --display").status, 0);
}

}  // namespace
}  // namespace grelha
