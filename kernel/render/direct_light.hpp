#pragma once
// Local light: shadow rays from hits to lights, and what they carry.

#include "kernel/render/shader.hpp"
#include "kernel/simd/power.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// Points of an area light, of numbers `number` at their hits.
template <bool kOne>
inline Vec3<Lanes> light_points(const Shader& s,
                                const HitLanes<kOne>& at,
                                const Words<Lanes>& number,
                                int light_index) {
  const SamplePlan& plan = s.work.plan;
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const PairOf<Lanes> p = hit_samples(s,
                                      at,
                                      plan.light,
                                      static_cast<std::uint32_t>(light_index),
                                      number,
                                      plan.light_rays,
                                      plan.light_strata);
  const Lanes a = p.u - Lanes(.5f), c = p.v - Lanes(.5f);
  return splat(light) + (a * splat(light + 6) + c * splat(light + 9));
}

/// Traces the first n shadow rays of the batch and adds what those carry that nothing stands in the
/// way of.
inline void light_up(const Shader& s, int n) {
  Batch& b = s.b;
  if (n == 0)
    return;
  for (int i = 0; i < n; ++i) {
    b.lt_min[i] = 0;
    b.lt[i] = 1;
  }
  s.rays.shadow += static_cast<unsigned>(n);
  RayArrays rays{b.lox, b.loy, b.loz, b.ldx, b.ldy, b.ldz, b.lt_min, b.lt, b.lid};
  if (s.work.in_double) {
    rays.low[0] = b.lox_low;
    rays.low[1] = b.loy_low;
    rays.low[2] = b.loz_low;
  }
  enter(s.work, Phase::shadow, rays, n);
  trace<true>(s, rays, n, Phase::shadow);
  enter(s.work, Phase::light);
  for (int i = 0; i < n; i += kWidth<Lanes>) {
    const unsigned free =
        bits(mask_of(Words<Lanes>(load_words<Lanes>(b.lid + i) == kNoPrimitive))) & lanes_of(i, n);
    add_light(s.work, b.light_pixel + i, load3(b.lr, b.lg, b.lb, i), free);
  }
}

/// Puts a shadow ray to `to` behind the first n for each of the lanes whose hit faces it; returns
/// how many there are then. `share`: of the light's colour that a ray carries.
template <bool kOne>
inline int send_to_light(const Shader& s,
                         const HitLanes<kOne>& at,
                         const Vec3<Lanes>& to,
                         const float* color,
                         float share,
                         unsigned lanes,
                         int n) {
  Batch& b = s.b;
  const Lanes o(0);
  const Vec3<Lanes> g = at(b.gx, b.gy, b.gz), normal = at(b.nx, b.ny, b.nz);
  Vec3<Lanes> org = at(b.px, b.py, b.pz) + at(b.away) * g;  // the lit side is the viewer's side
  Vec3<Lanes> low{o, o, o};
  if (s.work.in_double) {
    const TwoFloats<Lanes> p = moved_exactly<Lanes>(
        {at(b.px, b.py, b.pz), at(b.px_low, b.py_low, b.pz_low)}, g, at(b.away));
    org = p.high;
    low = p.low;
  }
  const Vec3<Lanes> dir = to - org, l = normalize(dir);
  const Lanes nl = dot(normal, l);
  const Chosen lit(bits(both(nl > o, dot(g, l) > o)) & lanes);
  if (lit.count() == 0)
    return n;
  Vec3<Lanes> c = nl * gather3(s, kDiffuseR, at);
  const Vec3<Lanes> specular =
      s.shading.highlights ? gather3(s, kSpecularR, at) : Vec3<Lanes>{o, o, o};
  if (any(any_component(specular))) {
    const Vec3<Lanes> half = normalize(l + at(b.vx, b.vy, b.vz));
    const Lanes nh = greater(dot(normal, half), o);
    c = c + power(nh, gather(s, kShine, at)) * specular;
  }
  c = Vec3<Lanes>{Lanes(color[0] * share), Lanes(color[1] * share), Lanes(color[2] * share)} *
      (at(b.hr, b.hg, b.hb) * c);
  lit.store(b.lox + n, b.loy + n, b.loz + n, org);
  if (s.work.in_double)
    lit.store(b.lox_low + n, b.loy_low + n, b.loz_low + n, low);
  lit.store(b.ldx + n, b.ldy + n, b.ldz + n, dir);
  lit.store(b.lr + n, b.lg + n, b.lb + n, c);
  lit.store(b.light_pixel + n, at(b.hit_pixel));
  n += lit.count();
  if (n + kWidth<Lanes> <= kBatch)
    return n;
  light_up(s, n);
  return 0;
}

/// Light of one source on all hits: a shadow ray for each that faces it, and what that ray carries
/// if nothing stands in its way; from an area light `light_rays` to each hit, which stand next to
/// each other and carry a share each.
inline void light_hits(const Shader& s, int hits, int light_index, bool area) {
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const int each = area ? s.work.plan.light_rays : 1;
  const float share = 1.f / static_cast<float>(each);
  int n = 0;
  if (each == 1)
    for (int i = 0; i < hits; i += kWidth<Lanes>) {
      const HitLanes<false> at{i};
      n = send_to_light(s,
                        at,
                        area ? light_points(s, at, Words<Lanes>{}, light_index) : splat(light),
                        light + 3,
                        share,
                        lanes_of(i, hits),
                        n);
    }
  else
    for (int i = 0; i < hits; ++i)
      for (int j = 0; j < each; j += kWidth<Lanes>) {
        const HitLanes<true> at{i};
        const Vec3<Lanes> to =
            light_points(s, at, counted_words<Lanes>(static_cast<std::uint32_t>(j)), light_index);
        n = send_to_light(s, at, to, light + 3, share, lanes_of(j, each), n);
      }
  light_up(s, n);
}

}  // namespace grelha::GRELHA_ISA
