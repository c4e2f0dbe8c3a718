#pragma once
// Sums of light, a pixel at a time.

#include "kernel/base/lanes_four.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/base/vec3.hpp"

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

}  // namespace grelha::GRELHA_ISA
