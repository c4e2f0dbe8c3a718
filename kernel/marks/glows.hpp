#pragma once
// Lamps out of focus: a lens spreads each over many pixels, in which few samples meet it.

#include "kernel/marks/pixel_marks.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Where they may show. Lamps are what shines by itself, more than white.
class Glows {
 public:
  /// What adds less than `least` to each of its pixels is left out.
  Glows(const World::Impl& world, const Setup& setup, double least);

  /// What the brightest of those sends that may show in a pixel, or more, up to twice as much; 0:
  /// there is none.
  float brightest(int x, int y) const;

 private:
  std::vector<PixelMarks> levels_;  ///< of what lamps send: from 2^i on
};

}  // namespace grelha
