#pragma once

namespace grelha {

/// While one lives, SIGHUP, SIGINT and SIGTERM are noted and answered on stderr at once instead of
/// ending the program, each the first time. A pipe that nobody reads any more ends nothing either:
/// whoever read it may have got the same Ctrl-C.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int seen();  ///< one of them, or 0
};

/// The name of one of these signals.
const char* signal_name(int signal);

}  // namespace grelha
