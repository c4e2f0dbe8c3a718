#pragma once
// The state of a thread's shading, and the hits of a batch as lanes.

#include "kernel/base/lanes_four.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/shade/sampling.hpp"
#include "kernel/traverse/stream.hpp"

namespace grelha::GRELHA_ISA {

/// Lanes whose light is converted together.
inline constexpr int kConverted = kSimdWidth < 8 ? kSimdWidth : 8;

/// Light in units of the sums, ties away from zero; NaN counts as 0. The compiler's own vectors
/// know which instruction sets can convert to such integers.
inline void light_units(const VFloat& x, float most, std::int64_t (&units)[kSimdWidth]) {
  using Doubles = Vector<double, kConverted>;
  const VFloat number = select(x == x, x, VFloat(0));
  float light[kSimdWidth];
  store(light, max(min(number, VFloat(most)), VFloat(0 - most)));
  for (int k = 0; k < kSimdWidth; k += kConverted) {
    Vector<float, kConverted> f;
    __builtin_memcpy(&f, light + k, sizeof f);
    const Doubles u = __builtin_convertvector(f, Doubles) * kLightUnit;
    const Doubles half = Doubles{} + .5;
    const auto i =
        __builtin_convertvector(u + (u < 0 ? 0 - half : half), Vector<std::int64_t, kConverted>);
    __builtin_memcpy(units + k, &i, sizeof i);
  }
}

/// Light of each lane, in units of the sums.
struct LaneLight {
  std::int64_t r[kSimdWidth], g[kSimdWidth], b[kSimdWidth];
};

/// Adds the lanes from the first that is set on that have its pixel; returns the others.
[[gnu::always_inline]] inline unsigned add_run(const StripWork& work,
                                               const std::uint32_t* pixel,
                                               const LaneLight& light,
                                               unsigned lanes) {
  const std::uint32_t here = pixel[__builtin_ctz(lanes)];
  std::int64_t sum[3] = {};
  do {
    const int k = __builtin_ctz(lanes);
    sum[0] += light.r[k];
    sum[1] += light.g[k];
    sum[2] += light.b[k];
    lanes &= lanes - 1;
  } while (lanes != 0 && pixel[__builtin_ctz(lanes)] == here);
  std::int64_t* const to = work.sums + std::size_t{here} * 3;
  to[0] += sum[0];
  to[1] += sum[1];
  to[2] += sum[2];
  return lanes;
}

/// Adds the light of the selected lanes to the sums of their pixels. Neighbours with the same pixel
/// touch its sum once.
inline void add_light(const StripWork& work,
                      const std::uint32_t* pixel,
                      const VFloat3& light,
                      unsigned lanes) {
  if (lanes == 0)
    return;
  LaneLight units;
  light_units(light.x, work.most_light, units.r);
  light_units(light.y, work.most_light, units.g);
  light_units(light.z, work.most_light, units.b);
  while (lanes != 0)
    lanes = add_run(work, pixel, units, lanes);
}

/// The pixels whose samples the rays of these sums are.
inline VUint pixels_of(const StripWork& work, const VUint& sums) {
  return work.pixels ? words_at(work.pixels, sums) : sums + work.first_pixel;
}

/// Tells the observer, if any, which phase comes next; nothing else depends on it.
inline void enter(const StripWork& work, Phase phase) {
  if (work.observer)
    work.observer->enter(*work.observer, phase, nullptr);
}
inline void enter(const StripWork& work, Phase phase, const Rays& rays) {
  if (work.observer)
    work.observer->enter(*work.observer, phase, &rays);
}

/// Everything a thread's shading needs to know.
struct Shader {
  const SceneView& scene;
  const ShadingView& shading;
  const StripWork& work;
  TraceCounts& counters;
  RayCounts& rays;
  Batch& b;
};

/// True if shares may differ from weights: see split().
inline bool keeps_shares(const Shader& s) {
  return s.shading.gains || s.work.plan.glossy_rays > 0;
}

/// Elements i, i + 1, ... of arrays with one component each: Rows3 or Columns3.
template <class Arrays>
inline VFloat3 load3(const Arrays& of, int i) {
  return {
      load<VFloat>(of.x + i),
      load<VFloat>(of.y + i),
      load<VFloat>(of.z + i),
  };
}
template <class Arrays>
inline void store3(Arrays& to, int i, const VFloat3& a) {
  store(to.x + i, a.x);
  store(to.y + i, a.y);
  store(to.z + i, a.z);
}

inline VFloat3 splat(const float* v) {
  return {VFloat(v[0]), VFloat(v[1]), VFloat(v[2])};
}

/// Lanes of an array of `count` from `first` on.
inline unsigned first_bits(int first, int count) {
  const int left = count - first;
  return left >= kSimdWidth ? ~0u >> (32 - kSimdWidth) : (1u << left) - 1u;
}

/// Selects the hits in the lanes: i, i + 1, ..., or hit i in every lane. Behind the last hit,
/// arrays hold old but valid values.
template <bool kOne>
struct SimdHits {
  int i;
  VFloat operator()(const float* of) const {
    if constexpr (kOne)
      return VFloat(of[i]);
    else
      return load<VFloat>(of + i);
  }
  VUint operator()(const std::uint32_t* of) const {
    if constexpr (kOne)
      return VUint{} + of[i];
    else
      return load_words<VFloat>(of + i);
  }
  VFloat3 operator()(const Rows3& of) const {
    return {(*this)(of.x), (*this)(of.y), (*this)(of.z)};
  }
};

/// Lanes with a component that is not 0.
inline VMask any_component(const VFloat3& a) {
  return mask_or(mask_or(a.x != VFloat(0), a.y != VFloat(0)), a.z != VFloat(0));
}

/// Reads a field of the hits' materials. Neighbouring hits mostly share one material.
template <bool kOne>
inline VFloat gather(const Shader& s, MaterialField field, const SimdHits<kOne>& at) {
  const float* const held = s.shading.materials.field[field];
  const std::uint32_t first = s.b.hits.material[at.i];
  if constexpr (kOne)
    return VFloat(held[first]);
  const VUint of = at(s.b.hits.material);
  return bits_where(of != first) == 0 ? VFloat(held[first]) : floats_at(held, of);
}

template <bool kOne>
inline VFloat3 gather3(const Shader& s, MaterialField r, const SimdHits<kOne>& at) {
  return {gather(s, r, at),
          gather(s, static_cast<MaterialField>(r + 1), at),
          gather(s, static_cast<MaterialField>(r + 2), at)};
}

/// Tells apart the uses of a pair of dimensions along one path; 0 for the first light, or lobe,
/// that a camera ray hits.
template <class Word>
inline Word sample_keys(Word path, std::uint32_t use) {
  const Word key = scatter(path, use) | 1u;
  return use != 0 ? key : path == 0u ? Word{} : key;
}

/// Numbers for an effect at hits, which takes `count` samples for each of the pixel's: those of
/// numbers `number`.
template <bool kOne>
[[gnu::noinline]] inline PairOf<VFloat> hit_samples(const Shader& s,
                                                    const SimdHits<kOne>& at,
                                                    int dimension,
                                                    std::uint32_t use,
                                                    const VUint& number,
                                                    int count,
                                                    const Strata& strata) {
  const VUint index = at(s.b.hits.sample) * static_cast<std::uint32_t>(count) + number;
  return sample_pairs<VFloat>(s.work.plan,
                              pixels_of(s.work, at(s.b.hits.pixel)),
                              index,
                              dimension,
                              sample_keys(at(s.b.hits.path), use),
                              strata);
}

/// Traces rays [first, end) of the batch: their id, and t where surfaces are found by it.
inline void trace_run(const Shader& s, int first, int end, Phase phase) {
  BatchRays& b = s.b.rays;
  const Rays rays{.org = {b.org.x + first, b.org.y + first, b.org.z + first},
                  .dir = {b.dir.x + first, b.dir.y + first, b.dir.z + first},
                  .count = static_cast<std::size_t>(end - first)};
  enter(s.work, phase, rays);
  const TraceOptions options{s.work.packet, s.work.mailbox};
  const auto store = [&](const Packet& p, std::size_t at) {
    store_words(p.id, p.size, at, 1, b.id + first);
    store_t_of_positions(p, b.t + first + at);
  };
  const auto load = [&](Packet& p, std::size_t at) { load_own_rays(rays, kInfinity, at, p); };
  trace<false>(s.scene, rays.count, options, s.counters, load, store);
}

/// Traces the first n shadow rays of the batch, each up to its light, and stores what blocks them.
inline void trace_shadows(const Shader& s, int n) {
  constexpr float kLight = 1;  // t
  BatchShadows& b = s.b.shadows;
  const Rays rays{.org = {b.org.x, b.org.y, b.org.z},
                  .dir = {b.dir.x, b.dir.y, b.dir.z},
                  .t_max = &kLight,
                  .count = static_cast<std::size_t>(n),
                  .t_stride = 0};
  enter(s.work, Phase::shadow, rays);
  const TraceOptions options{s.work.packet, s.work.mailbox};
  const auto load = [&](Packet& p, std::size_t at) { load_own_rays(rays, kLight, at, p); };
  const auto store = [&](const Packet& p, std::size_t at) {
    store_words(p.id, p.size, at, 1, b.id);
  };
  trace<true>(s.scene, rays.count, options, s.counters, load, store);
}

}  // namespace grelha::GRELHA_ISA
