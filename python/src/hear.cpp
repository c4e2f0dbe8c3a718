#include "src/hear.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include <pybind11/pybind11.h>

namespace py = pybind11;

namespace grelha::python {
namespace {

constexpr std::size_t kFew = 4096;
constexpr std::chrono::milliseconds kInterval{50};  ///< between looks for a signal

/// A flag that one thread sets and another waits for.
class Done {
 public:
  void set() {
    const std::lock_guard lock(mutex_);
    done_ = true;
    changed_.notify_one();
  }
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kInterval, [&] { return done_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool done_ = false;
};

}  // namespace

void hear_signals(const std::function<void(const Progress&)>& work) {
  std::exception_ptr thrown;
  std::optional<py::error_already_set> raised;
  {
    const py::gil_scoped_release unlocked;
    std::atomic<bool> stop = false;
    Done done;
    std::thread worker([&] {
      try {
        work([&](double) { return !stop; });
      } catch (...) {
        thrown = std::current_exception();
      }
      done.set();
    });
    while (!done.wait()) {
      if (stop)
        continue;
      const py::gil_scoped_acquire locked;
      if (PyErr_CheckSignals() != 0) {
        raised.emplace();
        stop = true;
      }
    }
    worker.join();
  }
  if (raised)
    throw py::error_already_set(*raised);
  if (thrown)
    std::rethrow_exception(thrown);
}

void hear_signals(std::size_t count, const std::function<void(const Progress&)>& work) {
  if (count > kFew)
    return hear_signals(work);
  const py::gil_scoped_release unlocked;
  work({});
}

}  // namespace grelha::python
