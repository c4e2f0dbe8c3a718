#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grelha {

/// Letters to add, drop, change or swap with their neighbour to make `b` of `a` (each place edited
/// once).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word that was probably meant by the one found: the first of the nearest, at most a third of
/// its letters away, or one that it begins; capitals are as small letters. Empty when there is
/// none.
std::string_view nearest(std::string_view word_found, std::span<const std::string_view> words);

/// `; did you mean WORD?`, or nothing.
std::string suggest(std::string_view found, std::span<const std::string_view> words);

}  // namespace grelha
