#define GRELHA_ISA avx2
#include "kernel/isa/variant.hpp"
