#pragma once

#include "grelha/render.hpp"

namespace grelha::perf {

/// Whether two worlds are the same, byte for byte.
bool same_grids(const World& a, const World& b);

}  // namespace grelha::perf
