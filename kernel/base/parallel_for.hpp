#pragma once
// Work in turns that threads take as they come, with exceptions that must not leave a thread.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

#include "kernel/base/thread_pool.hpp"

namespace grelha {

/// Stores the first exception that any thread throws.
class Thrown {
 public:
  template <class Work>
  void in(const Work& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!first_)
        first_ = std::current_exception();
    }
  }
  void on() const {
    if (first_)
      std::rethrow_exception(first_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

/// Calls work(turn, state) for each turn below `count`, `state` being one of the thread's own, made
/// by make_state().
template <class MakeState, class Work>
void each_turn(std::size_t count, int threads, const MakeState& make_state, const Work& work) {
  Thrown thrown;
  std::atomic<std::size_t> next = 0;
  const auto take_turns = [&] {
    auto state = make_state();
    for (std::size_t turn; (turn = next++) < count;)
      thrown.in([&] { work(turn, state); });
  };
  const auto useful = std::min(static_cast<std::size_t>(threads), count);
  by_threads(static_cast<int>(useful), [&] { thrown.in(take_turns); });
  thrown.on();
}

/// Calls work(turn) for each turn below `count`.
template <class Work>
void each_turn(std::size_t count, int threads, const Work& work) {
  each_turn(
      count, threads, [] { return 0; }, [&](std::size_t turn, int) { work(turn); });
}

}  // namespace grelha
