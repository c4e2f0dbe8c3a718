#include "frontend/ply/stl_colors.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "frontend/ply/ply_faces.hpp"

namespace grelha {
namespace {

constexpr std::uint16_t kFlag = 0x8000, kBrightest = 31;

/// Four bytes behind a key of the header, which has a value of `size` bytes: red, green, blue,
/// alpha. None where that value is missing, or all zeros.
std::optional<std::array<unsigned char, 4>> color_behind(std::string_view key,
                                                         std::size_t size,
                                                         std::string_view header) {
  const std::size_t at = header.find(key);
  if (at == header.npos || header.size() - at - key.size() < size)
    return {};
  const std::string_view value = header.substr(at + key.size(), size);
  if (value.find_first_not_of('\0') == value.npos)
    return {};
  std::array<unsigned char, 4> found{};
  std::copy_n(value.begin(), found.size(), found.begin());
  return found;
}

/// Of 15 bits, red the lowest five.
Float3 color_of(std::uint16_t word) {
  const auto channel = [word](int shift) {
    return light_of_byte((word >> shift & kBrightest) * 255. / kBrightest);
  };
  return {channel(0), channel(5), channel(10)};
}

/// Returns whether words with bit 15 are colours where they should say that the object's is meant:
/// no other word is a colour, and they differ, or are neither all zeros nor all ones.
bool flag_means_color(std::span<const std::uint16_t> words) {
  std::optional<std::uint16_t> first;
  bool differ = false;
  for (const std::uint16_t word : words) {
    if (word < kFlag && word != 0)
      return false;
    if (word < kFlag)
      continue;
    differ |= first && *first != word;
    first = word;
  }
  return first && (differ || (*first != kFlag && *first != 0xFFFF));
}

}  // namespace

void color_stl_faces(std::string_view header, std::span<const std::uint16_t> words, Mesh& mesh) {
  const auto material = color_behind("MATERIAL=", 12, header);
  const auto object = material ? material : color_behind("COLOR=", 4, header);
  const auto is_flagged = [](std::uint16_t word) { return word >= kFlag; };
  const auto is_zero = [](std::uint16_t word) { return word == 0; };
  if (!object && std::ranges::none_of(words, is_flagged))
    return;
  const bool flagged = !object || flag_means_color(words);
  const bool none = std::ranges::all_of(words, is_zero);  // the object's alone
  const Float3 others = object ? Float3{light_of_byte((*object)[0]),
                                        light_of_byte((*object)[1]),
                                        light_of_byte((*object)[2])}
                               : Float3{1, 1, 1};
  mesh.colors_of_faces = true;
  mesh.has_alpha = object && (*object)[3] != 255;
  const std::size_t faces = mesh.indices.size() / 3;
  for (std::size_t f = 0; f < faces; ++f) {
    const bool own = f < words.size() && !none && is_flagged(words[f]) == flagged;
    Float3 color = own ? color_of(words[f]) : others;
    if (own && !object)  // blue is the lowest
      std::swap(color.x, color.z);
    mesh.red.push_back(color.x);
    mesh.green.push_back(color.y);
    mesh.blue.push_back(color.z);
  }
}

}  // namespace grelha
