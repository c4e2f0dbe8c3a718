#include "perf/precision/counters.hpp"

#include <algorithm>
#include <cmath>

namespace grelha::perf {

double ulps(double t, double truth) {
  int exponent;
  std::frexp(truth, &exponent);
  return std::abs(t - truth) / std::ldexp(1, exponent - 24);
}

void set_counters(benchmark::State& state, Errors errors) {
  std::vector<double>& u = errors.ulps;
  std::sort(u.begin(), u.end());
  state.counters["max_ulp"] = u.empty() ? 0 : u.back();
  state.counters["p999_ulp"] = u.empty() ? 0 : u[u.size() * 999 / 1000];
  state.counters["rays"] = errors.rays;
  state.counters["wrong"] = errors.wrong;
  state.counters["leaks"] = errors.leaks;
}

void set_time(benchmark::State& state, double tests) {
  using benchmark::Counter;
  state.counters["ns"] =
      Counter(tests * 1e-9, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

}  // namespace grelha::perf
