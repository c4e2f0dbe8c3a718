#pragma once
// What may hide in the light of a beam, and where.

#include "kernel/features/beam_clip.hpp"
#include "kernel/features/corner_hits.hpp"
#include "kernel/scene/pixel_box.hpp"

namespace grelha::GRELHA_ISA {

/// The weight of what may hide, 1 for white: `inside`, where something was met that no corner sees;
/// `around`, where the corners differ, or the beam cannot tell: what hides then shows in the pixels
/// around as well, whose colours bound it; `boxed`, what is small, and where in the beam.
struct Doubt {
  float inside = 0;
  float around = 0;
  float boxed = 0;
  BeamBox box = {};

  bool none() const { return inside == 0 && around == 0 && boxed == 0; }

  /// Adds what was met: into the box where that stays small. What lies beside the pixel makes way.
  void add(float weight, const BeamBox& where) {
    BeamBox all = box;
    all.add(where);
    if (all.share() <= kLargestBox) {
      box = all;
      boxed = greater(boxed, weight);
    } else if (where.is_beside()) {
      around = greater(around, weight);
    } else if (boxed > 0 && box.is_beside()) {
      around = greater(around, boxed);
      boxed = 0;
      box = {};
      add(weight, where);
    } else {
      inside = greater(inside, weight);
    }
  }
};
inline Doubt around(float weight) {
  return {0, weight};
}
inline Doubt operator+(const Doubt& a, const Doubt& b) {
  Doubt sum{greater(a.inside, b.inside), greater(a.around, b.around), a.boxed, a.box};
  if (b.boxed > 0)
    sum.add(b.boxed, b.box);
  return sum;
}

}  // namespace grelha::GRELHA_ISA
