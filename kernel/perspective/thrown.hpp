#pragma once
// Exceptions of parallel regions.

#include <exception>
#include <mutex>

namespace grelha {

/// What was thrown first by any thread: an exception must not leave a parallel region.
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

}  // namespace grelha
