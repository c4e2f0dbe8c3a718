#pragma once
// Primitives that rays leave out.

#include "kernel/base/isa.hpp"
#include "kernel/shapes/shapes.hpp"

namespace grelha::GRELHA_ISA {

/// What rays leave out, from one of them on.
struct RayFilter {
  const std::uint32_t* skip = nullptr;      ///< [rays]; null: nothing
  const std::uint8_t* ray_masks = nullptr;  ///< [rays]; null: 255 for all
  const std::uint8_t* masks = nullptr;      ///< [primitives] by id; null: 255 for all
  CopyTable copies;

  /// What ray i hits where it crosses primitive `id`: of that and its copies the first that is not
  /// left out, or kNoPrimitive.
  std::uint32_t hit_of(int i, std::uint32_t id) const {
    if (passes(i, id))
      return id;
    for (std::uint32_t c = copies.begin(id); copies.has(c, id); ++c)
      if (passes(i, copies.pair[c].copy))
        return copies.pair[c].copy;
    return kNoPrimitive;
  }
  /// The same of the rays `by` further on.
  RayFilter after(std::size_t by) const {
    RayFilter moved = *this;
    moved.skip = skip ? skip + by : nullptr;
    moved.ray_masks = ray_masks ? ray_masks + by : nullptr;
    return moved;
  }

 private:
  bool passes(int i, std::uint32_t id) const {
    const unsigned of_ray = ray_masks ? ray_masks[i] : 255;
    const unsigned of_primitive = masks ? masks[id] : 255;
    return !(skip && skip[i] == id) && (of_ray & of_primitive) != 0;
  }
};

}  // namespace grelha::GRELHA_ISA
