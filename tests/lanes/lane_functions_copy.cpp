// Compiled once per instruction set, see CMakeLists.txt: GRELHA_ISA is its name and "_lanes".
#include "kernel/render/band.hpp"
#include "tests/lanes/frustum_check.hpp"

namespace grelha::GRELHA_ISA {

inline void powers(const float* x, const float* y, float* out, int count) {
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    alignas(64) float in[2][kWidth<Lanes>], r[kWidth<Lanes>];
    const int left = count - i < kWidth<Lanes> ? count - i : kWidth<Lanes>;
    for (int k = 0; k < kWidth<Lanes>; ++k) {
      in[0][k] = x[i + (k < left ? k : 0)];
      in[1][k] = y[i + (k < left ? k : 0)];
    }
    store(r, power(load<Lanes>(in[0]), load<Lanes>(in[1])));
    for (int k = 0; k < left; ++k)
      out[i + k] = r[k];
  }
}

/// Writes the lanes of the samples left.
inline void store_some(float* p, const Lanes& a, int left) {
  float v[kWidth<Lanes>];
  store(v, a);
  for (int k = 0; k < kWidth<Lanes> && k < left; ++k)
    p[k] = v[k];
}

inline void samples(const SamplePlan& plan,
                    const std::uint32_t* pixel,
                    const std::uint32_t* index,
                    int dimension,
                    const std::uint32_t* key,
                    const Strata& strata,
                    float* u,
                    float* v,
                    int count) {
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    std::uint32_t in[3][kWidth<Lanes>];
    const int left = count - i < kWidth<Lanes> ? count - i : kWidth<Lanes>;
    for (int k = 0; k < kWidth<Lanes>; ++k) {
      const int from = i + (k < left ? k : 0);
      in[0][k] = pixel[from];
      in[1][k] = index[from];
      in[2][k] = key[from];
    }
    const PairOf<Lanes> p = sample_pairs<Lanes>(plan,
                                                load_words<Lanes>(in[0]),
                                                load_words<Lanes>(in[1]),
                                                dimension,
                                                load_words<Lanes>(in[2]),
                                                strata);
    store_some(u + i, p.u, left);
    store_some(v + i, p.v, left);
  }
}

extern const test::LaneFunctions k_functions;
const test::LaneFunctions k_functions{powers, samples, camera_rays, check_frustum, kPacket};

}  // namespace grelha::GRELHA_ISA
