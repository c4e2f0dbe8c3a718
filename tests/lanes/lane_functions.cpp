#include "tests/lanes/lane_functions.hpp"

#include <stdexcept>
#include <string>

// GRELHA_LANE_COPIES is COPY(scalar) COPY(sse2) ..., one for each instruction set of the build.
#define COPY(isa)                                 \
  namespace grelha::isa##_lanes {                 \
    extern const test::LaneFunctions k_functions; \
  }
GRELHA_LANE_COPIES
#undef COPY

namespace grelha::test {

const LaneFunctions& lane_functions(const Variant& variant) {
#define COPY(isa)           \
  if (variant.name == #isa) \
    return isa##_lanes::k_functions;
  GRELHA_LANE_COPIES
#undef COPY
  throw std::invalid_argument("no functions over lanes of " + std::string(variant.name));
}

}  // namespace grelha::test
