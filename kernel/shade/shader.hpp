#pragma once
// The state of a thread's shading, and the hits of a batch as lanes.

#include "kernel/shade/light_sums.hpp"
#include "kernel/shade/sampling.hpp"
#include "kernel/traverse/stream.hpp"

namespace grelha::GRELHA_ISA {

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
