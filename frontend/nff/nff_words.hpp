#pragma once

#include <span>
#include <string>
#include <string_view>

namespace grelha {

/// The keyword of NFF that an unknown word was probably meant to be. It is the short one for what
/// the word spells out (`sphere`), the same in small letters, or the nearest; empty when there is
/// none.
std::string suggested_keyword(std::string_view word, std::span<const std::string_view> known);

}  // namespace grelha
