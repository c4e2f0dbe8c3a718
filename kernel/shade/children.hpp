#pragma once
// The reflected and refracted rays that hits send on.

#include "kernel/base/vec3.hpp"
#include "kernel/shade/shader.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// Snell's law at hits.
template <class Real>
struct Refraction {
  Real eta;                 ///< index of refraction of the viewer's side over that of the other
  Real cosine;              ///< to the viewer
  Real other_cosine;        ///< on the other side
  Mask<Real> is_refracted;  ///< else: total reflection
};

/// `nv`: cosine between normal and viewer.
template <class Real>
[[gnu::always_inline]] inline Refraction<Real> snell(const Real& ior,
                                                     const Mask<Real>& inside,
                                                     const Real& nv) {
  const Real o(0), one(1);
  const Real eta = select(inside, ior, one / ior);
  const Real cosine = max(nv, o);
  const Real squared = one - (eta * eta) * (one - cosine * cosine);  // of the other
  return {
      eta,
      cosine,
      square_root(max(squared, o)),
      squared >= o,
  };
}

/// The direction that passes, not yet normalized; v: the unit vector to the viewer, n: the normal
/// on its side.
template <class Real>
[[gnu::always_inline]] inline Vec3<Real> refracted_direction(const Refraction<Real>& f,
                                                             const Vec3<Real>& n,
                                                             const Vec3<Real>& v) {
  return (f.eta * f.cosine - f.other_cosine) * n - f.eta * v;
}

/// Schlick's share of the mirror, by the angle on the thinner side.
template <class Real>
[[gnu::always_inline]] inline Real schlick(const Real& ior, const Refraction<Real>& f) {
  const Real one(1);
  const Real cosine = select(f.eta > one, f.other_cosine, f.cosine);
  const Real r = (ior - one) / (ior + one);
  const Real r0 = r * r;
  const Real c = one - cosine;
  const Real cc = c * c;
  return r0 + (one - r0) * ((cc * cc) * c);
}

/// Contribution of a ray to its sample: a weight per channel, and its share, see split().
struct CarriedWeight {
  VFloat3 weight;
  VFloat share;
};

/// Kind of a ray that leaves a hit, as set in its depth, and its number within a fan.
struct RayKind {
  std::uint32_t kind = 0;  ///< kRefracted, or 0: reflected
  std::uint32_t number = 0;
};

/// Pushes the origins of rays towards `dir` from the selected hits i, i + 1, ... on the stack.
[[gnu::always_inline]] inline void push_origins(
    const Shader& s, RayStack& stack, int i, const CompressMask& selected, const VFloat3& dir) {
  const SimdHits<false> at{i};
  const BatchHits& h = s.b.hits;
  const VFloat3 point = at(h.point);
  const VFloat3 normal = at(h.normal);
  const VFloat offset = at(h.offset);
  selected.store(stack.org, stack.size, offset_origin(point, normal, offset, dir));
}

/// The samples of the selected hits i, i + 1, ..., and which bounces lead to where their rays go.
[[gnu::always_inline]] inline void push_paths(
    const Shader& s, RayStack& stack, int i, const CompressMask& selected, const RayKind& branch) {
  const SimdHits<false> at{i};
  const BatchHits& h = s.b.hits;
  const std::uint32_t use = branch.number + (branch.kind != 0 ? 0x10001u : 1u);
  selected.store(stack.sample + stack.size, at(h.sample));
  selected.store(stack.path + stack.size, scatter(at(h.path), use));
}

