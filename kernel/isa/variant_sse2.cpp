#define GRELHA_ISA sse2
#include "kernel/isa/variant.hpp"
