#pragma once

#include <vector>

#include "kernel/adaptive/rod.hpp"

namespace grelha {

/// The connected pieces of triangles, in the order of their first ones. Triangles are connected
/// that share a vertex, by its index or (of small pieces) by its coordinates. Of a piece of many
/// triangles every so many tell where it lies.
std::vector<Rod> mesh_pieces(const TriangleSpans& triangles);

}  // namespace grelha
