#pragma once
// How far each cell of a grid is from the nearest that holds something, by the directions in which
// that is looked for.

#include <array>
#include <cstdint>
#include <vector>

namespace grelha {

inline std::size_t cell_count(const std::array<std::uint32_t, 3>& cells) {
  return std::size_t{cells[0]} * cells[1] * cells[2];
}

/// Octants of directions: bit a of an octant is set where they go down along axis a. A field for
/// each stands behind that of all directions.
inline constexpr std::size_t kOctants = 8;
/// Grids of more cells have only the field of all directions: indices into fields are numbers of 31
/// bits, and memory is limited.
inline constexpr std::size_t kMostCellsOfOctants = std::size_t{1} << 26;

/// Number of distance fields of a grid of so many cells: 1, or 1 + kOctants.
inline std::size_t distance_fields(std::size_t cells) {
  return cells > kMostCellsOfOctants ? 1 : 1 + kOctants;
}

/// [fields][cells] and 3 more, so that four bytes can be read from any cell: Chebyshev distance of
/// each cell to the nearest with occupied != 0 in the octant that the cell is the corner of, at
/// most 255; exact. Beyond the grid there is nothing.
///
/// Method  a cell is one farther than the nearest of the seven before it, on the way of its octant.
///         The distance in all directions is the least of eight.
/// Source  Cohen & Sheffer, "Proximity Clouds", 1994; by octants after Šrámek & Kaufman, "Fast
///         Ray-Tracing of Rectilinear Volume Data Using Distance Transforms", 2000.
std::vector<std::uint8_t> distance_transform(const std::vector<std::uint8_t>& occupied,
                                             const std::array<std::uint32_t, 3>& cells,
                                             std::size_t fields);
/// In place: the first [cells] of `d` hold 0 where a cell is occupied and 255 elsewhere.
void compute_distances(std::vector<std::uint8_t>& d,
                       const std::array<std::uint32_t, 3>& cells,
                       std::size_t fields,
                       int threads);

}  // namespace grelha
