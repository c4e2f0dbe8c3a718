#include "frontend/files/other_formats.hpp"

#include <algorithm>

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

}  // namespace

std::string_view other_format(std::string_view text) {
  for (const Magic& magic : kMagics)
    if (text.starts_with(magic.bytes))
      return magic.name;
  text = text.substr(byte_order_mark(text), kLook);
  if (text.starts_with("solid") && has(text, "facet"))
    return "an STL mesh: give it a name ending in .stl";
  const std::string_view first = Words("", text, 0, Comments::kAll).next();
  if (first == "OFF" || first == "NOFF" || first == "COFF")
    return "an OFF mesh: convert it to PLY";
  if (is_obj(text))
    return "a Wavefront OBJ mesh: convert it to PLY";
  if (first.starts_with('<'))
    return "XML or a web page";
  if (first.starts_with('{'))
    return has(text, "\"asset\"") ? "a glTF scene: convert it to PLY" : "JSON";
  return {};
}

namespace {

constexpr std::size_t kStart = 4096;  ///< bytes that hold the first words of any file

bool has_digit(std::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

void refuse_other_format(const std::string& path,
                         std::string_view expected,
                         std::string_view text) {
  if (text.starts_with("version https://git-lfs"))
    throw ParseError(
        Position{path, 1, 1, 0},
        "expected a scene, found a Git LFS pointer: the file it stands for was not downloaded");
  if (const std::string_view name = other_format(text); !name.empty())
    throw ParseError(Position{path, 1, 1, 0}, expected, name);
}

void validate_start(const std::string& path, bool ply, std::string_view text, std::size_t fresh) {
  const std::string_view start = text.substr(0, kStart);
  if (fresh == 0)
    refuse_other_format(path, ply ? "PLY" : "NFF, PLY or STL", text);
  if (ply && fresh == 0) {
    Words words(path, start, byte_order_mark(start), Comments::kNone);
    const std::string_view magic = words.next();
    if (!magic.empty() && magic != "ply")
      throw ParseError(words.position(magic), "\"ply\" on the first line", quoted(magic));
  }
  if (ply && start.find("format binary") != start.npos)
    return;
  const std::string_view piece = text.substr(fresh);
  if (piece.size() >= kPart && !has_digit(piece))
    throw ParseError(Position{path, 0, 0, fresh},
                     "a scene's numbers",
                     std::to_string(piece.size()) + " bytes without a digit");
}

}  // namespace grelha
