// The queries of one copy of the kernel; ab.py defines its GRELHA_ISA. Without the loops of
// pictures it compiles in a third of the time.
#include "kernel/query/loops.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/traverse/one_ray.hpp"  // loops.hpp of older trees does not include it

namespace grelha::GRELHA_ISA {

extern const VariantLoops kLoops;
const VariantLoops kLoops{.closest = closest,
                          .occluded = occluded,
                          .closest_one = closest_one,
                          .occluded_one = occluded_one};

}  // namespace grelha::GRELHA_ISA
