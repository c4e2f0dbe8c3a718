#pragma once

#include <span>

#include "frontend/scene/double3.hpp"

namespace grelha {

/// Newell's sum over the corners: twice the area of each part of any surface that the outline
/// bounds, along its normal. Corners on one line give zero.
Double3 newell_sum(std::span<const Float3> corner_points);

/// The normal of a polygon of three corners or more, with twice the area as its length (Newell's
/// sum over all corners). If parts with opposite turns cancel in the sum, the normal of a triangle
/// over the corners.
Double3 polygon_normal(std::span<const Float3> corner_points);

/// `sum` or, where it is larger, the normal of a large triangle over the corners, turned as the sum
/// is, or as the first corners are.
Double3 larger_normal(std::span<const Float3> corner_points, const Double3& sum);

}  // namespace grelha
