#define GRELHA_ISA avx512
#include "kernel/isa/variant.hpp"
