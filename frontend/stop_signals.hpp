#pragma once

namespace grelha {

/// While one lives, SIGHUP, SIGINT and SIGTERM are noted instead of ending the program, each the first time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int seen();  ///< one of them, or 0
};

/// Of one of them.
const char* signal_name(int signal);

}  // namespace grelha
