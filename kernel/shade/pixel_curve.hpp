#pragma once

#include <cstdint>
#include <vector>

namespace grelha {

/// The order in which the pixels of a picture draw runs of one sequence: along Morton's curve, with
/// the quarters of each square in random order. Runs of neighbours lie next to each other. Together
/// they are as even as each alone, so the errors of neighbours differ as much as errors can: blue
/// noise.
///
/// Returns   [width * height] positions, as in a picture whose sides are a power of two; they begin
///           anew after 2^32 positions.
/// Source    Ahmed & Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
///           Hierarchical Ordering of Pixels", 2020.
std::vector<std::uint32_t> drawing_places(int width, int height, std::uint32_t seed);

}  // namespace grelha
