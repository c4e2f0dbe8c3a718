#pragma once
// A picture by subdivision between two pieces of its work: plain data, to be copied and saved.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/image.hpp"

namespace grelha {

struct SubdivisionState {
  Image image;                     ///< tiles that are not done are black
  std::vector<std::uint8_t> done;  ///< [tiles] 1: done; see Tiles
  double share = 0;                ///< done
};

/// A picture without points. Throws std::invalid_argument for a size that has no lattice.
SubdivisionState make_subdivision(int width, int height);

/// True if rendering can produce every number. Check a loaded file with this before going on with
/// it.
bool is_valid(const SubdivisionState& s);

}  // namespace grelha
