#pragma once
// Threads that help with short stretches of work, and sleep between them.

#include <functional>

namespace grelha {

/// Calls work() here, and on up to `threads` - 1 other threads meanwhile; returns when all are
/// done. Others may come late or not at all: whoever calls work() must find all that is left to do.
/// It may not throw. Safe from several threads.
///
/// OpenMP's threads spin for milliseconds where one waits for another. On a busy machine, where the
/// other is not running, a scene of 8,000 triangles took forty times as long to build with two
/// threads as with one. Here no thread waits for one that has not begun.
void by_threads(int threads, const std::function<void()>& work);

/// Says that stretches of work follow each other: while such an object exists, threads stay awake
/// for a while after each. Otherwise they sleep, and leave their cores to others.
class SpinWaitScope {
 public:
  SpinWaitScope();
  ~SpinWaitScope();
  SpinWaitScope(const SpinWaitScope&) = delete;
};

}  // namespace grelha
