#define GRELHA_ISA avx2_double
#include "kernel/isa/exact_variant.hpp"

namespace grelha {
extern const ExactLoops k_avx2_double_loops;
const ExactLoops k_avx2_double_loops = GRELHA_EXACT_LOOPS;
}  // namespace grelha
