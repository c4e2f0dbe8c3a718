#pragma once
// Rays exactly through vertices and edges: what filters cannot decide.

#include "grelha/geometry.hpp"
#include "perf/workloads.hpp"

namespace grelha::perf {

/// Moves vertices to a lattice of 2^16 steps across the mesh, so that differences of its points are
/// floats, and rays meet what they are aimed at.
void snap(Triangles& triangles);

/// Rays from points around a snapped mesh at vertices, or else at middles of edges. None if there
/// are less than 100 triangles: a floor of two is no mesh.
RayBuffer exact_rays(const Triangles& triangles, bool at_edges);

}  // namespace grelha::perf
