#pragma once

namespace grelha {

/// While an object lives, the first SIGHUP, SIGINT or SIGTERM of each kind is recorded and answered
/// on stderr instead of ending the program; a second one ends it by remove_and_end(). SIGPIPE is
/// ignored: the reader of the pipe may have received the same Ctrl-C.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int seen();  ///< the signal, or 0
};

/// The name of one of these signals.
const char* signal_name(int signal);

}  // namespace grelha
