#include "frontend/ply/stl_reader.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/ply/stl_binary.hpp"
#include "frontend/ply/stl_text.hpp"

namespace grelha {
namespace {

constexpr std::size_t kHeader = 80, kFirstTriangle = 54;  // bytes, with the count before it

/// Bytes that no text has, in no encoding that is read.
bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < ' ' && !(byte >= '\t' && byte <= '\r') && byte != 0x1A;  // DOS ends a text by that
}

/// What follows a header of 80 bytes shows control characters where it is binary: the first byte or
/// the last of a count, and numbers. Text may have some by accident, but then its vertices tell.
bool is_text(std::string_view bytes) {
  const std::string_view shown =
      bytes.size() > kHeader + 4 ? bytes.substr(kHeader, kFirstTriangle) : bytes;
  return std::ranges::none_of(shown, is_control) || has_stl_vertex(bytes);
}

/// Bytes that are no text, of which text holds few even where it is damaged.
bool is_far_from_text(std::string_view bytes) {
  constexpr std::ptrdiff_t kLeast = 10;
  const auto other = [](char c) { return is_control(c) || static_cast<signed char>(c) < 0; };
  return bytes.size() >= kHeader + kFirstTriangle &&
         std::ranges::count_if(bytes.substr(kHeader, kFirstTriangle), other) >= kLeast;
}

/// Joins corners with the same coordinates, which are all that tells which triangles touch.
void join_corners(Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.x.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t i) {
    const auto bits = [](float c) { return std::bit_cast<std::uint32_t>(c == 0 ? 0.f : c); };
    return std::tuple(bits(mesh.x[i]), bits(mesh.y[i]), bits(mesh.z[i]));
  };
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(place(a), a) < std::tuple(place(b), b);
  });
  mesh.indices.resize(order.size());  // first the first corner at each place
  for (std::size_t k = 0; k < order.size(); ++k)
    mesh.indices[order[k]] =
        k > 0 && place(order[k]) == place(order[k - 1]) ? mesh.indices[order[k - 1]] : order[k];
  std::uint32_t vertices = 0;
  for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) {
    std::uint32_t& at = mesh.indices[i];
    if (at != i) {
      at = mesh.indices[at];
      continue;
    }
    mesh.x[vertices] = mesh.x[i];
    mesh.y[vertices] = mesh.y[i];
    mesh.z[vertices] = mesh.z[i];
    at = vertices++;
  }
  for (std::vector<float>* const of : {&mesh.x, &mesh.y, &mesh.z})
    of->resize(vertices);
}

[[noreturn]] void refuse_binary(const std::string& path, std::string_view bytes) {
  refuse_other_format(path, "STL", bytes);
  const std::uint64_t promised = promised_stl_triangles(bytes), whole = most_stl_triangles(bytes);
  const std::string held = std::to_string(bytes.size()) + " bytes";
  if (bytes.size() < kHeader + 4)
    throw ParseError(Position{path, 0, 0, bytes.size()},
                     "\"solid\" in text, or 84 bytes before the first triangle",
                     held);
  throw ParseError(Position{path, 0, 0, bytes.size()},
                   std::to_string(promised) + (promised == 1 ? " triangle" : " triangles"),
                   std::to_string(whole) + " in " + held + ", and then the end of the file");
}

/// Of a file whose size is not that of its triangles.
StlLayout loose_layout(const std::string& path, std::string_view bytes, const Warn& warn) {
  const auto found = loose_stl_layout(bytes);
  if (!found)
    refuse_binary(path, bytes);
  if (const std::uint64_t more = bytes.size() - found->end; more >= kFirstTriangle && warn)
    warn(path + ": warning: " + std::to_string(more) + " bytes follow the last of " +
         std::to_string(found->triangles) + " triangles; they are skipped");
  return *found;
}

}  // namespace

bool is_stl(std::string_view bytes) {
  const auto layout = exact_stl_layout(bytes);
  if (layout && layout->triangles > 0)
    return true;
  return (is_far_from_text(bytes) && has_plausible_triangle(bytes)) || begins_stl_text(bytes);
}

Mesh read_stl_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame) {
  Mesh mesh;
  ParseProgress parsed(progress, bytes.data());
  const auto exact = exact_stl_layout(bytes);
  if (!exact && is_text(bytes))
    StlText(path, bytes, warn, parsed, frame, mesh).read();
  else
    read_stl_binary(bytes, exact ? *exact : loose_layout(path, bytes, warn), parsed, frame, mesh);
  join_corners(mesh);
  return mesh;
}

}  // namespace grelha
