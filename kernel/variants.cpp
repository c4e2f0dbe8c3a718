#include "kernel/variants.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace grelha {

extern const VariantLoops k_scalar_loops;
extern const ExactLoops k_scalar_double_loops;
#ifdef GRELHA_X86_VARIANTS
extern const VariantLoops k_sse2_loops, k_avx2_loops, k_avx512_loops;
extern const ExactLoops k_sse2_double_loops, k_avx2_double_loops, k_avx512_double_loops;
#endif

namespace {

// __builtin_cpu_supports also asks whether the system saves the wide registers (XGETBV); xsimd 8.1's own query does not.
#ifdef GRELHA_X86_VARIANTS
bool has_sse2() { return __builtin_cpu_supports("sse2"); }
bool has_avx2() { return __builtin_cpu_supports("avx2"); }
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd") && has_avx2() && __builtin_cpu_supports("bmi2");
}
#endif
bool always() { return true; }

const Variant kScalar{"scalar", 1, always, k_scalar_loops, k_scalar_double_loops};
#ifdef GRELHA_X86_VARIANTS
const Variant kSse2{"sse2", 4, has_sse2, k_sse2_loops, k_sse2_double_loops};
const Variant kAvx2{"avx2", 8, has_avx2, k_avx2_loops, k_avx2_double_loops};
const Variant kAvx512{"avx512", 16, has_avx512, k_avx512_loops, k_avx512_double_loops};
constexpr std::array<const Variant*, 4> kVariants{&kScalar, &kSse2, &kAvx2, &kAvx512};
#else
constexpr std::array<const Variant*, 1> kVariants{&kScalar};
#endif

}  // namespace

std::span<const Variant* const> variants() { return kVariants; }

const Variant* find_variant(std::string_view name) {
  const Variant* found = nullptr;
  for (const Variant* v : kVariants)
    if (v->name == name || (name == "best" && v->runs_here())) found = v;
  return found;
}

const Variant& choose_variant(std::string_view name) {
  const Variant* const v = find_variant(name);
  if (!v) throw std::invalid_argument("this build has no instruction set \"" + std::string(name) + "\"");
  if (!v->runs_here()) throw std::invalid_argument("this processor has no " + std::string(name));
  return *v;
}

}  // namespace grelha
