#pragma once
// The built program in a folder with one scene.

#include "tests/support/running.hpp"

#include <gtest/gtest.h>

namespace grelha::test {

class Program : public testing::Test {
 protected:
  Program() { folder_.write("ball.nff", kBall); }
  Outcome run(const std::string& arguments) { return test::run(folder_, arguments); }
  TemporaryFolder folder_;
};

}  // namespace grelha::test
