#include "frontend/files/plausible.hpp"

#include <algorithm>

#include "frontend/files/other_formats.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
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
