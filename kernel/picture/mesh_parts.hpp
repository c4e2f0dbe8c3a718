#pragma once

#include <vector>

#include "kernel/picture/rod.hpp"

namespace grelha {

/// The connected pieces of triangles, in the order of their first ones. Triangles that share a
/// vertex are connected, by its index or (for small pieces) by its coordinates. For a piece of many
/// triangles, every so many tell where it lies.
std::vector<Rod> mesh_parts(const TriangleSpans& triangles);

}  // namespace grelha
