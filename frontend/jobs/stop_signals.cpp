#include "frontend/jobs/stop_signals.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

#include "frontend/files/unfinished.hpp"

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
  ::signal(signal, remove_and_end);
  const int error = errno;
  if (on_terminal)
    (void)!::write(STDERR_FILENO, kWipe.data(), kWipe.size());
  (void)!::write(STDERR_FILENO, kAnswer.data(), kAnswer.size());
  errno = error;
}

}  // namespace

StopSignals::StopSignals() {
  noted = 0;
  on_terminal = isatty(STDERR_FILENO) == 1;
  handle_stop_signals(record);
  previous_pipe = ::signal(SIGPIPE, SIG_IGN);
}

StopSignals::~StopSignals() {
  handle_stop_signals(remove_and_end);
  ::signal(SIGPIPE, previous_pipe);
}

int StopSignals::seen() {
  return noted;
}

const char* signal_name(int signal) {
  return signal == SIGHUP ? "SIGHUP" : signal == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace grelha
