#define GRELHA_ISA scalar_double
#include "kernel/isa/exact_variant.hpp"

namespace grelha {
extern const ExactLoops k_scalar_double_loops;
const ExactLoops k_scalar_double_loops = GRELHA_EXACT_LOOPS;
}  // namespace grelha
