#pragma once
// Timing helpers for benchmarks whose methods take turns.

#include <algorithm>
#include <vector>

#include <time.h>

namespace grelha::perf {

/// Of this thread, since some moment.
inline double cpu_ns() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// 0 of nothing.
inline double median(std::vector<double> v) {
  if (v.empty())
    return 0;
  std::sort(v.begin(), v.end());
  return (v[(v.size() - 1) / 2] + v[v.size() / 2]) / 2;
}

}  // namespace grelha::perf
