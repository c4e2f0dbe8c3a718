#pragma once
// Which instruction set this copy of the hot loops is compiled for: GRELHA_ISA names its namespace,
// GRELHA_ISA_NUMBER tells the sets apart.

// x87 keeps floats in 80 bits until they are stored: pictures would be others.
#if __FLT_EVAL_METHOD__ != 0
#error "floats must be rounded after each operation: compile with -msse2 -mfpmath=sse"
#endif

// Code that is compiled once, such as the building of grids, sees the scalar copy.
#ifndef GRELHA_ISA
#define GRELHA_ISA scalar
#endif

#define GRELHA_ISA_scalar 1
#define GRELHA_ISA_sse2 2
#define GRELHA_ISA_avx2 3
#define GRELHA_ISA_avx512 4
#define GRELHA_ISA_neon 5
#define GRELHA_JOIN_(a, b) a##b
#define GRELHA_JOIN(a, b) GRELHA_JOIN_(a, b)
#define GRELHA_ISA_NUMBER GRELHA_JOIN(GRELHA_ISA_, GRELHA_ISA)

#if GRELHA_ISA_NUMBER == 5
#include <arm_neon.h>
#elif GRELHA_ISA_NUMBER > 1
#include <immintrin.h>
#endif
#if GRELHA_ISA_NUMBER > 1
#include <xsimd/xsimd.hpp>
#endif
