#pragma once
// Whitted shading of a batch of hits: local light with shadow rays, then the reflected and
// refracted rays they send on.
//
// Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn's highlight and,
// for materials that ask for it, Schlick's Fresnel term (1994). No falloff, no ambient light, any
// hit blocks light (the course's rules).

#include "kernel/shade/shader.hpp"
#include "kernel/shapes/surface.hpp"
#include "kernel/shade/children.hpp"
#include "kernel/shade/direct_light.hpp"

namespace grelha::GRELHA_ISA {

/// Surfaces of rays i, i + 1, ..., which hit `id`, and their colours where vertices have some.
[[gnu::always_inline]] inline Surface<VFloat> surface_at_rays(
    const Shader& s, int i, const VUint& id, const VFloat3& dir, VFloat3& color) {
  const VFloat3 org = load3(s.b.rays.org, i);
  const VFloat t = load<VFloat>(s.b.rays.t + i);
  VFloat3* const wanted = s.shading.colored ? &color : nullptr;
  return surface_of<VFloat>(s.scene.geometry, id, org, dir, t, s.shading.smooth, true, wanted);
}

/// Stores where the selected of some rays hit surfaces, from hit `to` on.
[[gnu::always_inline]] inline void store_surfaces(const Shader& s,
                                                  const CompressMask& hit,
                                                  int to,
                                                  const VFloat3& dir,
                                                  const Surface<VFloat>& f) {
  BatchHits& h = s.b.hits;
  const VFloat zero(0), one(1);
  const VMask inside = dot(dir, f.normal) > zero;
  const VFloat side = select(inside, VFloat(-1), one);
  hit.store(h.point, to, f.point);
  hit.store(h.normal, to, side * f.normal);
  hit.store(h.shading, to, side * f.shading);
  hit.store(h.viewer, to, normalize(VFloat3{zero, zero, zero} - dir));
  hit.store(h.offset + to, f.offset);
  hit.store(h.inside + to, select(inside, one, zero));
  hit.store(h.material + to, f.material);
}

/// Stores the weights and shares of the selected rays i, i + 1, ..., from hit `to` on.
[[gnu::always_inline]] inline void store_carried(
    const Shader& s, const CompressMask& hit, int to, int i, const VFloat3& weight) {
  const BatchRays& r = s.b.rays;
  BatchHits& h = s.b.hits;
  hit.store(h.weight, to, weight);
  if (keeps_shares(s))
    hit.store(h.share + to, load<VFloat>(r.share + i));
  hit.store(h.pixel + to, load_words<VFloat>(r.pixel + i));
  hit.store(h.depth + to, load_words<VFloat>(r.depth + i));
  if (s.work.plan.on) {
    hit.store(h.sample + to, load_words<VFloat>(r.sample + i));
    hit.store(h.path + to, load_words<VFloat>(r.path + i));
  }
}

/// Fills the hit arrays from rays [0, count); misses send the background. Returns the number of
/// hits.
inline int find_surfaces(const Shader& s, int count) {
  const BatchRays& r = s.b.rays;
  const VFloat3 background = splat(s.shading.background);
  int hits = 0;
  for (int i = 0; i < count; i += kSimdWidth) {
    const VUint id = load_words<VFloat>(r.id + i);
    const unsigned in = first_bits(i, count);
    const unsigned missed = bits_where(id == kNoPrimitive) & in;
    const VFloat3 weight = load3(r.weight, i);
    add_light(s.work, r.pixel + i, weight * background, missed);
    const CompressMask hit(in & ~missed);
    if (hit.count() == 0)
      continue;
    const VFloat3 dir = load3(r.dir, i);
    VFloat3 color;
    store_surfaces(s, hit, hits, dir, surface_at_rays(s, i, id, dir, color));
    if (s.shading.colored)
      hit.store(s.b.hits.color, hits, color);
    store_carried(s, hit, hits, i, weight);
    hits += hit.count();
  }
  return hits;
}

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
