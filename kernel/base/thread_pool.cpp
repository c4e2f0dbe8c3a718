#include "kernel/base/thread_pool.hpp"

#include <atomic>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include <pthread.h>

namespace grelha {
namespace {

std::atomic<int> more_follow = 0;

/// A thread that sleeps until it is asked.
class Worker {
 public:
  /// Throws std::system_error when there can be no more threads.
  Worker() {
    std::thread([this] { serve(); }).detach();
  }

  void ask(const std::function<void()>& work) {
    work_ = &work;
    state_ = kAsked;
    state_.notify_one();
  }
  /// Takes back what it was asked and has not begun; else waits until it is done.
  void dismiss() {
    int asked = kAsked;
    if (state_.compare_exchange_strong(asked, kIdle))
      return;
    wait_while(kAtWork);
  }

 private:
  enum : int { kIdle, kAsked, kAtWork };

  [[noreturn]] void serve() {
    for (;;) {
      wait_while(kIdle);
      int asked = kAsked;
      if (!state_.compare_exchange_strong(asked, kAtWork))
        continue;
      (*work_)();
      state_ = kIdle;
      state_.notify_all();
    }
  }

  /// To be woken takes as long as some stretches. Who yields in place of a pause stays behind the
  /// caller, on its core.
  void wait_while(int state) {
    for (int i = 0; i < kPauses && state_ == state && (more_follow > 0 || state == kAtWork); ++i)
      pause();
    while (state_ == state)
      state_.wait(state);
  }
  static void pause() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
  }
  /// A third of a millisecond: a build has nothing to share out for about so long at a time.
  static constexpr int kPauses = 20000;

  const std::function<void()>* work_ = nullptr;
  std::atomic<int> state_ = kIdle;
};

/// All threads that there are, lent to whoever asks.
class WorkerPool {
 public:
  /// Up to so many; fewer when there can be no more threads.
  std::vector<Worker*> lend(int count) {
    const std::lock_guard lock(mutex_);
    std::vector<Worker*> lent;
    lent.reserve(static_cast<std::size_t>(count));
    while (static_cast<int>(lent.size()) < count && (!idle_.empty() || add())) {
      lent.push_back(idle_.back());
      idle_.pop_back();
    }
    return lent;
  }
  void take_back(const std::vector<Worker*>& lent) {
    const std::lock_guard lock(mutex_);
    idle_.insert(idle_.end(), lent.begin(), lent.end());
  }

 private:
  /// A member is never destroyed: its thread serves on.
  bool add() try {
    idle_.reserve(count_ + 1);  // now, so that none that is there finds no place
    idle_.push_back(new Worker);
    ++count_;
    return true;
  } catch (const std::system_error&) {
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }

  std::mutex mutex_;
  std::size_t count_ = 0;
  std::vector<Worker*> idle_;
};

WorkerPool* the_pool = nullptr;

/// Forgets the parent's threads, which do not exist in a forked process.
void forget_members() {
  the_pool = new WorkerPool;
}

/// Never destroyed: the threads sleep on while the program ends.
WorkerPool& pool() {
  static const int registered = [] {
    forget_members();
    return pthread_atfork(nullptr, nullptr, forget_members);
  }();
  static_cast<void>(registered);
  return *the_pool;
}

}  // namespace

SpinWaitScope::SpinWaitScope() {
  ++more_follow;
}
SpinWaitScope::~SpinWaitScope() {
  --more_follow;
}

void by_threads(int threads, const std::function<void()>& work) {
  if (threads < 2)
    return work();
  const std::vector<Worker*> lent = pool().lend(threads - 1);
  for (Worker* const m : lent)
    m->ask(work);
  work();
  for (Worker* const m : lent)
    m->dismiss();
  pool().take_back(lent);
}

}  // namespace grelha
