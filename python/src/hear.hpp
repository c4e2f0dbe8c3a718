#pragma once
// Work without Python's lock, which Ctrl-C stops.

#include <cstddef>
#include <functional>

#include <Python.h>

namespace grelha::python {

/// A call of the module, from a thread that has Python's lock. When Python ends, it waits for those
/// that have the lock, for it ends their threads, and C++ has things on their stacks.
class CallUnderWay {
 public:
  CallUnderWay();
  ~CallUnderWay();
  CallUnderWay(const CallUnderWay&) = delete;
};

/// Python's lock, given back while this lives. A thread that wants it again when Python has ended
/// stays here for good, as in Python 3.14: earlier ones end it by pthread_exit(), which no
/// destructor survives.
class Unlocked {
 public:
  Unlocked() { unlock(); }
  ~Unlocked() {
    if (state_)
      lock();
  }
  Unlocked(const Unlocked&) = delete;
  void lock();    ///< takes the lock for a time; an exception may end it then
  void unlock();  ///< gives it back again

 private:
  PyThreadState* state_ = nullptr;  ///< null while this thread has the lock
};

/// Has Python call finish_calls() when it ends.
void count_calls();

/// What long work asks whether to go on: BuildOptions::progress and the like.
using Progress = std::function<bool(double)>;

/// Calls work(progress) without the lock, on a thread of its own, and waits for it. Python's signal
/// handlers run meanwhile. If one raises, `progress` returns false from then on, and the exception
/// is thrown once the work has ended. Exceptions of work() are thrown on.
void hear_signals(const std::function<void(const Progress&)>& work);

/// The same for work of `count` rays or points. Few of them are done here, for a thread would take
/// longer than they do: `progress` itself runs the handlers, when it is asked late.
void hear_signals(std::size_t count, const std::function<void(const Progress&)>& work);

/// The same for work that cannot be asked to stop. If a handler raises, the work goes on alone, and
/// nobody sees what it does: it must own all that it reads and writes.
void hear_signals_beside(const std::function<void()>& work);

}  // namespace grelha::python
