#pragma once
// Whitted shading of a batch of hits: local light with shadow rays, then the reflected and
// refracted rays they send on.
//
// Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn's highlight and,
// for materials that ask for it, Schlick's Fresnel term (1994). No falloff, no ambient light, any
// hit blocks light (the course's rules).

#include "kernel/render/children.hpp"
#include "kernel/render/direct_light.hpp"
#include "kernel/render/hits.hpp"

namespace grelha::GRELHA_ISA {

/// Traces and shades the batch: runs of rays that go together, the k-th ending at ends[k]. `phase`:
/// primary or bounce.
inline void shade_batch(const Shader& s, RayStack& stack, const int* ends, int runs, Phase phase) {
  Batch& b = s.b;
  const int count = ends[runs - 1];
  for (int i = 0; i < count; ++i) {
    b.t_min[i] = 0;
    b.t[i] = kInfinity;
  }
  for (int k = 0, at = 0; k < runs; at = ends[k++]) {
    RayArrays rays{b.ox + at,
                   b.oy + at,
                   b.oz + at,
                   b.dx + at,
                   b.dy + at,
                   b.dz + at,
                   b.t_min + at,
                   b.t + at,
                   b.id + at};
    if (s.work.in_double) {
      rays.low[0] = b.ox_low + at;
      rays.low[1] = b.oy_low + at;
      rays.low[2] = b.oz_low + at;
      rays.whole = b.whole + at;
    }
    enter(s.work, phase, rays, ends[k] - at);
    trace<false>(s, rays, ends[k] - at, phase);
  }
  enter(s.work, Phase::surface);
  const int hits = find_surfaces(s, count);
  if (hits == 0)
    return;
  if (s.shading.emits)
    for (int i = 0; i < hits; i += kWidth<Lanes>)
      add_light(s.work,
                b.hit_pixel + i,
                load3(b.hr, b.hg, b.hb, i) * gather3(s, kEmissionR, HitLanes<false>{i}),
                lanes_of(i, hits));
  enter(s.work, Phase::light);
  for (int l = 0; l < s.shading.light_count; ++l) {
    const float* const edges = s.shading.lights + kLightFloats * l + 6;
    bool area = false;
    for (int k = 0; s.shading.area && k < 6; ++k)
      area |= edges[k] != 0;
    light_hits(s, hits, l, area);
  }
  enter(s.work, Phase::children);
  if (s.shading.reflects)
    send_on(s, stack, hits);
}

}  // namespace grelha::GRELHA_ISA