/// Puts the rays of the selected hits i, i + 1, ... on the stack.
inline void push(const Shader& s,
                 RayStack& stack,
                 int i,
                 const CompressMask& selected,
                 const VFloat3& dir,
                 const CarriedWeight& carried,
                 const RayKind& branch) {
  const SimdHits<false> at{i};
  const BatchHits& h = s.b.hits;
  const int to = stack.size;
  push_origins(s, stack, i, selected, dir);
  selected.store(stack.dir, to, dir);
  selected.store(stack.weight, to, carried.weight);
  if (keeps_shares(s))
    selected.store(stack.share + to, carried.share);
  selected.store(stack.pixel + to, at(h.pixel));
  selected.store(stack.depth + to, (at(h.depth) + 1u) | branch.kind);
  if (s.work.plan.on)
    push_paths(s, stack, i, selected, branch);
  stack.size += selected.count();
  std::uint64_t& rays = branch.kind != 0 ? s.rays.refraction : s.rays.reflection;
  rays += static_cast<unsigned>(selected.count());
}

/// Directions in the lobes of the rough mirrors at the hits i, i + 1, ...: the unit mirror
/// directions moved within a disc across them, kept above the surface. Each mirror sends `rays`
/// such rays; this is the `ray`-th.
[[gnu::noinline]] inline VFloat3 lobe_directions(
    const Shader& s, int i, const VFloat3& mirror, const VFloat& roughness, int ray, int rays) {
  const SamplePlan& plan = s.work.plan;
  const VUint number = VUint{} + static_cast<std::uint32_t>(ray);
  const PairOf<VFloat> d = disc_point(
      hit_samples(s, SimdHits<false>{i}, plan.glossy, 0, number, rays, plan.glossy_strata));
  VFloat3 u, v;
  across(mirror, u, v);
  const VFloat3 to = mirror + (roughness * d.u) * u + (roughness * d.v) * v;
  const VFloat3 normal = load3(s.b.hits.normal, i);
  const VFloat under = dot(to, normal);
  return normalize(select(under < VFloat(0), to - (under + under) * normal, to));
}

/// Computes the weights and shares of the reflected and the refracted ray of a hit. `up`, `down`:
/// fractions of the light that the material reflects and transmits.
///
/// The share of a ray decides whether it goes on or ends. It is the weight of the brightest
/// channel, with two exceptions: if a material sends on more than it gets, the two shares add up to
/// that of the hit, so that the sum of a sample's shares never grows; and rays that fan out in a
/// lobe have the share of the one ray they replace, since they end together.
inline void split(const Shader& s,
                  int i,
                  const VFloat3& up,
                  const VFloat3& down,
                  CarriedWeight& reflected,
                  CarriedWeight& refracted) {
  const VFloat3 w = load3(s.b.hits.weight, i);
  reflected.weight = w * up;
  refracted.weight = w * down;
  reflected.share = largest(reflected.weight);
  refracted.share = largest(refracted.weight);
  if (!keeps_shares(s))
    return;
  const VFloat r = largest(up);
  const VFloat t = largest(down);
  const VFloat share = load<VFloat>(s.b.hits.share + i) / max(r + t, VFloat(1));
  reflected.share = share * r;
  refracted.share = share * t;
}

/// Least weights that a fan of rays in a lobe must have together; otherwise one ray replaces it.
inline constexpr float kFanWeights = 8;

/// Fractions of the light that materials reflect and transmit, per channel, and the directions.
struct Bounce {
  VFloat3 up;             ///< along the mirror direction
  VFloat3 down;           ///< along `refracted_dir`
  VFloat3 refracted_dir;  ///< the refracted direction
};

/// Fraction reflected at total reflection, where the mirror ray takes over the transmitted light: t
/// is added to `up`, or all light is reflected if the material obeys Fresnel's law.
[[gnu::always_inline]] inline VFloat3 totally_reflected(const VFloat3& up,
                                                        const VFloat& t,
                                                        const VMask& additive) {
  const VFloat o(0), one(1);
  const VFloat all = select(additive, t, o);
  const VFloat whole = select(additive, o, one);
  return select(
      additive, VFloat3{up.x + all, up.y + all, up.z + all}, VFloat3{whole, whole, whole});
}

/// Fractions of the light at hits that are reflected and transmitted.
struct Shares {
  VFloat3 mirror;
  VFloat transmitted;
};

