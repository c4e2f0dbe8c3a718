#pragma once

#include <cstdint>

#include "grelha/geometry.hpp"

namespace grelha {

/// Gives triangles from `first` on normals at their corners, in arrays where no vertex has one yet.
/// A corner's is the mean of the normals of those triangles at its place that are turned by at
/// most some degrees from its own, so sharper edges stay. Vertices at one place count as one; those
/// whose corners differ are doubled.
///
/// Source    Max, "Weights for Computing Vertex Normals from Facet Normals", JGT 4(2), 1999: exact
///           where the corners lie on a sphere.
void smooth_normals(Triangles& triangles, std::uint32_t first, double most_deg);

}  // namespace grelha
