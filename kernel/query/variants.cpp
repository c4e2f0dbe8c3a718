#include "kernel/query/variants.hpp"

#include <stdexcept>
#include <string>

#include "grelha/isa.hpp"

namespace grelha {

// A macro for each copy that the build compiles. __builtin_cpu_supports also asks whether the
// system saves the wide registers (XGETBV); xsimd 8.1's own query does not.
namespace {
[[maybe_unused]] bool always() {
  return true;
}
}  // namespace

#ifdef GRELHA_SCALAR
namespace scalar {
extern const VariantLoops kLoops;
}
namespace {
const Variant kScalar{"scalar", 1, always, scalar::kLoops};
}  // namespace
#endif

#ifdef GRELHA_SSE2
namespace sse2 {
extern const VariantLoops kLoops;
}
namespace {
bool has_sse2() {
  return __builtin_cpu_supports("sse2");
}
const Variant kSse2{"sse2", 4, has_sse2, sse2::kLoops};
}  // namespace
#endif

#ifdef GRELHA_AVX2
namespace avx2 {
extern const VariantLoops kLoops;
}
namespace {
bool has_avx2() {
  return __builtin_cpu_supports("avx2");
}
const Variant kAvx2{"avx2", 8, has_avx2, avx2::kLoops};
}  // namespace
#endif

#ifdef GRELHA_NEON
namespace neon {
extern const VariantLoops kLoops;
}
namespace {
const Variant kNeon{"neon", 4, always, neon::kLoops};
}  // namespace
#endif

#ifdef GRELHA_AVX512
namespace avx512 {
extern const VariantLoops kLoops;
}
namespace {
// CMakeLists.txt asks for the same where GRELHA_ISAS is native.
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx2") &&
         __builtin_cpu_supports("bmi2");
}
const Variant kAvx512{"avx512", 16, has_avx512, avx512::kLoops};
}  // namespace
#endif

namespace {
constexpr const Variant* kVariants[] = {
#ifdef GRELHA_SCALAR
    &kScalar,
#endif
#ifdef GRELHA_SSE2
    &kSse2,
#endif
#ifdef GRELHA_AVX2
    &kAvx2,
#endif
#ifdef GRELHA_AVX512
    &kAvx512,
#endif
#ifdef GRELHA_NEON
    &kNeon,
#endif
};
}  // namespace

std::span<const Variant* const> variants() {
  return kVariants;
}

const Variant& best_variant() {
  static const Variant* const best = [] {
    const Variant* widest = kVariants[0];  // a build for one processor has no other
    for (const Variant* v : kVariants)
      if (v->is_supported())
        widest = v;
    return widest;
  }();
  return *best;
}

namespace {

/// Rays of a stream that wider registers would leave half empty.
constexpr int kFewRays = 8;

const Variant& best_for_few() {
  static const Variant* const best = [] {
    const Variant* widest = nullptr;
    for (const Variant* v : kVariants)
      if (v->is_supported() && v->lanes <= kFewRays)
        widest = v;
    return widest ? widest : &best_variant();
  }();
  return *best;
}

}  // namespace

const Variant& choose_variant(std::string_view name, std::size_t rays) {
  return name == "best" && rays <= kFewRays ? best_for_few() : choose_variant(name);
}

const Variant* find_variant(std::string_view name) {
  if (name == "best")
    return &best_variant();
  for (const Variant* v : kVariants)
    if (v->name == name)
      return v;
  return nullptr;
}

const Variant& choose_variant(std::string_view name) {
  const Variant* const v = find_variant(name);
  if (!v)
    throw std::invalid_argument("this build has no instruction set \"" + std::string(name) + "\"");
  if (!v->is_supported())
    throw std::invalid_argument("this processor has no " + std::string(name));
  return *v;
}

std::vector<Isa> isas() {
  std::vector<Isa> out;
  for (const std::string_view name : {"scalar", "sse2", "avx2", "avx512", "neon"}) {
    const Variant* const v = find_variant(name);
    out.push_back({name, v != nullptr, v != nullptr && v->is_supported()});
  }
  return out;
}

}  // namespace grelha