/// Replaces the given shares by Fresnel's law where a material asks for it.
[[gnu::always_inline]] inline Shares fresnel_shares(const Refraction<VFloat>& f,
                                                    const VFloat& ior,
                                                    const VMask& asked,
                                                    const Shares& given) {
  const VFloat one(1);
  const VFloat kr = schlick(ior, f);
  return {select(asked, VFloat3{kr, kr, kr}, given.mirror),
          select(asked, one - kr, given.transmitted)};
}

/// The bounce at hits where some transmit `t` > 0; the others reflect all of `mirror`. `nv`: cosine
/// between the normal n and the unit vector v to the viewer.
inline Bounce refract(const Shader& s,
                      const SimdHits<false>& at,
                      const VFloat3& mirror,
                      const VFloat& t,
                      const VFloat3& n,
                      const VFloat3& v,
                      const VFloat& nv) {
  const VFloat o(0);
  const VFloat ior = gather(s, kIor, at);
  const VFloat fresnel = gather(s, kFresnel, at);
  const VMask clear = t > o;
  const Refraction<VFloat> f = snell(ior, at(s.b.hits.inside) > o, nv);
  Shares shares{mirror, t};
  if (s.shading.fresnel)
    shares = fresnel_shares(f, ior, fresnel > o, shares);
  const VFloat transmitted = select(mask_and(clear, f.is_refracted), shares.transmitted, o);
  VFloat3 up = select(clear, shares.mirror, mirror);
  up = select(and_not(clear, f.is_refracted), totally_reflected(up, t, fresnel == o), up);
  return {up, {transmitted, transmitted, transmitted}, refracted_direction(f, n, v)};
}

/// The rays that leave mirrors.
struct Lobe {
  VFloat3 first;         ///< direction of each mirror's first
  VMask many;            ///< rough, and worth a fan: see kFanWeights
  CompressMask on_many;  ///< those that send rays
  VFloat roughness;
};

/// Computes the lobes of hits i, i + 1, ...: those with a bit in `mirrors` send rays on along
/// `reflected`, each of `weight`.
inline Lobe lobe_of(const Shader& s,
                    int i,
                    unsigned mirrors,
                    const VFloat3& reflected,
                    const VFloat3& weight,
                    const VFloat& least) {
  const SimdHits<false> at{i};
  const VFloat o(0);
  const VMask nowhere = o != o;
  VMask rough = nowhere;
  if (s.shading.glossy)
    rough = gather(s, kRoughness, at) > o;
  VMask many = nowhere;
  if (s.work.plan.glossy_rays != 0)
    many = and_not(rough, largest(weight) < VFloat(kFanWeights) * least);
  const CompressMask on_rough(bits(rough) & mirrors);
  const CompressMask on_many(bits(many) & mirrors);
  const VFloat roughness = on_rough.count() != 0 ? gather(s, kRoughness, at) : o;
  VFloat3 first = reflected;
  if (on_rough.count() != on_many.count())
    first =
        select(and_not(rough, many), lobe_directions(s, i, reflected, roughness, 0, 1), reflected);
  return {first, many, on_many, roughness};
}

/// Ends the paths of the hits i, i + 1, ... with a bit in `sending` that are too long, or whose
/// share is below `least`: they see the background. Returns those that go on.
[[gnu::always_inline]] inline unsigned end_paths(
    const Shader& s, int i, const CarriedWeight& carried, unsigned sending, const VFloat& least) {
  const BatchHits& h = s.b.hits;
  const VUint last = VUint{} + static_cast<std::uint32_t>(s.work.depth);
  const unsigned longest = bits_where(load_words<VFloat>(h.depth + i) >= last);
  const unsigned end = longest | bits(carried.share < least);
  const VFloat3 background = carried.weight * splat(s.shading.background);
  add_light(s.work, h.pixel + i, background, sending & end);
  return sending & ~end;
}

