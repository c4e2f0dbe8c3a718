#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace grelha {

/// Names the format of a file that is neither NFF nor PLY by its first bytes, as in messages ("an
/// OFF mesh: convert it to PLY"); empty for an unknown format. `text`: the bytes read so far.
std::string_view other_format(std::string_view text);

/// bytes read or inflated between two questions
inline constexpr std::size_t kPart = std::size_t(1) << 24;

/// Throws ParseError for a Git LFS pointer, and for another known format (other_format).
void refuse_other_format(const std::string& path, std::string_view expected, std::string_view text);

/// Checks the bytes of a scene's file read so far; those from `fresh` on are new. Throws ParseError
/// when no scene begins so: a Git LFS pointer, another known format (other_format), a mesh that
/// does not say `ply`, a whole piece of text without one digit. This detects a file that inflates
/// without end by its first pieces.
void validate_start(const std::string& path, bool ply, std::string_view text, std::size_t fresh);

}  // namespace grelha
