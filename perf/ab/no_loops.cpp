// Stands for the scalar copy, which every build lists and a wider one takes the place of.
#include "kernel/query/variants.hpp"

namespace grelha::scalar {

extern const VariantLoops kLoops;
const VariantLoops kLoops{};

}  // namespace grelha::scalar
