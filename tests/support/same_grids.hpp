#pragma once

#include "grelha/render.hpp"

namespace grelha::test {

/// Returns true if the grids of two worlds are equal byte for byte.
bool same_grids(const World& a, const World& b);

}  // namespace grelha::test
