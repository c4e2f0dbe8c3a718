#include "src/hear.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

#include <pybind11/pybind11.h>

#include "grelha/world.hpp"

namespace py = pybind11;

namespace grelha::python {
namespace {

constexpr std::size_t kFew = 4096;  ///< of these the kernel asks from the calling thread alone
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

/// Lets Python's handlers run, here, at most every kInterval.
class Listener {
 public:
  bool goes_on() {
    const Clock::time_point now = Clock::now();
    if (raised_ || now - heard_ < kInterval)
      return !raised_;
    heard_ = now;
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0)
      raised_.emplace();
    return !raised_;
  }
  const std::optional<py::error_already_set>& raised() const { return raised_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point heard_ = Clock::now();
  std::optional<py::error_already_set> raised_;
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
  Listener listener;
  try {
    const py::gil_scoped_release unlocked;
    work([&](double) { return listener.goes_on(); });
  } catch (const Stopped&) {
  }
  if (listener.raised())
    throw py::error_already_set(*listener.raised());
}

namespace {

/// Work that nobody waits for; of this process, for a forked one has no such thread.
struct LeftWork {
  pid_t process;
  std::thread thread;
};
/// Python's lock guards it. Never destroyed: it is emptied when Python exits.
std::vector<LeftWork>& left_work() {
  static auto* const left = new std::vector<LeftWork>;
  return *left;
}

}  // namespace

void hear_signals_beside(const std::function<void()>& work) {
  struct Run {
    std::function<void()> work;
    std::exception_ptr thrown{};
    Done done{};
  };
  const auto run = std::make_shared<Run>();
  run->work = work;
  {
    const py::gil_scoped_release unlocked;
    std::thread worker([run] {
      try {
        run->work();
      } catch (...) {
        run->thrown = std::current_exception();
      }
      run->done.set();
    });
    while (!run->done.wait()) {
      const py::gil_scoped_acquire locked;
      if (PyErr_CheckSignals() == 0)
        continue;
      left_work().push_back({getpid(), std::move(worker)});
      throw py::error_already_set();
    }
    worker.join();
  }
  if (run->thrown)
    std::rethrow_exception(run->thrown);
}

void finish_left_work() {
  std::vector<LeftWork> left = std::exchange(left_work(), {});
  const py::gil_scoped_release unlocked;
  for (LeftWork& work : left)
    if (work.process == getpid())
      work.thread.join();
    else
      work.thread.detach();
}

}  // namespace grelha::python
