#pragma once
// What is seen of primitives from a point: the first step towards its grid.

#include <cstdint>
#include <span>
#include <vector>

#include "kernel/perspective/tiles.hpp"

namespace grelha {

struct Sight {
  SeenPages seen;
  Window window[kFaces];              ///< the part of each face that anything is seen in
  std::vector<std::uint32_t> around;  ///< ids of what is too near to have an outline, sorted
};

/// Looks at primitives `ids`. Those of `large`, which is sorted, widen no window.
void look(const Primitives& primitives,
          std::span<const std::uint32_t> ids,
          std::span<const std::uint32_t> large,
          const Viewpoint& from,
          int threads,
          Sight& to);

}  // namespace grelha
