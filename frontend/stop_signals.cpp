#include "frontend/stop_signals.hpp"

#include <signal.h>

#include <csignal>
#include <initializer_list>

namespace grelha {

namespace {

volatile std::sig_atomic_t noted = 0;

void act(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) {
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

}  // namespace grelha
