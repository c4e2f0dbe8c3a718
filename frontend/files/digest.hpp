#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#define XXH_INLINE_ALL  // the library is a header then, and nothing to install beside the program
#include <xxhash.h>

namespace grelha {

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
        auto b = std::bit_cast<std::array<unsigned char, sizeof(T)>>(v);
        for (std::size_t i = 0; i < sizeof(T) / 2; ++i)
          std::swap(b[i], b[sizeof(T) - 1 - i]);
        bytes(b.data(), b.size());
      }
    }
  }

  std::uint64_t low64() const { return XXH3_128bits_digest(&state_).low64; }
  std::string hex() const {
    constexpr char kDigits[] = "0123456789abcdef";
    const XXH128_hash_t h = XXH3_128bits_digest(&state_);
    std::string text;
    for (const std::uint64_t half : {std::uint64_t(h.high64), std::uint64_t(h.low64)})
      for (int shift = 60; shift >= 0; shift -= 4)
        text += kDigits[half >> shift & 15];
    return text;
  }

 private:
  XXH3_state_t state_;
};

}  // namespace grelha
