#pragma once
// The surfaces that the rays of a batch met.

#include "kernel/render/shader.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// Surfaces of rays i, i + 1, ..., which met `id`.
[[gnu::always_inline]] inline Surface<Lanes> surface_at_rays(const Shader& s,
                                                             int i,
                                                             const LaneWords& id,
                                                             const Lanes3& dir) {
  const Lanes3 org = load3(s.b.rays.org, i);
  const Lanes t = load<Lanes>(s.b.rays.t + i);
  return surface_of<Lanes>(s.scene.geometry, id, org, dir, t, s.shading.smooth, true);
}

/// Stores where the chosen of some rays met surfaces, from hit `to` on.
[[gnu::always_inline]] inline void store_surfaces(
    const Shader& s, const Chosen& hit, int to, const Lanes3& dir, const Surface<Lanes>& f) {
  BatchHits& h = s.b.hits;
  const Lanes zero(0), one(1);
  const LaneMask inside = dot(dir, f.normal) > zero;
  const Lanes side = select(inside, Lanes(-1), one);
  hit.store(h.point, to, f.point);
  hit.store(h.normal, to, side * f.normal);
  hit.store(h.shading, to, side * f.shading);
  hit.store(h.viewer, to, normalize(Lanes3{zero, zero, zero} - dir));
  hit.store(h.away + to, f.away);
  hit.store(h.inside + to, select(inside, one, zero));
  hit.store(h.material + to, f.material);
}

/// Stores the weights and shares of the chosen rays i, i + 1, ..., from hit `to` on.
[[gnu::always_inline]] inline void store_carried(
    const Shader& s, const Chosen& hit, int to, int i, const Lanes3& weight) {
  const BatchRays& r = s.b.rays;
  BatchHits& h = s.b.hits;
  hit.store(h.weight, to, weight);
  if (keeps_shares(s))
    hit.store(h.share + to, load<Lanes>(r.share + i));
  hit.store(h.pixel + to, load_words<Lanes>(r.pixel + i));
  hit.store(h.depth + to, load_words<Lanes>(r.depth + i));
  if (s.work.plan.on) {
    hit.store(h.sample + to, load_words<Lanes>(r.sample + i));
    hit.store(h.path + to, load_words<Lanes>(r.path + i));
  }
}

/// Fills the hit arrays from rays [0, count); misses send the background. Returns the number of
/// hits.
inline int find_surfaces(const Shader& s, int count) {
  const BatchRays& r = s.b.rays;
  const Lanes3 background = splat(s.shading.background);
  int hits = 0;
  for (int i = 0; i < count; i += kLanes) {
    const LaneWords id = load_words<Lanes>(r.id + i);
    const unsigned in = lanes_of(i, count);
    const unsigned missed = lanes_where(id == kNoPrimitive) & in;
    const Lanes3 weight = load3(r.weight, i);
    add_light(s.work, r.pixel + i, weight * background, missed);
    const Chosen hit(in & ~missed);
    if (hit.count() == 0)
      continue;
    const Lanes3 dir = load3(r.dir, i);
    store_surfaces(s, hit, hits, dir, surface_at_rays(s, i, id, dir));
    store_carried(s, hit, hits, i, weight);
    hits += hit.count();
  }
  return hits;
}

}  // namespace grelha::GRELHA_ISA
