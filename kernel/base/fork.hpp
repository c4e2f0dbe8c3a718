#pragma once
// Starts OpenMP threads safely in a forked process.

#include <functional>

namespace grelha {

/// Calls work(), which may start OpenMP threads.
///
/// A fork does not copy the parent's threads, but libgomp in the child still counts on those that
/// the calling thread's team had, and waits for them for ever. A team belongs to the thread that
/// starts it. So a forked process calls work() in a new thread, which starts a team of its own.
/// Exceptions of work() are thrown on.
void run_fork_safe(const std::function<void()>& work);

}  // namespace grelha
