#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace grelha {

inline constexpr std::size_t kStripBytes = std::size_t(1) << 16;

/// A zlib stream (RFC 1950) of `data`. Threads share its strips of kStripBytes. Each strip is
/// deflated with the data before it as its dictionary, which loses little. The bytes depend only on
/// `data` and zlib's `level`, 0 to 9. Throws std::bad_alloc.
std::string deflate_in_strips(std::string_view data, int level);

}  // namespace grelha
