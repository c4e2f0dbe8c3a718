#define GRELHA_ISA avx512
#include "kernel/isa/variant.hpp"

namespace grelha {
extern const VariantLoops k_avx512_loops;
const VariantLoops k_avx512_loops = GRELHA_LOOPS;
}  // namespace grelha
