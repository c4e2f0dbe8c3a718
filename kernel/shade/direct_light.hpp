#pragma once
// Local light: shadow rays from hits to lights, and the light they carry.

#include "kernel/shade/shader.hpp"
#include "kernel/base/power.hpp"
#include "kernel/shapes/surface.hpp"

namespace grelha::GRELHA_ISA {

/// Points of an area light, of numbers `number` at their hits.
template <bool kOne>
inline VFloat3 light_points(const Shader& s,
                            const SimdHits<kOne>& at,
                            const VUint& number,
                            int light_index) {
  const SamplePlan& plan = s.work.plan;
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const PairOf<VFloat> p = hit_samples(s,
                                       at,
                                       plan.light,
                                       static_cast<std::uint32_t>(light_index),
                                       number,
                                       plan.light_rays,
                                       plan.light_strata);
  const VFloat a = p.u - VFloat(.5f);
  const VFloat c = p.v - VFloat(.5f);
  return splat(light) + (a * splat(light + 6) + c * splat(light + 9));
}

/// Adds the light of unblocked rays among the first n shadow rays.
[[gnu::always_inline]] inline void add_unblocked(const Shader& s, int n) {
  const BatchShadows& b = s.b.shadows;
  for (int i = 0; i < n; i += kSimdWidth) {
    const VUint id = load_words<VFloat>(b.id + i);
    const unsigned free = bits_where(id == kNoPrimitive) & first_bits(i, n);
    add_light(s.work, b.pixel + i, load3(b.light, i), free);
  }
}

/// Traces the first n shadow rays of the batch and adds the light of the unblocked ones.
inline void light_up(const Shader& s, int n) {
  if (n == 0)
    return;
  s.rays.shadow += static_cast<unsigned>(n);
  trace_shadows(s, n);
  enter(s.work, Phase::light);
  add_unblocked(s, n);
}

/// Origins of shadow rays: on the lit side, which is the viewer's.
template <bool kOne>
[[gnu::always_inline]] inline VFloat3 shadow_origins(const Shader& s,
                                                     const SimdHits<kOne>& at,
                                                     const VFloat3& normal) {
  return at(s.b.hits.point) + at(s.b.hits.offset) * normal;
}

/// Light that the material sends to the viewer from the unit direction l: Lambert's cosine `nl`,
/// and Blinn's highlight.
template <bool kOne>
[[gnu::always_inline]] inline VFloat3 reflected_light(const Shader& s,
                                                      const SimdHits<kOne>& at,
                                                      const VFloat3& normal,
                                                      const VFloat3& l,
                                                      const VFloat& nl) {
  VFloat3 diffuse = nl * gather3(s, kDiffuseR, at);
  if (s.shading.colored)
    diffuse = diffuse * at(s.b.hits.color);
  if (!s.shading.highlights)
    return diffuse;
  const VFloat3 specular = gather3(s, kSpecularR, at);
  if (!any(any_component(specular)))
    return diffuse;
  const VFloat3 half = normalize(l + at(s.b.hits.viewer));
  const VFloat nh = max(dot(normal, half), VFloat(0));
  return diffuse + power(nh, gather(s, kShine, at)) * specular;
}

/// Puts the selected shadow rays, from `org` and to where they end, behind the first n of the
/// batch, and traces the batch where no room is left; returns how many there are then.
template <bool kOne>
[[gnu::always_inline]] inline int put_shadow_rays(const Shader& s,
                                                  const SimdHits<kOne>& at,
                                                  const CompressMask& selected,
                                                  const VFloat3& org,
                                                  const VFloat3& dir,
                                                  const VFloat3& light,
                                                  int n) {
  BatchShadows& b = s.b.shadows;
  selected.store(b.org, n, org);
  selected.store(b.dir, n, dir);
  selected.store(b.light, n, light);
  selected.store(b.pixel + n, at(s.b.hits.pixel));
  n += selected.count();
  if (n + kSimdWidth <= kBatch)
    return n;
  light_up(s, n);
  return 0;
}

/// Puts a shadow ray to `to` behind the first n for each of the lanes whose hit faces it; returns
/// the new number. `color`: the part of the light's colour that a ray carries.
template <bool kOne>
inline int send_to_light(const Shader& s,
                         const SimdHits<kOne>& at,
                         const VFloat3& to,
                         const VFloat3& color,
                         unsigned lanes,
                         int n) {
  const BatchHits& h = s.b.hits;
  const VFloat3 g = at(h.normal);
  const VFloat3 normal = at(h.shading);
  const VFloat3 org = shadow_origins(s, at, g);
  const VFloat3 dir = to - org;
  const VFloat3 l = normalize(dir);
  const VFloat nl = dot(normal, l);
  const VFloat o(0);
  const CompressMask lit(bits(mask_and(nl > o, dot(g, l) > o)) & lanes);
  if (lit.count() == 0)
    return n;
  const VFloat3 light = color * (at(h.weight) * reflected_light(s, at, normal, l, nl));
  return put_shadow_rays(s, at, lit, org, dir, light, n);
}

/// One shadow ray for each of the hits that faces the light; returns how many are not traced yet.
[[gnu::always_inline]] inline int send_one_each(
    const Shader& s, int hits, int light_index, bool area, const VFloat3& color) {
  const float* const light = s.shading.lights + kLightFloats * light_index;
  int n = 0;
  for (int i = 0; i < hits; i += kSimdWidth) {
    const SimdHits<false> at{i};
    const VFloat3 to = area ? light_points(s, at, VUint{}, light_index) : splat(light);
    n = send_to_light(s, at, to, color, first_bits(i, hits), n);
  }
  return n;
}

/// `each` shadow rays for each of the hits that faces the light; returns how many are not traced
/// yet.
[[gnu::always_inline]] inline int send_many_each(
    const Shader& s, int hits, int light_index, int each, const VFloat3& color) {
  int n = 0;
  for (int i = 0; i < hits; ++i)
    for (int j = 0; j < each; j += kSimdWidth) {
      const SimdHits<true> at{i};
      const VUint number = counted_words<VFloat>(static_cast<std::uint32_t>(j));
      const VFloat3 to = light_points(s, at, number, light_index);
      n = send_to_light(s, at, to, color, first_bits(j, each), n);
    }
  return n;
}

/// Light of one source on all hits: a shadow ray for each that faces it, and what that ray carries
/// if nothing stands in its way; from an area light `light_rays` to each hit, which stand next to
/// each other and carry a share each.
inline void light_hits(const Shader& s, int hits, int light_index, bool area) {
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const int each = area ? s.work.plan.light_rays : 1;
  const VFloat share(1.f / static_cast<float>(each));
  const VFloat3 color = share * splat(light + 3);
  light_up(s,
           each == 1 ? send_one_each(s, hits, light_index, area, color)
                     : send_many_each(s, hits, light_index, each, color));
}

}  // namespace grelha::GRELHA_ISA
