#include "frontend/files/unfinished.hpp"

#include <signal.h>
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
  for (const auto& name : unfinished_names)
    if (const char* const file = name)
      unlink(file);
  ::signal(signal, SIG_DFL);
  raise(signal);
}

}  // namespace grelha
