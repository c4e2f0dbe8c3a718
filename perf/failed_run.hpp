#pragma once
// Runs of Google Benchmark that ended by SkipWithError(): 1.8 named their members anew.

#include <string>

namespace grelha::perf {

/// Whether a run failed. Run is benchmark::BenchmarkReporter::Run.
template <class Run>
bool is_failed(const Run& run) {
  if constexpr (requires { run.error_occurred; })
    return run.error_occurred;
  else
    return run.skipped != decltype(run.skipped){};
}

/// Why it failed.
template <class Run>
const std::string& why_failed(const Run& run) {
  if constexpr (requires { run.error_message; })
    return run.error_message;
  else
    return run.skip_message;
}

}  // namespace grelha::perf
