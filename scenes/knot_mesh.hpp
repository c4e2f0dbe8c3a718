#pragma once

#include "scenes/mesh.hpp"

namespace grelha::scenes {

/// A tube along a trefoil knot two units wide that stands above z = 0: 288 n^2 triangles.
Mesh knot_mesh(int n);

}  // namespace grelha::scenes
