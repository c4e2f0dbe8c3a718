#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace grelha {

/// bytes read or inflated between two questions
inline constexpr std::size_t kPiece = std::size_t(1) << 24;

/// What there is of a scene's file so far, of which the bytes from `fresh` on are new. Throws
/// ParseError when no scene can begin so: a Git LFS pointer, another format that is known
/// (other_format), a mesh that does not say `ply`, a whole piece of text without one digit. A file
/// that inflates without end is found out by its first pieces.
void judge_beginning(const std::string& path, bool ply, std::string_view text, std::size_t fresh);

}  // namespace grelha
