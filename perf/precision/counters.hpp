#pragma once
// What a benchmark tells of errors and time.

#include <vector>

#include <benchmark/benchmark.h>

namespace grelha::perf {

/// How far t is off, in units in the last place of the true t as a float.
double ulps(double t, double truth);

/// How answers to rays erred.
struct Errors {
  std::vector<double> ulps;  ///< of right hits
  double rays = 0, wrong = 0, leaks = 0;
};

void set_counters(benchmark::State& state, Errors errors);
/// Nanoseconds of each of the tests, or rays, that an iteration makes.
void set_time(benchmark::State& state, double tests);

}  // namespace grelha::perf
