#pragma once
// Progress of a build, reported by the threads that build.

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>

#include "grelha/world.hpp"

namespace grelha {

class BuildProgress {
 public:
  BuildProgress() = default;  ///< reports nothing
  explicit BuildProgress(const std::function<bool(double)>& report) : report_(report) {}

  /// Starts the next stage, which has `steps` steps and takes `share` of the whole; the stages
  /// before it are done. Called by one thread.
  void expect(double share, std::size_t steps) {
    share_ = end_;
    end_ += share;
    step_ = share / static_cast<double>(std::max<std::size_t>(steps, 1));
    tell(share_);
  }
  /// Reports that a step is done. Called by any thread.
  void step() {
    if (!report_)
      return;
    const std::lock_guard one_at_a_time(mutex_);
    tell(share_ = std::min(share_ + step_, end_));
  }
  void finish() { tell(1); }

  /// True if the caller stopped the build. Called by any thread.
  bool stopped() const { return cancelled_.load(std::memory_order_relaxed); }
  void throw_if_cancelled() const {
    if (stopped())
      throw Stopped();
  }

 private:
  void tell(double share) {
    if (report_ && !stopped() && !report_(std::min(share, 1.)))
      cancelled_ = true;
  }
  std::function<bool(double)> report_;
  double share_ = 0;
  double end_ = 0;
  double step_ = 0;
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
};

}  // namespace grelha
