#pragma once
// Where one level of cells is not enough: many primitives in few of them.

#include <cstdint>
#include <vector>

#include "kernel/grid/grid.hpp"

namespace grelha {

/// Takes crowds out of some primitives in a box: what the cells of a grid of that density would
/// hold too much of, a town in a desert. Each is for a grid of its own, with cells of its own size.
/// `ids` (ascending) keeps the rest; at most `most` crowds are taken, none that is not smaller than
/// half the box, so that taking ends.
///
/// Method  a thousand primitives, evenly picked, are a probe: where by it the mean primitive shares
///         its cell with more than kBad, cells that hold more than kCrowd are crowded, and touching
///         ones, with the cells around them, one crowd. Only then are all primitives looked at.
std::vector<std::vector<std::uint32_t>> take_crowds(const Primitives& p,
                                                    std::vector<std::uint32_t>& ids,
                                                    const Box& box,
                                                    double density,
                                                    std::size_t most);

}  // namespace grelha
