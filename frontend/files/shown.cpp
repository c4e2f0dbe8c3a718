#include "frontend/files/shown.hpp"

#include <algorithm>
#include <cstdint>

namespace grelha {
namespace {

struct Character {
  std::uint32_t code;
  std::size_t bytes;
};

constexpr Character kNone{0, 1};  ///< a byte that begins no character

/// The first one of a text that is not empty. A form longer than need be is none.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return std::uint32_t(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80)
    return {lead, 1};
  const std::size_t bytes = lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes)
    return kNone;
  std::uint32_t code = lead & (0x7Fu >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0u) != 0x80)
      return kNone;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  return code < kLeast[bytes] || code > 0x10FFFF || is_surrogate ? kNone : Character{code, bytes};
}

bool is_printable(std::uint32_t code) {
  const auto within = [code](std::uint32_t low, std::uint32_t high) {
    return code >= low && code <= high;
  };
  const bool is_control = code < 0x20 || within(0x7F, 0x9F);
  const bool ends_line = within(0x2028, 0x2029);
  const bool turns = within(0x200E, 0x200F) || within(0x202A, 0x202E) || within(0x2066, 0x2069);
  return !is_control && !ends_line && !turns;
}

}  // namespace

std::string printable_text(std::string_view text) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const Character first = first_of(text);
    if (text[0] == '\n' || is_printable(first.code))
      clean += text.substr(0, first.bytes);
    else
      clean += '?';
    text.remove_prefix(first.bytes);
  }
  return clean;
}

std::string printable_line(std::string_view text) {
  std::string line = printable_text(text);
  std::ranges::replace(line, '\n', '?');
  return line;
}

}  // namespace grelha
