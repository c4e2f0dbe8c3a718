#include "frontend/ply/stl_binary.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace grelha {
namespace {

constexpr std::size_t kBegin = 84;  // 80 bytes of any content, and the number of triangles
constexpr std::size_t kTriangle = 50, kNormal = 12, kAttribute = 48;
constexpr std::uint32_t kUnknown = 0xFFFFFFFF;

std::uint32_t reversed(std::uint32_t word) {
  return word << 24 | (word & 0xFF00) << 8 | (word >> 8 & 0xFF00) | word >> 24;
}

std::uint32_t word_at(const char* p, bool big_endian) {
  std::uint32_t word = 0;
  std::memcpy(&word, p, sizeof word);
  return big_endian == (std::endian::native == std::endian::big) ? word : reversed(word);
}

float number_at(const char* p, bool big_endian) {
  return std::bit_cast<float>(word_at(p, big_endian));
}

std::size_t attribute_at(const char* triangle) {
  const auto byte = [&](std::size_t i) {
    return static_cast<unsigned char>(triangle[kAttribute + i]);
  };
  return byte(0) + std::size_t{256} * byte(1);
}

/// The bytes behind the count.
std::uint64_t body(std::string_view bytes) {
  return bytes.size() - std::min(bytes.size(), kBegin);
}

/// Steps over up to `most` triangles, each with the bytes that its attribute counts, while they lie
/// in the file.
StlLayout with_lengths(std::string_view bytes, std::uint64_t most) {
  StlLayout found{0, false, true, kBegin};
  while (found.triangles < most && bytes.size() - found.end >= kTriangle) {
    const std::size_t size = kTriangle + attribute_at(bytes.data() + found.end);
    if (bytes.size() - found.end < size)
      break;
    found.end += size;
    ++found.triangles;
  }
  return found;
}

StlLayout plain(std::uint64_t triangles, bool big_endian = false) {
  return {triangles, big_endian, false, kBegin + kTriangle * triangles};
}

/// Zero, or of a size that some unit gives to things: of other bytes, read as floats, few are.
bool is_plausible(float v) {
  constexpr float kLeast = 1e-15f, kMost = 1e15f;
  return v == 0 || (std::abs(v) >= kLeast && std::abs(v) <= kMost);
}

bool is_plausible(std::string_view bytes, const StlLayout& layout) {
  constexpr std::uint64_t kTriangles = 64;
  const char* p = bytes.data() + kBegin;
  for (std::uint64_t i = 0; i < std::min(layout.triangles, kTriangles); ++i) {
    for (std::size_t at = kNormal; at < kAttribute; at += 4)
      if (!is_plausible(number_at(p + at, layout.big_endian)))
        return false;
    p += kTriangle + (layout.has_lengths ? attribute_at(p) : 0);
  }
  return true;
}

}  // namespace

std::uint64_t promised_stl_triangles(std::string_view bytes) {
  return bytes.size() < kBegin ? 0 : word_at(bytes.data() + kBegin - 4, false);
}

std::uint64_t most_stl_triangles(std::string_view bytes) {
  return body(bytes) / kTriangle;
}

bool has_plausible_triangle(std::string_view bytes) {
  if (bytes.size() < kBegin + kTriangle || !is_plausible(bytes, plain(1)))
    return false;
  const std::string_view corners = bytes.substr(kBegin + kNormal, kAttribute - kNormal);
  return corners.find_first_not_of('\0') != corners.npos;
}

std::optional<StlLayout> exact_stl_layout(std::string_view bytes) {
  if (bytes.size() < kBegin)
    return {};
  const auto count = std::uint32_t(promised_stl_triangles(bytes));
  if (body(bytes) == kTriangle * std::uint64_t{count})
    return plain(count);
  if (body(bytes) == kTriangle * std::uint64_t{reversed(count)})
    return plain(reversed(count), true);
  const bool unknown = count == 0 || count == kUnknown;
  if (unknown && !has_plausible_triangle(bytes))
    return {};
  const StlLayout lengths = with_lengths(bytes, unknown ? kUnknown : count);
  if (lengths.end == bytes.size() && (unknown || lengths.triangles == count) &&
      is_plausible(bytes, lengths))
    return lengths;
  if (unknown && body(bytes) % kTriangle == 0)
    return plain(most_stl_triangles(bytes));
  return {};
}

std::optional<StlLayout> loose_stl_layout(std::string_view bytes) {
  if (bytes.size() < kBegin)
    return {};
  const std::uint64_t count = promised_stl_triangles(bytes), most = most_stl_triangles(bytes);
  const bool unknown = count == 0 || count == kUnknown;
  if (unknown && !has_plausible_triangle(bytes))
    return plain(0);
  const StlLayout lengths = with_lengths(bytes, unknown ? kUnknown : count);
  const bool all = unknown || lengths.triangles == count;
  if (all && bytes.size() - lengths.end < kTriangle && is_plausible(bytes, lengths))
    return lengths;
  if (count > most && !unknown)
    return {};
  return plain(unknown ? most : count);
}

void read_stl_binary(std::string_view bytes,
                     const StlLayout& layout,
                     ParseProgress& progress,
                     const Frame& frame,
                     Mesh& mesh) {
  for (std::vector<float>* const of : {&mesh.x, &mesh.y, &mesh.z})
    of->reserve(3 * layout.triangles);
  const char* p = bytes.data() + kBegin;
  for (std::uint64_t i = 0; i < layout.triangles; ++i) {
    for (std::size_t at = kNormal; at < kAttribute; at += 12) {
      const auto number = [&](std::size_t axis) {
        return double{number_at(p + at + 4 * axis, layout.big_endian)};
      };
      mesh.add_vertex(frame.inside({number(0), number(1), number(2)}));
    }
    p += kTriangle + (layout.has_lengths ? attribute_at(p) : 0);
    progress.at(p);
  }
}

}  // namespace grelha
