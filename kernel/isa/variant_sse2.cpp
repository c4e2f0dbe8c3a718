#define GRELHA_ISA sse2
#include "kernel/isa/variant.hpp"

namespace grelha {
extern const VariantLoops k_sse2_loops;
const VariantLoops k_sse2_loops = GRELHA_LOOPS;
}  // namespace grelha
