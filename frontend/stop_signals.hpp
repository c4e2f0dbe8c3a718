#pragma once

namespace grelha {

/// While one lives, SIGINT and SIGTERM are noted instead of ending the program, each the first time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static int seen();  ///< SIGINT, SIGTERM or 0
};

}  // namespace grelha
