#pragma once
// Sums of light, a pixel at a time.

#include "kernel/scene/shading_view.hpp"
#include "kernel/simd/vec3.hpp"

namespace grelha::GRELHA_ISA {

/// Light in units of the sums, ties away from zero; what is not a number counts nothing. The
/// compiler's own vectors know which instruction sets can make such integers.
inline void light_units(const Lanes& x, float most, std::int64_t (&units)[kWidth<Lanes>]) {
  constexpr int n = kWidth<Lanes> < 8 ? kWidth<Lanes> : 8;
  using Floats = float __attribute__((vector_size(4 * n)));
  using Doubles = double __attribute__((vector_size(8 * n)));
  using Integers = std::int64_t __attribute__((vector_size(8 * n)));
  float c[kWidth<Lanes>];
  store(c, greater(lesser(select(x == x, x, Lanes(0)), Lanes(most)), Lanes(0 - most)));
  for (int k = 0; k < kWidth<Lanes>; k += n) {
    Floats f;
    __builtin_memcpy(&f, c + k, sizeof f);
    const Doubles u = __builtin_convertvector(f, Doubles) * kLightUnit, half = Doubles{} + .5;
    const Integers i = __builtin_convertvector(u + (u < 0 ? 0 - half : half), Integers);
    __builtin_memcpy(units + k, &i, sizeof i);
  }
}

/// Adds the light of the chosen lanes to their pixels' sums. Where neighbours have one pixel its
/// sum is touched once.
inline void add_light(const BandWork& work,
                      const std::uint32_t* pixel,
                      const Vec3<Lanes>& light,
                      unsigned lanes) {
  if (lanes == 0)
    return;
  std::int64_t r[kWidth<Lanes>], g[kWidth<Lanes>], b[kWidth<Lanes>];
  light_units(light.x, work.most_light, r);
  light_units(light.y, work.most_light, g);
  light_units(light.z, work.most_light, b);
  do {
    const std::uint32_t here = pixel[__builtin_ctz(lanes)];
    std::int64_t sum[3] = {};
    do {
      const int k = __builtin_ctz(lanes);
      sum[0] += r[k];
      sum[1] += g[k];
      sum[2] += b[k];
      lanes &= lanes - 1;
    } while (lanes != 0 && pixel[__builtin_ctz(lanes)] == here);
    std::int64_t* const s = work.sums + static_cast<std::size_t>(here) * 3;
    s[0] += sum[0];
    s[1] += sum[1];
    s[2] += sum[2];
  } while (lanes != 0);
}

/// The pixels whose samples the rays of these sums are.
inline Words<Lanes> pixels_of(const BandWork& work, const Words<Lanes>& sums) {
  return work.pixels ? words_at(work.pixels, sums) : sums + work.first_pixel;
}

}  // namespace grelha::GRELHA_ISA
