#define GRELHA_ISA scalar
#include "kernel/isa/variant.hpp"
