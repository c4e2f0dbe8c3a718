#include "frontend/stop_signals.hpp"

#include <signal.h>

#include <atomic>
#include <initializer_list>

namespace grelha {

namespace {

/// Any thread may get a signal, and all of them ask: sig_atomic_t would be for one thread alone.
std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a handler may take no lock");

void act(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction old {};
    sigaction(signal, nullptr, &old);
    if (old.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);  // whoever started the program may have it ignore one
  }
}

}  // namespace

StopSignals::StopSignals() {
  noted = 0;
  act([](int signal) { noted = signal; }, SA_RESETHAND | SA_RESTART);
}

StopSignals::~StopSignals() { act(SIG_DFL, 0); }

int StopSignals::seen() { return noted; }

const char* signal_name(int signal) { return signal == SIGHUP ? "SIGHUP" : signal == SIGINT ? "SIGINT" : "SIGTERM"; }

}  // namespace grelha
