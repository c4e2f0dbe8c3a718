#include "frontend/files/shown.hpp"

#include <algorithm>

namespace grelha {

std::string printable_text(std::string_view text) {
  std::string clean;
  unsigned char before = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_wide = byte >= 0x80 && byte < 0xA0 && (before < 0x80 || before == 0xC2);
    const bool is_control = (byte < 0x20 && byte != '\n') || byte == 0x7F || is_wide;
    if (is_wide && before == 0xC2)
      clean.pop_back();
    clean += is_control ? '?' : c;
    before = byte;
  }
  return clean;
}

std::string printable_line(std::string_view text) {
  std::string line = printable_text(text);
  std::ranges::replace(line, '\n', '?');
  return line;
}

}  // namespace grelha
