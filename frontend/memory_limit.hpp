#pragma once

#include <cstdint>

namespace grelha {

/// Bytes of memory this machine has; 0: it does not say.
std::uint64_t machine_memory();

/// False under sanitizers, which own more than any machine has.
bool memory_can_be_limited();

/// Lets this process own no more than so many bytes: what would, a hostile file or a large picture, throws std::bad_alloc instead of
/// bringing the machine down. Does nothing where memory_can_be_limited() is false.
void limit_memory(std::uint64_t bytes);

}  // namespace grelha
