#pragma once
// Groups of triangles and rays, and what is true of them.

#include <vector>

#include "perf/precision_loops.hpp"

namespace grelha::perf {

/// Of each ray: t of its nearest hit, and which triangle or primitive it was, -1 for none.
struct Truth {
  std::vector<double> t;
  std::vector<int> triangle;
};

/// Triangles of any shape, closed hulls, and triangles to time: at most four times as long as wide.
struct Workload {
  Pairs random, hulls, timed;
  Truth truth;  ///< of `random`
  explicit Workload(int groups);
};

}  // namespace grelha::perf
