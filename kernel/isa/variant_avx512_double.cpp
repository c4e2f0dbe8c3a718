#define GRELHA_ISA avx512_double
#include "kernel/isa/exact_variant.hpp"

namespace grelha {
extern const ExactLoops k_avx512_double_loops;
const ExactLoops k_avx512_double_loops = GRELHA_EXACT_LOOPS;
}  // namespace grelha
