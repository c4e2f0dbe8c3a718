#include "frontend/files/digest.hpp"

#include <cinttypes>
#include <cstdio>

#define XXH_INLINE_ALL  // the library is a header then, and nothing to install beside the program
#include <xxhash.h>

namespace grelha {

struct Digest::State {
  XXH3_state_t xxh3;
};

Digest::Digest() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh3);
}
Digest::~Digest() = default;

void Digest::bytes(const void* data, std::size_t size) {
  XXH3_128bits_update(&state_->xxh3, data, size);
}

std::uint64_t Digest::low64() const {
  return XXH3_128bits_digest(&state_->xxh3).low64;
}

std::string Digest::hex() const {
  const XXH128_hash_t h = XXH3_128bits_digest(&state_->xxh3);
  char text[33];
  std::snprintf(text, sizeof text, "%016" PRIx64 "%016" PRIx64, h.high64, h.low64);
  return text;
}

}  // namespace grelha
