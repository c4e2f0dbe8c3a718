#define GRELHA_ISA scalar
#include "kernel/isa/variant.hpp"

namespace grelha {
extern const VariantLoops k_scalar_loops;
const VariantLoops k_scalar_loops = GRELHA_LOOPS;
}  // namespace grelha
