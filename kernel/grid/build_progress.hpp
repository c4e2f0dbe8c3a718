#pragma once
// How far a build has come, told by the threads that build.

#include <algorithm>
#include <atomic>
#include <functional>
#include <mutex>

#include "grelha/world.hpp"

namespace grelha {

class BuildProgress {
 public:
  BuildProgress() = default;  ///< nobody asks
  explicit BuildProgress(const std::function<bool(double)>& report) : report_(report) {}

  /// What comes next, in so many steps, is that share of the whole; what came before is done. By
  /// one thread.
  void expect(double share, std::size_t steps) {
    share_ = end_;
    end_ += share;
    step_ = share / static_cast<double>(std::max<std::size_t>(steps, 1));
    tell(share_);
  }
  /// One of the steps is done. By any thread.
  void step() {
    if (!report_)
      return;
    const std::lock_guard one_at_a_time(mutex_);
    tell(share_ = std::min(share_ + step_, end_));
  }
  void finish() { tell(1); }

  /// Whether it is no use to go on. By any thread.
  bool stopped() const { return stopped_.load(std::memory_order_relaxed); }
  void throw_if_stopped() const {
    if (stopped())
      throw Stopped();
  }

 private:
  void tell(double share) {
    if (report_ && !stopped() && !report_(std::min(share, 1.)))
      stopped_ = true;
  }
  std::function<bool(double)> report_;
  double share_ = 0;
  double end_ = 0;
  double step_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex mutex_;
};

}  // namespace grelha
