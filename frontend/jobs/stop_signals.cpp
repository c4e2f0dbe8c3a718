#include "frontend/jobs/stop_signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <initializer_list>
#include <string_view>

namespace grelha {

namespace {

/// Any thread may receive a signal, and all threads read this: sig_atomic_t is safe within one
/// thread only.
std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free, "a handler may take no lock");

bool on_terminal = false;
void (*previous_pipe)(int) = SIG_DFL;

/// Reports the signal in the handler itself, because the work in progress may take long. Calls only
/// async-signal-safe functions.
void record(int signal) {
  constexpr std::string_view kWipe = "\r\033[K";  // the bar
  constexpr std::string_view kAnswer = "grelha: stopping; once more ends it at once\n";
  noted = signal;
  const int error = errno;
  if (on_terminal)
    (void)!::write(STDERR_FILENO, kWipe.data(), kWipe.size());
  (void)!::write(STDERR_FILENO, kAnswer.data(), kAnswer.size());
  errno = error;
}

void install_handler(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction old {};
    sigaction(signal, nullptr, &old);
    // the parent process may have set a signal to be ignored
    if (old.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr);
  }
}

}  // namespace

StopSignals::StopSignals() {
  noted = 0;
  on_terminal = isatty(STDERR_FILENO) == 1;
  install_handler(record, SA_RESETHAND | SA_RESTART);
  previous_pipe = ::signal(SIGPIPE, SIG_IGN);
}

StopSignals::~StopSignals() {
  install_handler(SIG_DFL, 0);
  ::signal(SIGPIPE, previous_pipe);
}

int StopSignals::seen() {
  return noted;
}

const char* signal_name(int signal) {
  return signal == SIGHUP ? "SIGHUP" : signal == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace grelha
