#pragma once
// The surfaces that the rays of a batch hit.

#include "kernel/shade/shader.hpp"
#include "kernel/shapes/surface.hpp"

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

}  // namespace grelha::GRELHA_ISA