/// Puts the rays around the mirror direction on the stack; each carries the same.
[[gnu::always_inline]] inline void push_fan(const Shader& s,
                                            RayStack& stack,
                                            int i,
                                            const Lobe& lobe,
                                            const VFloat3& reflected,
                                            const CarriedWeight& carried) {
  const int rays = s.work.plan.glossy_rays;
  for (int j = 0; j < rays && lobe.on_many.count() != 0; ++j) {
    const VFloat3 dir = lobe_directions(s, i, reflected, lobe.roughness, j, rays);
    push(s, stack, i, lobe.on_many, dir, carried, {0, static_cast<std::uint32_t>(j + 1)});
  }
}

/// The hits i, i + 1, ... that send rays on, a bit each, and the weights and shares of these.
struct OutgoingRays {
  unsigned mirrors, clears;
  CarriedWeight up, down;
};

/// The rays that hits i, i + 1, ... send on before any path ends.
[[gnu::always_inline]] inline OutgoingRays outgoing_rays(const Shader& s,
                                                         int i,
                                                         int hits,
                                                         const Bounce& bounce) {
  OutgoingRays rays;
  split(s, i, bounce.up, bounce.down, rays.up, rays.down);
  const unsigned in = first_bits(i, hits);
  rays.mirrors = bits(any_component(rays.up.weight)) & in;
  rays.clears = bits(any_component(rays.down.weight)) & in;
  return rays;
}

/// Puts the rays of the hits i, i + 1, ... on the stack. `least`: the share below which a path
/// ends, and sees the background.
inline void send_bounce(const Shader& s,
                        RayStack& stack,
                        int i,
                        int hits,
                        const Bounce& bounce,
                        const VFloat3& reflected,
                        const VFloat& least) {
  const OutgoingRays rays = outgoing_rays(s, i, hits, bounce);
  if ((rays.mirrors | rays.clears) == 0)
    return;
  const CarriedWeight& up = rays.up;
  const unsigned mirrors = end_paths(s, i, up, rays.mirrors, least);
  const unsigned clears = end_paths(s, i, rays.down, rays.clears, least);
  const Lobe lobe = lobe_of(s, i, mirrors, reflected, up.weight, least);
  const VFloat part(1.f / static_cast<float>(s.work.plan.glossy_rays + 1));
  const VFloat own = select(lobe.many, part, VFloat(1));
  push(s, stack, i, CompressMask(mirrors), lobe.first, {own * up.weight, up.share}, {});
  push(s, stack, i, CompressMask(clears), bounce.refracted_dir, rays.down, {kRefracted, 0});
  push_fan(s, stack, i, lobe, reflected, {part * up.weight, up.share});
}

/// A smooth normal can send a reflection under the true surface; it is bent back above.
[[gnu::always_inline]] inline VFloat3 above_surface(const VFloat3& reflected,
                                                    const VFloat3& normal) {
  const VFloat under = min(dot(reflected, normal), VFloat(0));
  return reflected - (under + under) * normal;
}

/// Sends the reflected and refracted rays of all hits. At the end of the longest path they see the
/// background, and where what they could bring is less than would show; docs/sampling.md derives
/// how much less.
inline void send_on(const Shader& s, RayStack& stack, int hits) {
  const VFloat o(0), least(s.work.min_weight / s.shading.brightest);
  for (int i = 0; i < hits; i += kSimdWidth) {
    const SimdHits<false> at{i};
    const VFloat3 mirror = gather3(s, kMirrorR, at);
    const VFloat t = s.shading.refracts ? gather(s, kTransmission, at) : o;
    if (none(mask_or(any_component(mirror), t > o)))
      continue;
    const VFloat3 n = at(s.b.hits.shading);
    const VFloat3 v = at(s.b.hits.viewer);
    const VFloat nv = dot(n, v);
    Bounce bounce{mirror, {o, o, o}, {o, o, o}};
    if (s.shading.refracts)
      bounce = refract(s, at, mirror, t, n, v, nv);
    const VFloat3 reflected = above_surface((nv + nv) * n - v, at(s.b.hits.normal));
    send_bounce(s, stack, i, hits, bounce, reflected, least);
  }
}

}  // namespace grelha::GRELHA_ISA
