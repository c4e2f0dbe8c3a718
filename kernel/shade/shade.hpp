#pragma once
// Whitted shading of a batch of hits: local light with shadow rays, then the reflected and
// refracted rays they send on.
//
// Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn's highlight and,
// for materials that ask for it, Schlick's Fresnel term (1994). No falloff, no ambient light, any
// hit blocks light (the course's rules).

#include "kernel/shade/children.hpp"
#include "kernel/shade/direct_light.hpp"
#include "kernel/shade/hits.hpp"

namespace grelha::GRELHA_ISA {

/// Traces the batch: runs of rays that go together, the k-th ending at ends[k].
[[gnu::always_inline]] inline void trace_batch(const Shader& s,
                                               const int* ends,
                                               int runs,
                                               Phase phase) {
  int at = 0;
  for (int k = 0; k < runs; ++k) {
    trace_run(s, at, ends[k], phase);
    at = ends[k];
  }
}

/// Adds the emission of the surfaces at the hits.
[[gnu::always_inline]] inline void add_emission(const Shader& s, int hits) {
  const BatchHits& h = s.b.hits;
  for (int i = 0; i < hits; i += kSimdWidth) {
    VFloat3 emission = gather3(s, kEmissionR, SimdHits<false>{i});
    if (s.shading.colored)
      emission = emission * load3(h.color, i);
    add_light(s.work, h.pixel + i, load3(h.weight, i) * emission, first_bits(i, hits));
  }
}

/// True if a light has an area: an edge that is not 0.
[[gnu::always_inline]] inline bool has_area(const Shader& s, int light_index) {
  const float* const edges = s.shading.lights + kLightFloats * light_index + 6;
  bool area = false;
  for (int k = 0; s.shading.area && k < 6; ++k)
    area |= edges[k] != 0;
  return area;
}

/// Traces and shades the batch: runs of rays that go together, the k-th ending at ends[k]. `phase`:
/// primary or bounce.
inline void shade_batch(const Shader& s, RayStack& stack, const int* ends, int runs, Phase phase) {
  trace_batch(s, ends, runs, phase);
  enter(s.work, Phase::surface);
  const int hits = find_surfaces(s, ends[runs - 1]);
  if (hits == 0)
    return;
  if (s.shading.emits)
    add_emission(s, hits);
  enter(s.work, Phase::light);
  for (int l = 0; l < s.shading.light_count; ++l)
    light_hits(s, hits, l, has_area(s, l));
  enter(s.work, Phase::children);
  if (s.shading.reflects)
    send_on(s, stack, hits);
}

}  // namespace grelha::GRELHA_ISA
