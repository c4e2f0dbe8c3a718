#pragma once

#include <array>
#include <bit>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#define XXH_INLINE_ALL  // the library is a header then, and nothing to install beside the program
#include <xxhash.h>

namespace grelha {

template <class T>
T swapped_if_big(T v) {
  static_assert(std::is_arithmetic_v<T>);
  if constexpr (std::endian::native == std::endian::little || sizeof(T) == 1)
    return v;
  auto bytes = std::bit_cast<std::array<unsigned char, sizeof(T)>>(v);
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i)
    std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  return std::bit_cast<T>(bytes);
}

/// XXH3 of numbers in little-endian order: the same on all machines, and in all versions of xxHash
/// from 0.8 on.
class Digest {
 public:
  Digest() { XXH3_128bits_reset(&state_); }

  void bytes(const void* data, std::size_t size) { XXH3_128bits_update(&state_, data, size); }

  template <class T>
  void numbers(std::span<const T> values) {
    static_assert(std::is_arithmetic_v<T>);
    if constexpr (std::endian::native == std::endian::little) {
      bytes(values.data(), values.size_bytes());
    } else {
      for (const T& v : values) {
        const T little = swapped_if_big(v);
        bytes(&little, sizeof little);
      }
    }
  }

  std::uint64_t low64() const { return XXH3_128bits_digest(&state_).low64; }
  std::string hex() const {
    const XXH128_hash_t h = XXH3_128bits_digest(&state_);
    char text[33];
    std::snprintf(text, sizeof text, "%016" PRIx64 "%016" PRIx64, h.high64, h.low64);
    return text;
  }

 private:
  XXH3_state_t state_;
};

}  // namespace grelha
