#pragma once
// How far each cell of a grid is from the nearest that holds something.

#include <array>
#include <cstdint>
#include <vector>

namespace grelha {

/// Chebyshev distance of each cell to the nearest with occupied != 0, at most 255; exact.
///
/// Method  the least of max(|dx|, |dy|, |dz|) taken along x, then y, then z, so that each step
///         reads whole rows of bytes and threads share nothing.
std::vector<std::uint8_t> chebyshev_distance(const std::vector<std::uint8_t>& occupied,
                                             const std::array<std::uint32_t, 3>& cells);
/// In place: `d` holds 0 where a cell is occupied and 255 elsewhere.
void chebyshev_distance(std::vector<std::uint8_t>& d,
                        const std::array<std::uint32_t, 3>& cells,
                        int threads);

}  // namespace grelha
