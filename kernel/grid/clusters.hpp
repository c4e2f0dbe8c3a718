#pragma once
// Clusters: many primitives in few cells, where one level of cells is not enough.

#include <cstdint>
#include <vector>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Takes clusters out of some primitives in a box: towns in a desert, where cells of a grid of that
/// density would hold too much. Each cluster is for a grid of its own, with cells of its own size.
/// `ids` (ascending) keeps the rest. At most `most` clusters are taken, each smaller than half the
/// box, so that taking ends.
///
/// Method  a thousand primitives, evenly picked, are a probe. If the mean primitive of the probe
///         shares its cell with more than kBad, cells with more than kCluster are clustered. Those
///         that touch and the cells around them are one cluster. Only then are all primitives
///         looked at.
std::vector<std::vector<std::uint32_t>> take_clusters(const Primitives& p,
                                                      std::vector<std::uint32_t>& ids,
                                                      const Box& box,
                                                      double density,
                                                      std::size_t most);

}  // namespace grelha
