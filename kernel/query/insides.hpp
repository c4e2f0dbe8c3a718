#pragma once
// Insides of runs of points.

#include "grelha/inside.hpp"
#include "kernel/query/variants.hpp"

namespace grelha {

/// Throws NotClosed if a rule does not take the mesh of a scene, and makes what it needs.
void prepare_insides(const World& world, InsideRule rule);

/// Tells which points lie inside: inside[i] is 1 or 0. For runs of one thread, after
/// prepare_insides().
void find_insides(const Variant& variant,
                  const World& world,
                  std::span<const Float3> points,
                  InsideRule rule,
                  std::uint8_t* inside);

}  // namespace grelha
