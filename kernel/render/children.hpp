#pragma once
// The reflected and refracted rays that hits send on.

#include "kernel/render/shader.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// What a ray carries of its sample: a weight a channel, and its share, see split().
struct Carried {
  Vec3<Lanes> weight;
  Lanes share;
};

/// Puts the rays of the chosen hits i, i + 1, ... on the stack.
inline void push(const Shader& s,
                 RayStack& stack,
                 int i,
                 const Chosen& chosen,
                 const Vec3<Lanes>& dir,
                 const Carried& carried,
                 std::uint32_t kind,
                 std::uint32_t branch) {
  Batch& b = s.b;
  const int to = stack.size;
  const Vec3<Lanes> point = load3(b.px, b.py, b.pz, i), g = load3(b.gx, b.gy, b.gz, i);
  const Lanes away = load<Lanes>(b.away + i);
  if (s.work.in_double) {
    const Lanes by = select(dot(dir, g) < Lanes(0), Lanes(0) - away, away);
    const TwoFloats<Lanes> p =
        moved_exactly<Lanes>({point, load3(b.px_low, b.py_low, b.pz_low, i)}, g, by);
    chosen.store(stack.ox + to, stack.oy + to, stack.oz + to, p.high);
    chosen.store(stack.ox_low + to, stack.oy_low + to, stack.oz_low + to, p.low);
  } else {
    chosen.store(stack.ox + to, stack.oy + to, stack.oz + to, leave(point, g, away, dir));
  }
  chosen.store(stack.dx + to, stack.dy + to, stack.dz + to, dir);
  chosen.store(stack.wr + to, stack.wg + to, stack.wb + to, carried.weight);
  if (keeps_shares(s))
    chosen.store(stack.share + to, carried.share);
  chosen.store(stack.pixel + to, load_words<Lanes>(b.hit_pixel + i));
  chosen.store(stack.depth + to, (load_words<Lanes>(b.hit_depth + i) + 1u) | kind);
  if (s.work.plan.on) {
    chosen.store(stack.sample + to, load_words<Lanes>(b.hit_sample + i));
    chosen.store(stack.path + to,
                 scatter(load_words<Lanes>(b.hit_path + i), branch + (kind != 0 ? 0x10001u : 1u)));
  }
  stack.size += chosen.count();
  (kind != 0 ? s.rays.refraction : s.rays.reflection) += static_cast<unsigned>(chosen.count());
}

/// Directions in the lobes of the rough mirrors at the hits i, i + 1, ...: the unit mirror
/// directions moved within a disc across them, kept above the surface. Each takes `rays` of them;
/// this is the `ray`-th.
[[gnu::noinline]] inline Vec3<Lanes> lobe_directions(
    const Shader& s, int i, const Vec3<Lanes>& mirror, const Lanes& roughness, int ray, int rays) {
  const SamplePlan& plan = s.work.plan;
  const Words<Lanes> number = Words<Lanes>{} + static_cast<std::uint32_t>(ray);
  const PairOf<Lanes> d = disc_point(
      hit_samples(s, HitLanes<false>{i}, plan.gloss, 0, number, rays, plan.gloss_strata));
  Vec3<Lanes> u, v;
  across(mirror, u, v);
  const Vec3<Lanes> to = mirror + (roughness * d.u) * u + (roughness * d.v) * v,
                    g = load3(s.b.gx, s.b.gy, s.b.gz, i);
  const Lanes under = dot(to, g);
  return normalize(select(under < Lanes(0), to - (under + under) * g, to));
}

/// What the reflected and the refracted ray of a hit carry; `up`, `down`: what the material sends
/// on of what it gets.
///
/// By its share a ray goes on or ends. It is the weight of the brightest channel, but for two
/// cases: of a material that sends on more than it gets the two have shares of one, so that all
/// shares of a sample together never grow, and rays that fan out in a lobe have the share of one in
/// their place, since they end together.
inline void split(const Shader& s,
                  int i,
                  const Vec3<Lanes>& up,
                  const Vec3<Lanes>& down,
                  Carried& reflected,
                  Carried& refracted) {
  const Vec3<Lanes> w = load3(s.b.hr, s.b.hg, s.b.hb, i);
  reflected.weight = w * up;
  refracted.weight = w * down;
  reflected.share = largest(reflected.weight);
  refracted.share = largest(refracted.weight);
  if (!keeps_shares(s))
    return;
  const Lanes r = largest(up), t = largest(down),
              share = load<Lanes>(s.b.hit_share + i) / greater(r + t, Lanes(1));
  reflected.share = share * r;
  refracted.share = share * t;
}

