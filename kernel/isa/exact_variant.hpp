#pragma once
// What each variant_*_double.cpp compiles: the loops that trace, with every test of a ray and a
// primitive in double. Shading is that of the single copy.

#define GRELHA_DOUBLE
#include "kernel/query/span.hpp"

#define GRELHA_EXACT_LOOPS                              \
  {                                                     \
    GRELHA_ISA::closest, GRELHA_ISA::occluded, {        \
      GRELHA_ISA::trace<false>, GRELHA_ISA::trace<true> \
    }                                                   \
  }
