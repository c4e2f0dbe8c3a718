#pragma once

#include <cstdint>

namespace grelha {

/// Avalanche of 32 bits (C. Wellons' lowbias32).
inline std::uint32_t scattered_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ x >> 16;
}

}  // namespace grelha