/// Least weights that a fan of rays in a lobe must have together; else one goes in its place.
inline constexpr float kFanWeights = 8;

/// What materials send on of the light they get, a share a channel, and where to.
struct Bounce {
  Vec3<Lanes> up;       ///< along the mirror direction
  Vec3<Lanes> down;     ///< along `through`
  Vec3<Lanes> through;  ///< the refracted direction
};

/// Schlick's share of the mirror.
inline Lanes schlick(const Lanes& ior, const Lanes& cosine) {
  const Lanes one(1);
  const Lanes r = (ior - one) / (ior + one), r0 = r * r;
  const Lanes c = one - cosine, cc = c * c;
  return r0 + (one - r0) * ((cc * cc) * c);
}

/// The bounce at hits of which some transmit `t` > 0; at the others all of `mirror` goes up. `nv`:
/// cosine between the normal n and the unit vector v to the viewer.
inline Bounce refract(const Shader& s,
                      const HitLanes<false>& at,
                      const Vec3<Lanes>& mirror,
                      const Lanes& t,
                      const Vec3<Lanes>& n,
                      const Vec3<Lanes>& v,
                      const Lanes& nv) {
  const Lanes o(0), one(1);
  const Lanes ior = gather(s, kIor, at);
  const Mask<Lanes> clear = t > o, inside = at(s.b.inside) > o;
  const Lanes eta = select(inside, ior, one / ior);
  // Snell: cos^2 on the other side
  const Lanes c1 = greater(nv, o), left = one - (eta * eta) * (one - c1 * c1);
  const Mask<Lanes> passes = left >= o;
  const Lanes c2 = square_root(greater(left, o));
  Lanes tw = t;
  Vec3<Lanes> rw = mirror;
  if (s.shading.fresnel) {
    const Mask<Lanes> asked = gather(s, kFresnel, at) > o;
    const Lanes kr = schlick(ior, select(eta > one, c2, c1));  // the angle on the thinner side
    tw = select(asked, one - kr, tw);
    rw = select(asked, Vec3<Lanes>{kr, kr, kr}, rw);
  }
  const Mask<Lanes> refracted = both(clear, passes), total = but_not(clear, passes);
  tw = select(refracted, tw, o);
  // On total reflection the mirror ray takes over what would have passed.
  const Mask<Lanes> additive = gather(s, kFresnel, at) == o;
  const Lanes all = select(additive, t, o), whole = select(additive, o, one);
  Vec3<Lanes> up = select(clear, rw, mirror);
  up = select(total,
              select(additive,
                     Vec3<Lanes>{up.x + all, up.y + all, up.z + all},
                     Vec3<Lanes>{whole, whole, whole}),
              up);
  return {up, {tw, tw, tw}, (eta * c1 - c2) * n - eta * v};
}

/// The rays that leave mirrors.
struct Lobe {
  Vec3<Lanes> first;  ///< direction of each mirror's first
  Mask<Lanes> many;   ///< rough, and worth a fan: see kFanWeights
  Chosen on_many;     ///< those of them that send rays
  Lanes roughness;
};

/// Of hits i, i + 1, ... those with a bit in `mirrors` send rays on along `reflected`, of `weight`
/// each.
inline Lobe lobe_of(const Shader& s,
                    int i,
                    unsigned mirrors,
                    const Vec3<Lanes>& reflected,
                    const Vec3<Lanes>& weight,
                    const Lanes& least) {
  const HitLanes<false> at{i};
  const Lanes o(0);
  Mask<Lanes> rough = o != o;
  if (s.shading.gloss)
    rough = gather(s, kRoughness, at) > o;
  const Mask<Lanes> many = s.work.plan.gloss_rays == 0
                               ? o != o
                               : but_not(rough, largest(weight) < Lanes(kFanWeights) * least);
  const Chosen on_rough(bits(rough) & mirrors), on_many(bits(many) & mirrors);
  const Lanes roughness = on_rough.count() != 0 ? gather(s, kRoughness, at) : o;
  Vec3<Lanes> first = reflected;
  if (on_rough.count() != on_many.count())
    first =
        select(but_not(rough, many), lobe_directions(s, i, reflected, roughness, 0, 1), reflected);
  return {first, many, on_many, roughness};
}

