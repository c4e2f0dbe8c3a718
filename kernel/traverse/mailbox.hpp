#pragma once

#include "kernel/grid/view.hpp"
#include "kernel/base/lanes.hpp"

namespace grelha::GRELHA_ISA {

/// Primitives a packet has already been tested against: a small table that may forget and is never
/// wrong.
struct Mailbox {
  static constexpr unsigned kSize = 128;
  alignas(64) std::uint32_t held[kSize];
  void clear() {
    // memset would be a slow call for so few
    const Words<VFloat> none = Words<VFloat>{} + kNoPrimitive;
    for (unsigned i = 0; i < kSize; i += kWidth<VFloat>)
      store_words(held + i, none);
  }
  bool seen(std::uint32_t id) {
    std::uint32_t& slot = held[id % kSize];
    if (slot == id)
      return true;
    slot = id;
    return false;
  }
};

}  // namespace grelha::GRELHA_ISA
