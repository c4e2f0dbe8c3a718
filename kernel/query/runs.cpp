#include "kernel/query/runs.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <omp.h>
#include <stdexcept>
#include <string>
#include <utility>

#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOneThread = 4096;  ///< elements that are not worth a second thread
/// Runs get longer below the first, and shorter beyond the second.
constexpr std::chrono::milliseconds kShort{1};
constexpr std::chrono::milliseconds kLong{10};

int thread_count(int threads) {
  if (threads < 0)
    throw std::invalid_argument("threads: expected 0 or more, found " + std::to_string(threads));
  return threads > 0 ? threads : omp_get_num_procs();
}

/// Tells the caller how far the runs are, one thread at a time.
class RunProgress {
 public:
  RunProgress(std::size_t count, const std::function<bool(double)>& report)
      : count_(count), report_(report) {}

  void add(std::size_t elements) {
    if (!report_ || elements == 0)
      return;
    const std::lock_guard lock(mutex_);
    done_ += elements;
    if (!stopped_ && !report_(static_cast<double>(done_) / static_cast<double>(count_)))
      stopped_ = true;
  }
  bool stopped() const { return stopped_; }
  void throw_if_stopped() const {
    if (stopped_)
      throw Stopped();
  }

 private:
  std::size_t count_, done_ = 0;
  const std::function<bool(double)>& report_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
};

/// How many elements a thread takes at once: the more, the faster they are.
class RunLength {
 public:
  explicit RunLength(RunLengths lengths) : length_(lengths.first), most_(lengths.most) {}

  std::size_t elements() const { return length_; }
  void took(Clock::duration time) {
    if (time < kShort)
      length_ = std::min(most_, 4 * length_);
    else if (time > kLong)
      length_ = std::max<std::size_t>(1, length_ / 4);
  }

 private:
  std::size_t length_, most_;
};

}  // namespace

void each_run(std::size_t count,
              const QueryOptions& options,
              const std::function<void(std::size_t first, std::size_t end)>& work,
              RunLengths lengths) {
  const int threads = thread_count(options.threads);
  if (!options.progress && (threads == 1 || count <= kOneThread)) {
    if (count > 0)
      work(0, count);
    return;
  }
  RunProgress progress(count, options.progress);
  std::atomic<std::size_t> next = 0;
  const auto take_runs = [&](std::size_t) {
    RunLength length(lengths);
    std::size_t unsaid = 0;
    Clock::time_point began = Clock::now();
    Clock::time_point said = began;
    while (!progress.stopped()) {
      const std::size_t first = next.fetch_add(length.elements());
      if (first >= count)
        break;
      const std::size_t end = std::min(count, first + length.elements());
      work(first, end);
      unsaid += end - first;
      const Clock::time_point now = Clock::now();
      length.took(now - began);
      began = now;
      if (now - said < kShort)
        continue;
      progress.add(std::exchange(unsaid, 0));
      said = now;
    }
    progress.add(unsaid);
  };
  const std::size_t useful = (count + kOneThread - 1) / kOneThread;
  const std::size_t takers = std::min(static_cast<std::size_t>(threads), useful);
  each_turn(takers, static_cast<int>(takers), take_runs);
  progress.throw_if_stopped();
}

void expect_same_size(std::size_t count, std::size_t answers, const char* things) {
  if (count != answers)
    throw std::invalid_argument("expected an answer for each of " + std::to_string(count) + ' ' +
                                things + ", found room for " + std::to_string(answers));
}

}  // namespace grelha
