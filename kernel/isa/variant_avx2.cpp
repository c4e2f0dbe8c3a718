#define GRELHA_ISA avx2
#include "kernel/isa/variant.hpp"

namespace grelha {
extern const VariantLoops k_avx2_loops;
const VariantLoops k_avx2_loops = GRELHA_LOOPS;
}  // namespace grelha
