// Compiled once per instruction set, see CMakeLists.txt: GRELHA_ISA is its name and "_lanes".
#include "kernel/shade/strip.hpp"
#include "tests/lanes/frustum_check.hpp"

namespace grelha::GRELHA_ISA {

inline void powers(const float* x, const float* y, float* out, int count) {
  for (int i = 0; i < count; i += kWidth<VFloat>) {
    alignas(64) float in[2][kWidth<VFloat>], r[kWidth<VFloat>];
    const int left = count - i < kWidth<VFloat> ? count - i : kWidth<VFloat>;
    for (int k = 0; k < kWidth<VFloat>; ++k) {
      in[0][k] = x[i + (k < left ? k : 0)];
      in[1][k] = y[i + (k < left ? k : 0)];
    }
    store(r, power(load<VFloat>(in[0]), load<VFloat>(in[1])));
    for (int k = 0; k < left; ++k)
      out[i + k] = r[k];
  }
}

/// Writes the lanes of the samples left.
inline void store_some(float* p, const VFloat& a, int left) {
  float v[kWidth<VFloat>];
  store(v, a);
  for (int k = 0; k < kWidth<VFloat> && k < left; ++k)
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
  for (int i = 0; i < count; i += kWidth<VFloat>) {
    std::uint32_t in[3][kWidth<VFloat>];
    const int left = count - i < kWidth<VFloat> ? count - i : kWidth<VFloat>;
    for (int k = 0; k < kWidth<VFloat>; ++k) {
      const int from = i + (k < left ? k : 0);
      in[0][k] = pixel[from];
      in[1][k] = index[from];
      in[2][k] = key[from];
    }
    const PairOf<VFloat> p = sample_pairs<VFloat>(plan,
                                                  load_words<VFloat>(in[0]),
                                                  load_words<VFloat>(in[1]),
                                                  dimension,
                                                  load_words<VFloat>(in[2]),
                                                  strata);
    store_some(u + i, p.u, left);
    store_some(v + i, p.v, left);
  }
}

extern const test::LaneFunctions k_functions;
const test::LaneFunctions k_functions{powers, samples, camera_rays, check_frustum, kPacket};

}  // namespace grelha::GRELHA_ISA
