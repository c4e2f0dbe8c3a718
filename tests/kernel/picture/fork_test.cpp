// A process that was forked after its parent had used every thread: its own renders and builds end,
// with the same bits.
#include <csignal>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "grelha/render.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr unsigned kPatience = 60;  ///< s

enum Ending { kSame, kOther, kFailed, kHung };

/// How a forked process ends that compares what `make` gives there with what it gave here.
template <class Make>
Ending ending_of_child(const Make& make) {
  const auto expected = make();
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGALRM, SIG_DFL);
    alarm(kPatience);
    try {
      _exit(make() == expected ? kSame : kOther);
    } catch (...) {
      _exit(kFailed);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? static_cast<Ending>(WEXITSTATUS(status)) : kHung;
}

Camera small_camera() {
  Camera camera;
  camera.eye = {0, 0, 4};
  camera.width = 64;
  camera.height = 48;
  return camera;
}

std::vector<float> picture(const World& world, const RenderOptions& options) {
  RenderStats stats;
  return render(world, small_camera(), options, stats).rgb;
}

RenderOptions on_threads(int threads) {
  RenderOptions options;
  options.threads = threads;
  return options;
}

class Fork : public testing::Test {
 protected:
  Scene scene_ = random_mixture(12, 400);
  World world_{scene_, {.threads = 2}};
};

TEST_F(Fork, RendersBySamples) {
  for (const int threads : {1, 2, 5})
    EXPECT_EQ(ending_of_child([&] { return picture(world_, on_threads(threads)); }), kSame);
}

TEST_F(Fork, RendersByError) {
  RenderOptions options = on_threads(2);
  options.refine.error = .05;
  EXPECT_EQ(ending_of_child([&] { return picture(world_, options); }), kSame);
}

TEST_F(Fork, RendersBySubdivision) {
  RenderOptions options = on_threads(2);
  options.subdivision = {.on = true};
  EXPECT_EQ(ending_of_child([&] { return picture(world_, options); }), kSame);
}

TEST_F(Fork, Builds) {
  EXPECT_EQ(ending_of_child([&] { return picture(World(scene_, {.threads = 2}), {}); }), kSame);
}

TEST_F(Fork, TellsWhatAChildThrows) {
  const auto stopped = [&] {
    RenderOptions options = on_threads(2);
    options.progress = [](double) -> bool { throw std::runtime_error("told"); };
    try {
      picture(world_, options);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("nothing was thrown");
  };
  EXPECT_EQ(stopped(), "told");
  EXPECT_EQ(ending_of_child(stopped), kSame);
}

TEST_F(Fork, ServesTheChildsOwnChildren) {
  EXPECT_EQ(ending_of_child(
                [&] { return ending_of_child([&] { return picture(world_, on_threads(2)); }); }),
            kSame);
}

}  // namespace
}  // namespace grelha::test
