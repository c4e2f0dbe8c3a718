#pragma once

#include <cstdint>
#include <string>

#include "frontend/files/parse_error.hpp"

namespace grelha {

/// Bytes of memory this machine has; 0: it does not say.
std::uint64_t machine_memory();

/// Bytes this process may own, and those it does; a limit no number reaches where there is none.
struct OwnMemory {
  std::uint64_t limit, owned;
  std::uint64_t left() const { return limit - (owned < limit ? owned : limit); }
};
OwnMemory own_memory();

/// False under sanitizers, which own more than any machine has.
bool memory_can_be_limited();

/// Lets this process own no more than so many bytes, by --max-memory; 0: no more than the machine
/// has. A hostile file or a large picture then throws std::bad_alloc instead of bringing the
/// machine down. Does nothing where memory_can_be_limited() is false.
void limit_memory(std::uint64_t bytes);

/// A number of bytes in words, as 1.5 GB.
std::string gigabytes(std::uint64_t bytes);

/// How much memory this process may own, and who says so: `0.315 GB (--max-memory)`.
std::string memory_there_is();

/// `out of memory: ...`
std::string out_of_memory();

/// There is no memory for what a file holds.
struct OutOfMemory : FileError {
  explicit OutOfMemory(const std::string& path) : FileError(path, out_of_memory()) {}
};

}  // namespace grelha
