#pragma once
// How a picture in work is stopped, and goes on: one protocol for every way of rendering.

#include <atomic>
#include <exception>
#include <functional>

namespace grelha {

/// Asks whether stopped work goes on all the same. No thread changes the picture meanwhile, so the
/// function may read it.
using ShouldContinue = std::function<bool()>;

/// The functions of a caller as threads may call them. No exception may leave a parallel region:
/// what a function throws stops the work, and rethrow() throws it when the work has ended.
class GuardedProgress {
 public:
  /// Either function may be empty. Both must outlive this.
  GuardedProgress(const std::function<bool(double)>& progress,
                  const ShouldContinue& should_continue)
      : progress_(progress), should_continue_(should_continue) {}
  GuardedProgress(const GuardedProgress&) = delete;
  GuardedProgress& operator=(const GuardedProgress&) = delete;

  /// True if threads must finish the work they have begun and begin nothing.
  bool stopped() const { return cancelled_; }

  /// Tells the share done, 0 to 1. For one thread at a time.
  void report(double share);

  /// Returns true if stopped work goes on all the same. Call it while no thread changes the
  /// picture. After a no it does not ask again.
  bool resume();

  void rethrow() const;

 private:
  const std::function<bool(double)>& progress_;
  const ShouldContinue& should_continue_;
  std::exception_ptr thrown_;
  std::atomic<bool> cancelled_ = false;
  bool ended_ = false;
};

}  // namespace grelha
