#pragma once
// The surfaces that the rays of a batch met.

#include "kernel/render/shader.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// Surfaces of rays i, i + 1, ..., which were traced in double.
[[gnu::noinline]] inline Surface<Lanes> surface_in_double(const Shader& s,
                                                          int i,
                                                          const Words<Lanes>& id,
                                                          const Vec3<Lanes>& org,
                                                          const Vec3<Lanes>& dir,
                                                          const Lanes& t) {
  const ExactStart<Lanes> start{load3(s.b.ox_low, s.b.oy_low, s.b.oz_low, i), s.b.whole + i};
  return surface_of<Lanes>(s.scene.geometry, id, org, dir, t, s.shading.smooth, start);
}

/// Fills the hit arrays from rays [0, count); misses send the background. Returns the number of
/// hits.
inline int find_surfaces(const Shader& s, int count) {
  Batch& b = s.b;
  const Vec3<Lanes> background = splat(s.shading.background), zero = {Lanes(0), Lanes(0), Lanes(0)};
  int hits = 0;
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    const Words<Lanes> id = load_words<Lanes>(b.id + i);
    const unsigned in = lanes_of(i, count),
                   missed = bits(mask_of(Words<Lanes>(id == kNoPrimitive))) & in;
    const Vec3<Lanes> weight = load3(b.wr, b.wg, b.wb, i);
    add_light(s.work, b.pixel + i, weight * background, missed);
    const Chosen hit(in & ~missed);
    if (hit.count() == 0)
      continue;
    const Vec3<Lanes> d = load3(b.dx, b.dy, b.dz, i);
    const Vec3<Lanes> org = load3(b.ox, b.oy, b.oz, i);
    const Lanes t = load<Lanes>(b.t + i);
    const Surface<Lanes> f =
        s.work.in_double ? surface_in_double(s, i, id, org, d, t)
                         : surface_of<Lanes>(s.scene.geometry, id, org, d, t, s.shading.smooth);
    const Mask<Lanes> inside = dot(d, f.normal) > Lanes(0);
    const Lanes side = select(inside, Lanes(-1), Lanes(1));
    const int h = hits;
    hit.store(b.px + h, b.py + h, b.pz + h, f.point);
    if (s.work.in_double)
      hit.store(b.px_low + h, b.py_low + h, b.pz_low + h, f.low);
    hit.store(b.gx + h, b.gy + h, b.gz + h, side * f.normal);
    hit.store(b.nx + h, b.ny + h, b.nz + h, side * f.shading);
    hit.store(b.vx + h, b.vy + h, b.vz + h, normalize(zero - d));
    hit.store(b.away + h, f.away);
    hit.store(b.inside + h, select(inside, Lanes(1), Lanes(0)));
    hit.store(b.hr + h, b.hg + h, b.hb + h, weight);
    if (keeps_shares(s))
      hit.store(b.hit_share + h, load<Lanes>(b.share + i));
    hit.store(b.hit_pixel + h, load_words<Lanes>(b.pixel + i));
    hit.store(b.hit_depth + h, load_words<Lanes>(b.depth + i));
    hit.store(b.material + h, f.material);
    if (s.work.plan.on) {
      hit.store(b.hit_sample + h, load_words<Lanes>(b.sample + i));
      hit.store(b.hit_path + h, load_words<Lanes>(b.path + i));
    }
    hits += hit.count();
  }
  return hits;
}

}  // namespace grelha::GRELHA_ISA
