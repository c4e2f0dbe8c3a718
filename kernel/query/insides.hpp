#pragma once
// Insides of runs of points.

#include "grelha/inside.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// Tells which points lie inside: inside[i] is 1 or 0. For runs of one thread.
void find_insides(const Variant& variant,
                  const World& world,
                  std::span<const Float3> points,
                  std::uint8_t* inside);

}  // namespace grelha
