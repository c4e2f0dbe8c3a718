#pragma once
// The hot loops behind the functions of a Variant, as each variant_*.cpp compiles them. Included
// once per instruction set.

#include "kernel/shade/strip.hpp"
#include "kernel/query/loops.hpp"
#include "kernel/query/nearest_search.hpp"
#include "kernel/query/winding_sum.hpp"

namespace grelha::GRELHA_ISA {

extern const VariantLoops kLoops;
const VariantLoops kLoops{.closest = closest,
                          .occluded = occluded,
                          .closest_one = closest_one,
                          .occluded_one = occluded_one,
                          .closest_points = closest_points,
                          .collect = collect,
                          .winding_numbers = winding_numbers,
                          .sort_by_winding = sort_by_winding,
                          .render_strip = render_strip,
                          .render_runs = render_runs,
                          .render_points = render_points};

}  // namespace grelha::GRELHA_ISA
