#define GRELHA_ISA neon
#include "kernel/isa/variant.hpp"
