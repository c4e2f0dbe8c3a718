#pragma once
// The instruction sets that the kernel's hot loops are compiled for.

#include <string_view>
#include <vector>

namespace grelha {

/// One compiled copy of the kernel's hot loops.
struct Isa {
  std::string_view name;  ///< "scalar", "sse2", "avx2", "avx512", "neon"
  bool compiled, is_supported;
};
/// All copies this version knows, scalar first.
std::vector<Isa> isas();

}  // namespace grelha
