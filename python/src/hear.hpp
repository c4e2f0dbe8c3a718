#pragma once
// Work without Python's lock, which Ctrl-C stops.

#include <functional>

namespace grelha::python {

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
/// Waits for work that went on alone: libraries that it uses end with the process. Python calls it
/// when it exits.
void finish_left_work();

}  // namespace grelha::python
