#pragma once
// Renders of one scene by the program, in a folder of their own.

#include "tests/support/running.hpp"

#include <gtest/gtest.h>

namespace grelha::test {

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

/// Some 0.3 s of work for one thread each: as many samples in every pixel, by error, so many
/// samples in all, by subdivision.
inline constexpr const char* kJobs[] = {
    "render ball.nff --quiet --size 120x80 --samples 1500 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9 --shadows random:2 --error .0002 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9 --time samples:7000000 --threads 1 ",
    "render ball.nff --quiet --size 120x80 --lens 9,0,40 --aa adaptive:.02,5 --threads 1 "};

}  // namespace grelha::test