/// Puts the rays of the hits i, i + 1, ... on the stack. `least`: the share below which a path
/// ends, and sees the background.
inline void send_bounce(const Shader& s,
                        RayStack& stack,
                        int i,
                        int hits,
                        const Bounce& bounce,
                        const Vec3<Lanes>& reflected,
                        const Lanes& least) {
  Batch& b = s.b;
  Carried reflection, refraction;
  split(s, i, bounce.up, bounce.down, reflection, refraction);
  const unsigned in = lanes_of(i, hits);
  const unsigned mirrors = bits(any_component(reflection.weight)) & in;
  const unsigned clears = bits(any_component(refraction.weight)) & in;
  if ((mirrors | clears) == 0)
    return;
  const Vec3<Lanes> background = splat(s.shading.background);
  const Words<Lanes> last = Words<Lanes>{} + static_cast<std::uint32_t>(s.work.depth);
  const unsigned end = bits(mask_of(Words<Lanes>(load_words<Lanes>(b.hit_depth + i) >= last)));
  const unsigned mirrors_end = end | bits(reflection.share < least),
                 clears_end = end | bits(refraction.share < least);
  add_light(s.work, b.hit_pixel + i, reflection.weight * background, mirrors & mirrors_end);
  add_light(s.work, b.hit_pixel + i, refraction.weight * background, clears & clears_end);
  const Chosen on_mirrors(mirrors & ~mirrors_end), on_clears(clears & ~clears_end);
  const Lobe lobe = lobe_of(s, i, mirrors & ~mirrors_end, reflected, reflection.weight, least);
  const int around = s.work.plan.gloss_rays;
  const float part = 1.f / static_cast<float>(around + 1);
  const Lanes own = select(lobe.many, Lanes(part), Lanes(1));
  push(s, stack, i, on_mirrors, lobe.first, {own * reflection.weight, reflection.share}, 0, 0);
  push(s, stack, i, on_clears, bounce.through, refraction, kRefracted, 0);
  // the rays around the mirror direction
  for (int j = 0; j < around && lobe.on_many.count() != 0; ++j)
    push(s,
         stack,
         i,
         lobe.on_many,
         lobe_directions(s, i, reflected, lobe.roughness, j, around),
         {Lanes(part) * reflection.weight, reflection.share},
         0,
         static_cast<std::uint32_t>(j + 1));
}

/// Sends the reflected and refracted rays of all hits. At the end of the longest path they see the
/// background, and where what they could bring is less than would show; docs/sampling.md derives
/// how much less.
inline void send_on(const Shader& s, RayStack& stack, int hits) {
  Batch& b = s.b;
  const Lanes o(0), least(s.work.min_weight / s.shading.brightest);
  for (int i = 0; i < hits; i += kWidth<Lanes>) {
    const HitLanes<false> at{i};
    const Vec3<Lanes> mirror = gather3(s, kMirrorR, at);
    const Lanes t = s.shading.refracts ? gather(s, kTransmission, at) : o;
    if (none(either(any_component(mirror), t > o)))
      continue;
    const Vec3<Lanes> n = load3(b.nx, b.ny, b.nz, i), g = load3(b.gx, b.gy, b.gz, i),
                      v = load3(b.vx, b.vy, b.vz, i);
    const Lanes nv = dot(n, v);
    const Bounce bounce = s.shading.refracts ? refract(s, at, mirror, t, n, v, nv)
                                             : Bounce{mirror, {o, o, o}, {o, o, o}};
    Vec3<Lanes> reflected = (nv + nv) * n - v;
    // A smooth normal can send a reflection under the true surface; bend it back above.
    const Lanes under = lesser(dot(reflected, g), o);
    reflected = reflected - (under + under) * g;
    send_bounce(s, stack, i, hits, bounce, reflected, least);
  }
}

}  // namespace grelha::GRELHA_ISA
