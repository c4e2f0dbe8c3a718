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

#include <pthread.h>
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

using Clock = std::chrono::steady_clock;

/// Lets Python's handlers run, here, at most every kInterval.
class Listener {
 public:
  bool goes_on(Unlocked& unlocked) {
    const Clock::time_point now = Clock::now();
    if (raised_ || now - heard_ < kInterval)
      return !raised_;
    heard_ = now;
    unlocked.lock();
    if (PyErr_CheckSignals() != 0)
      raised_.emplace();
    unlocked.unlock();
    return !raised_;
  }
  const std::optional<py::error_already_set>& raised() const { return raised_; }

 private:
  Clock::time_point heard_ = Clock::now();
  std::optional<py::error_already_set> raised_;
};

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

/// Waits for work that went on alone: libraries that it uses end with the process.
void finish_left_work() {
  std::vector<LeftWork> left = std::exchange(left_work(), {});
  const py::gil_scoped_release unlocked;
  for (LeftWork& work : left)
    if (work.process == getpid())
      work.thread.join();
    else
      work.thread.detach();
}

constexpr std::chrono::milliseconds kAtEnd{250};  ///< in which Python ends, once it has begun to
constexpr std::chrono::seconds kMostAtEnd{5};     ///< for which its end waits

std::atomic<int> calls_with_lock = 0;  ///< under way, and not in an Unlocked
std::atomic<Clock::rep> end_began = 0;
std::atomic<std::thread::id> ending_thread{};

/// Where Python has begun to end, waits for it to have ended. It may go on, for handlers of other
/// modules want these threads.
void wait_for_end() {
  if (end_began == 0 || ending_thread.load() == std::this_thread::get_id())
    return;
  while (Clock::now() < Clock::time_point(Clock::duration(end_began)) + kAtEnd)
    std::this_thread::sleep_for(kInterval);
}

}  // namespace

CallUnderWay::CallUnderWay() {
  ++calls_with_lock;
  if (end_began != 0)
    const Unlocked waits;
}
CallUnderWay::~CallUnderWay() {
  --calls_with_lock;
}

void Unlocked::unlock() {
  --calls_with_lock;
  state_ = PyEval_SaveThread();
}

void Unlocked::lock() {
  wait_for_end();
  try {
    PyEval_RestoreThread(std::exchange(state_, nullptr));
  } catch (...) {  // of pthread_exit(), which Python calls when it has ended: never to be left
    for (;;)
      pause();
  }
  ++calls_with_lock;
}

namespace {

/// Python calls it when it ends, while other threads can still have its lock.
void finish_calls() {
  ending_thread = std::this_thread::get_id();
  end_began = Clock::now().time_since_epoch().count();
  finish_left_work();
  const py::gil_scoped_release unlocked;
  const Clock::time_point began = Clock::now();
  end_began = began.time_since_epoch().count();
  while (calls_with_lock > 0 && Clock::now() - began < kMostAtEnd)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

void count_calls() {
  pthread_atfork(nullptr, nullptr, [] { calls_with_lock = 0; });  // the others are not there
  py::module_::import("atexit").attr("register")(py::cpp_function(finish_calls));
}

void hear_signals(const std::function<void(const Progress&)>& work) {
  std::exception_ptr thrown;
  std::optional<py::error_already_set> raised;
  {
    Unlocked unlocked;
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
      unlocked.lock();
      if (PyErr_CheckSignals() != 0) {
        raised.emplace();
        stop = true;
      }
      unlocked.unlock();
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
    Unlocked unlocked;
    work([&](double) { return listener.goes_on(unlocked); });
  } catch (const Stopped&) {
  }
  if (listener.raised())
    throw py::error_already_set(*listener.raised());
}

void hear_signals_beside(const std::function<void()>& work) {
  struct Run {
    std::function<void()> work;
    std::exception_ptr thrown{};
    Done done{};
  };
  const auto run = std::make_shared<Run>();
  run->work = work;
  {
    Unlocked unlocked;
    std::thread worker([run] {
      try {
        run->work();
      } catch (...) {
        run->thrown = std::current_exception();
      }
      run->done.set();
    });
    while (!run->done.wait()) {
      unlocked.lock();
      if (PyErr_CheckSignals() != 0) {
        left_work().push_back({getpid(), std::move(worker)});
        throw py::error_already_set();
      }
      unlocked.unlock();
    }
    worker.join();
  }
  if (run->thrown)
    std::rethrow_exception(run->thrown);
}

}  // namespace grelha::python
