#pragma once

#include <cstdint>
#include <string>

#include "frontend/files/parse_error.hpp"

namespace grelha {

/// Returns the bytes of memory of this machine, or 0 if unknown.
std::uint64_t system_memory();

/// Bytes that this process may own, and that it owns. Without a limit, `limit` is the largest
/// number.
struct OwnMemory {
  std::uint64_t limit, owned;
  std::uint64_t left() const { return limit - (owned < limit ? owned : limit); }
};
OwnMemory own_memory();

/// False under sanitizers, which own more than any machine has.
bool memory_can_be_limited();

/// Limits this process to so many bytes (--max-memory); 0 limits it to the memory of the machine. A
/// hostile file or a large picture then throws std::bad_alloc instead of exhausting the machine.
/// Does nothing where memory_can_be_limited() is false.
void limit_memory(std::uint64_t bytes);

/// A number of bytes in words, as 1.5 GB.
std::string gigabytes(std::uint64_t bytes);

/// The memory limit of this process and its origin: `0.315 GB (--max-memory)`.
std::string available_memory();

/// `out of memory: ...`
std::string out_of_memory();

/// There is no memory for what a file holds.
struct OutOfMemory : FileError {
  explicit OutOfMemory(const std::string& path) : FileError(path, out_of_memory()) {}
};

}  // namespace grelha
