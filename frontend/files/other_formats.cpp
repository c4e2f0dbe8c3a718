#include "frontend/files/other_formats.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "frontend/files/text.hpp"

namespace grelha {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::size_t kLook = std::size_t(1) << 16;  ///< bytes that tell a text's format

struct Magic {
  std::string_view bytes, name;
};

constexpr Magic kMagics[] = {
    {"glTF"sv, "a binary glTF scene: convert it to PLY"},
    {"# .PCD"sv, "a PCD point cloud: convert it to PLY"},
    {"#VRML"sv, "a VRML scene: convert it to PLY"},
    {"Kaydara FBX"sv, "an FBX scene: convert it to PLY"},
    {"; FBX"sv, "an FBX scene: convert it to PLY"},
    {"BLENDER"sv, "a Blender file: export it as PLY"},
    {"#usda"sv, "a USD scene: convert it to PLY"},
    {"PXR-USDC"sv, "a USD scene: convert it to PLY"},
    {"LASF"sv, "a LAS point cloud: convert it to PLY"},
    {"\x89PNG"sv, "a PNG picture"},
    {"\xFF\xD8\xFF"sv, "a JPEG picture"},
    {"GIF8"sv, "a GIF picture"},
    {"#?RADIANCE"sv, "a Radiance picture"},
    {"\x76\x2f\x31\x01"sv, "an OpenEXR picture"},
    {"%PDF"sv, "a PDF document"},
    {"PK\x03\x04"sv, "a ZIP archive: unpack it"},
    {"BZh"sv, "bzip2 data: unpack them (gzip would be read)"},
    {"\xFD"
     "7zXZ"sv,
     "xz data: unpack them (gzip would be read)"},
    {"\x28\xB5\x2F\xFD"sv, "zstd data: unpack them (gzip would be read)"},
    {"7z\xBC\xAF"sv, "a 7z archive: unpack it"},
    {"\xFF\xFE"sv, "UTF-16 text: save it as UTF-8"},
    {"\xFE\xFF"sv, "UTF-16 text: save it as UTF-8"},
};

bool has(std::string_view text, std::string_view word) {
  return text.find(word) != text.npos;
}

/// Binary STL says its length: a count behind 80 bytes that may be anything, and 50 for each
/// triangle, whose first numbers are its normal.
bool is_binary_stl(std::string_view text) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  if constexpr (std::endian::native != std::endian::little)
    return false;
  if (text.size() < kHeader + kTriangle)
    return false;
  std::uint32_t count = 0;
  float normal[3];
  std::memcpy(&count, text.data() + kHeader - sizeof count, sizeof count);
  std::memcpy(normal, text.data() + kHeader, sizeof normal);
  const float squared = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2];
  const std::uint64_t size = kHeader + std::uint64_t(count) * kTriangle;
  return size == text.size() ||
         (size > text.size() && (squared == 0 || std::abs(squared - 1) < .01f) &&
          has(text.substr(kHeader - sizeof count, kTriangle), "\0"sv));
}

bool is_stl(std::string_view text) {
  return (text.starts_with("solid") && has(text.substr(0, kLook), "facet")) || is_binary_stl(text);
}

/// Returns true for `OFF`, also behind letters for vertex attributes (`NOFF`).
bool is_off(std::string_view word) {
  for (const std::string_view letter : {"ST"sv, "C"sv, "N"sv, "4"sv, "n"sv})
    if (word.starts_with(letter))
      word.remove_prefix(letter.size());
  return word == "OFF";
}

/// Returns true if the first line begins with a keyword of OBJ and an early line is a vertex: `v`
/// and a number. NFF's `v` begins a view.
bool is_obj(std::string_view text) {
  static constexpr std::string_view kFirst[] = {
      "v", "vn", "vt", "o", "g", "mtllib", "usemtl", "s", "f"};
  Words words("", text, 0, Comments::kAll);
  const std::string_view first = words.peek();
  if (std::ranges::find(kFirst, first) == std::end(kFirst))
    return false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (word == "v" && looks_like_number(words.peek_on_line()))
      return true;
    words.skip_line();
  }
  return false;
}

std::string_view name_of_xml(std::string_view text) {
  if (has(text, "<COLLADA"))
    return "a COLLADA scene: convert it to PLY";
  if (has(text, "<X3D"))
    return "an X3D scene: convert it to PLY";
  if (has(text, "<html") || has(text, "<HTML") || has(text, "<!DOCTYPE html"))
    return "a web page";
  return "XML";
}

std::string_view name_of_json(std::string_view text) {
  for (const std::string_view key : {"\"asset\"", "\"accessors\"", "\"bufferViews\"", "\"meshes\""})
    if (has(text, key))
      return "a glTF scene: convert it to PLY";
  return "JSON";
}

}  // namespace

std::string_view other_format(std::string_view text) {
  if (is_stl(text))
    return "an STL mesh: convert it to PLY";
  for (const Magic& magic : kMagics)
    if (text.starts_with(magic.bytes))
      return magic.name;
  text = text.substr(byte_order_mark(text), kLook);
  const std::string_view first = Words("", text, 0, Comments::kAll).next();
  if (first.starts_with("MM") && has(text.substr(0, 8), "\0"sv))  // and its length
    return "a 3DS mesh: convert it to PLY";
  if (is_off(first))
    return "an OFF mesh: convert it to PLY";
  if ((first == "VERSION" || first == "FIELDS") && has(text, "FIELDS"))
    return "a PCD point cloud: convert it to PLY";
  if (is_obj(text))
    return "a Wavefront OBJ mesh: convert it to PLY";
  if (first.starts_with('<'))
    return name_of_xml(text);
  if (first.starts_with('{'))
    return name_of_json(text);
  if (has(text, "\nWorldBegin"))
    return "a pbrt scene";
  return {};
}

}  // namespace grelha
