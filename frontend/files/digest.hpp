#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

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
  Digest();
  ~Digest();

  void bytes(const void* data, std::size_t size);

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

  std::uint64_t low64() const;
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace grelha
