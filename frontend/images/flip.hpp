#pragma once
// LDR-FLIP: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images", Proceedings of the ACM on Computer Graphics and
// Interactive Techniques 3 (2020).

#include <vector>

#include "grelha/image.hpp"

namespace grelha {

/// Computes the visible difference at each pixel, when two pictures of sRGB values from 0 to 1
/// alternate on a screen of 67 pixels a degree: from 0 to 1, [height * width].
std::vector<float> flip(const Image& a, const Image& b);

}  // namespace grelha
