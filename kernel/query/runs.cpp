#include "kernel/query/runs.hpp"

#include <atomic>
#include <mutex>
#include <omp.h>
#include <stdexcept>
#include <string>

#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

constexpr std::size_t kRun = 4096;  ///< elements that a thread takes at once, whole packets

int thread_count(int threads) {
  if (threads < 0)
    throw std::invalid_argument("threads: expected 0 or more, found " + std::to_string(threads));
  return threads > 0 ? threads : omp_get_num_procs();
}

/// Tells the caller how far the runs are, one thread at a time.
class RunProgress {
 public:
  RunProgress(std::size_t runs, const std::function<bool(double)>& report)
      : runs_(runs), report_(report) {}

  void finish_run() {
    if (!report_)
      return;
    const std::lock_guard lock(mutex_);
    ++done_;
    if (!stopped_ && !report_(static_cast<double>(done_) / static_cast<double>(runs_)))
      stopped_ = true;
  }
  bool stopped() const { return stopped_; }
  void throw_if_stopped() const {
    if (stopped_)
      throw Stopped();
  }

 private:
  std::size_t runs_, done_ = 0;
  const std::function<bool(double)>& report_;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
};

}  // namespace

void each_run(std::size_t count,
              const QueryOptions& options,
              const std::function<void(std::size_t first, std::size_t end)>& work) {
  const int threads = thread_count(options.threads);
  if (!options.progress && (threads == 1 || count <= kRun)) {
    if (count > 0)
      work(0, count);
    return;
  }
  const std::size_t runs = (count + kRun - 1) / kRun;
  RunProgress progress(runs, options.progress);
  const auto take = [&](std::size_t run) {
    if (progress.stopped())
      return;
    work(run * kRun, std::min(count, (run + 1) * kRun));
    progress.finish_run();
  };
  each_turn(runs, threads, take);
  progress.throw_if_stopped();
}

void expect_same_size(std::size_t count, std::size_t answers, const char* things) {
  if (count != answers)
    throw std::invalid_argument("expected an answer for each of " + std::to_string(count) + ' ' +
                                things + ", found room for " + std::to_string(answers));
}

}  // namespace grelha
