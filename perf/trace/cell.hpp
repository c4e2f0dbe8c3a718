#pragma once
// The results for one scene and kind of rays.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "perf/workloads.hpp"

namespace grelha::perf {

enum Side { kGrelha, kRobust, kFast, kSides };

/// One way of tracing a set of rays, and what it took in each round.
struct Way {
  Side side;
  std::string name;
  std::function<void()> trace;
  std::vector<double> ns;  ///< a ray, by round
};

struct Cell {
  std::size_t rays = 0;
  double hit_share = 0, disagree = 0;
  std::vector<Way> ways;
  std::size_t best[kSides] = {};
  static constexpr std::size_t chosen = 0;  ///< the way that a render takes, see kModes
  TraceCounts counts;                       ///< of the render's choice
  /// The first of the ways of CallerWays; 0: there are none.
  std::size_t first_caller = 0;

  double tests() const;  ///< a ray
  double cells() const;  ///< a ray
  double lanes_busy() const;
  double packet_fallbacks() const;
  bool has_embree() const { return ways[best[kRobust]].side == kRobust; }
  /// Median over rounds of the times of one way over those of another.
  double ratio(std::size_t a, std::size_t b) const;
  /// Returns the ratios of the caller's methods to the corresponding ones of Embree: calls of one
  /// ray, streams of eight, and one stream over Embree's best method.
  std::vector<double> caller_ratios() const;
  /// Finds the best way of each side, by the rounds there were.
  void find_best();
};

}  // namespace grelha::perf
