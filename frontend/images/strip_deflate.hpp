#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace grelha {

inline constexpr std::size_t kStripBytes = std::size_t(1) << 16;

/// A zlib stream (RFC 1950) of `data`. Threads share its strips of kStripBytes; each is deflated
/// with what stands before it for a dictionary, so that little is lost. The bytes depend on nothing
/// but `data` and zlib's `level`, 0 to 9. Throws std::bad_alloc.
std::string deflate_in_strips(std::string_view data, int level);

}  // namespace grelha
