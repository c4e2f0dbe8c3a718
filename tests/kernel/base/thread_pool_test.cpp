// Threads that share work: all of it is done once, whoever asks, and from wherever.
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kernel/base/parallel_for.hpp"

namespace grelha::test {
namespace {

/// How often each of so many turns was taken.
std::vector<int> turns_taken(std::size_t count, int threads) {
  std::vector<std::atomic<int>> taken(count);
  each_turn(count, threads, [&](std::size_t i) { ++taken[i]; });
  return {taken.begin(), taken.end()};
}

TEST(Crew, TakesEachTurnOnce) {
  for (const int threads : {1, 2, 3, 16})
    for (const std::size_t count : {0u, 1u, 2u, 15u, 1000u})
      for (int again = 0; again < 20; ++again)
        ASSERT_EQ(turns_taken(count, threads), std::vector<int>(count, 1)) << threads;
}

TEST(Crew, ServesSeveralThreadsAtOnce) {
  std::atomic<int> wrong = 0;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller)
    callers.emplace_back([&] {
      for (int again = 0; again < 200; ++again)
        wrong += turns_taken(64, 3) != std::vector<int>(64, 1);
    });
  for (std::thread& caller : callers)
    caller.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Crew, ServesItsOwnMembers) {
  std::atomic<int> wrong = 0;
  each_turn(8, 4, [&](std::size_t) { wrong += turns_taken(64, 3) != std::vector<int>(64, 1); });
  EXPECT_EQ(wrong, 0);
}

/// Each thread has its own state, and there are no more threads than requested.
TEST(Crew, HasNoMoreMembersThanThreads) {
  for (const int threads : {1, 2, 5}) {
    std::atomic<int> states = 0, at_once = 0, most = 0;
    each_turn(
        200,
        threads,
        [&] { return ++states; },
        [&](std::size_t, int) {
          const int now = ++at_once;
          std::this_thread::sleep_for(std::chrono::microseconds(200));  // so that others begin
          for (int seen = most; seen < now && !most.compare_exchange_weak(seen, now);) {
          }
          --at_once;
        });
    EXPECT_GE(states, 1);
    EXPECT_LE(states, threads);
    EXPECT_LE(most, threads);
  }
}

TEST(Crew, HandsOnWhatIsThrown) {
  for (const int threads : {1, 4}) {
    const auto work = [](std::size_t i) {
      if (i == 17)
        throw std::runtime_error("seventeen");
    };
    EXPECT_THROW(each_turn(100, threads, work), std::runtime_error);
    EXPECT_THROW(
        each_turn(
            100, threads, []() -> int { throw std::bad_alloc(); }, [](std::size_t, int) {}),
        std::bad_alloc);
  }
}

/// A forked child has no threads of its parent and does not wait for them.
TEST(Crew, OutlivesAFork) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the thread sanitizer lets no child start threads";
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
  GTEST_SKIP() << "the thread sanitizer lets no child start threads";
#endif
#endif
  ASSERT_EQ(turns_taken(100, 4), std::vector<int>(100, 1));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0)
    _exit(turns_taken(100, 4) == std::vector<int>(100, 1) ? 0 : 1);
  int status = 1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace grelha::test
