#pragma once

#include <vector>

namespace grelha {

/// Returns a radius by which balls about points of a surface leave few gaps: a share of the median
/// distance to the third neighbour. A few points far out do not change it. Points that are not
/// finite do not count; 1 where there are no two places.
float radius_for(const std::vector<float>& x,
                 const std::vector<float>& y,
                 const std::vector<float>& z);

}  // namespace grelha
