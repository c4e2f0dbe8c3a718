// Stands for the scalar copy, which older commits always list; a wider one takes its place.
#include "kernel/query/variants.hpp"

namespace grelha::scalar {

extern const VariantLoops kLoops;
const VariantLoops kLoops{};

}  // namespace grelha::scalar
