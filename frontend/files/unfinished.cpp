#include "frontend/files/unfinished.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <initializer_list>

namespace grelha {
namespace {

/// Null where there is room. More than these are written by nobody at once, and
/// would only not be removed.
std::array<std::atomic<const char*>, 8> unfinished_names{};
static_assert(std::atomic<const char*>::is_always_lock_free, "a handler may take no lock");

/// A thread creates a file, or the program ends: one waits for the other.
enum class Doing { kNeither, kCreating, kEnding };
std::atomic<Doing> doing = Doing::kNeither;
static_assert(std::atomic<Doing>::is_always_lock_free, "a handler may take no lock");

/// Async-signal-safe.
void wait_a_moment() {
  poll(nullptr, 0, 1);
}

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM})
    sigaddset(&set, signal);
  return set;
}

bool replace(const char* from, const char* to) {
  for (auto& name : unfinished_names)
    if (const char* expected = from; name.compare_exchange_strong(expected, to))
      return true;
  return false;
}

}  // namespace

Unfinished::Unfinished(const char* name) : name_(replace(nullptr, name) ? name : nullptr) {}

Unfinished::~Unfinished() {
  if (name_)
    replace(name_, nullptr);
}

CreatesFile::CreatesFile() {
  const sigset_t stop = stop_signals();
  pthread_sigmask(SIG_BLOCK, &stop, &before_);
  for (Doing expected = Doing::kNeither; !doing.compare_exchange_weak(expected, Doing::kCreating);
       expected = Doing::kNeither)
    wait_a_moment();
}

CreatesFile::~CreatesFile() {
  doing = Doing::kNeither;
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void handle_stop_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction old {};
    sigaction(signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr);
  }
}

/// Calls only async-signal-safe functions.
void remove_and_end(int signal) {
  for (Doing expected = Doing::kNeither;
       !doing.compare_exchange_strong(expected, Doing::kEnding) && expected != Doing::kEnding;
       expected = Doing::kNeither)
    wait_a_moment();
  for (const auto& name : unfinished_names)
    if (const char* const file = name)
      unlink(file);
  ::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace grelha
