#include "frontend/ply/stl_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <tuple>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/text.hpp"

namespace grelha {
namespace {

constexpr std::size_t kHeader = 80;  // bytes, and four for the number of triangles
constexpr std::size_t kTriangle = 50;

std::uint32_t word_at(const char* p) {
  std::uint32_t word = 0;
  std::memcpy(&word, p, sizeof word);
  if constexpr (std::endian::native == std::endian::big)
    word = word << 24 | (word & 0xFF00) << 8 | (word >> 8 & 0xFF00) | word >> 24;
  return word;
}

/// The bytes of a binary file of as many triangles as this one says it has.
std::uint64_t binary_size(std::string_view bytes) {
  return bytes.size() < kHeader + 4
             ? kHeader + 4
             : kHeader + 4 + kTriangle * std::uint64_t{word_at(bytes.data() + kHeader)};
}

void add_corner(Mesh& mesh, const Float3& p) {
  mesh.x.push_back(p.x);
  mesh.y.push_back(p.y);
  mesh.z.push_back(p.z);
}

void read_binary(const std::string& path,
                 std::string_view bytes,
                 ParseProgress& progress,
                 const Frame& frame,
                 Mesh& mesh) {
  if (bytes.size() < binary_size(bytes))
    throw ParseError(
        Position{path, 0, 0, bytes.size()},
        "\"solid\" in text, or " + std::to_string(binary_size(bytes)) + " bytes of triangles",
        "end of file");
  const char* const end = bytes.data() + binary_size(bytes);
  for (const char* p = bytes.data() + kHeader + 4; p < end; p += kTriangle) {
    for (int corner = 0; corner < 3; ++corner) {
      const auto number = [&](int axis) {
        return double{std::bit_cast<float>(word_at(p + 12 + 12 * corner + 4 * axis))};
      };
      add_corner(mesh, frame.inside({number(0), number(1), number(2)}));
    }
    progress.at(p);
  }
}

std::string lower(std::string_view word) {
  std::string small(word.substr(0, 16));
  std::ranges::transform(
      small, small.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return small;
}

Float3 read_vertex(Words& words, const Frame& frame) {
  std::array<double, 3> p{};
  for (double& coordinate : p) {
    const std::string_view word = words.next();
    if (!to_number(word, coordinate))
      throw ParseError(words.position(word), "a number of the vertex", quoted(word));
  }
  return frame.inside(p);
}

/// Lines `solid`, `facet`, `outer loop`, `vertex x y z`, and the ends of these. Returns whether the
/// last of them is the end of a solid.
bool read_text(Words& words, ParseProgress& progress, const Frame& frame, Mesh& mesh) {
  bool ended = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const std::string name = lower(word);
    ended = name == "endsolid";
    if (name == "vertex") {
      add_corner(mesh, read_vertex(words, frame));
    } else if (name == "endloop") {
      if (mesh.x.size() % 3 != 0 || mesh.x.size() == mesh.indices.size())
        throw ParseError(words.position(word), "three vertices before \"endloop\"", quoted(word));
      mesh.indices.resize(mesh.x.size());
    } else if (ended || name == "solid" || name == "facet" || name == "outer") {
      words.skip_line();  // with a name, or a normal that follows from the vertices
    } else if (name != "endfacet") {
      throw ParseError(words.position(word), "\"facet\", \"vertex\" or \"endsolid\"", quoted(word));
    }
    progress.at(words.cursor());
  }
  if (mesh.x.size() != mesh.indices.size())
    throw ParseError(words.position({}), "\"endloop\" behind three vertices", "end of file");
  return ended;
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

}  // namespace

Mesh read_stl_mesh(const std::string& path,
                   std::string_view bytes,
                   const Warn& warn,
                   LoadProgress* progress,
                   const Frame& frame) {
  Mesh mesh;
  ParseProgress parsed(progress, bytes.data());
  const std::size_t mark = byte_order_mark(bytes);
  // many binary files begin with the word as well
  if (lower(bytes.substr(mark, 5)) == "solid" && bytes.size() != binary_size(bytes)) {
    Words words(path, bytes, mark, Comments::kNone);
    if (!read_text(words, parsed, frame, mesh) && warn)
      warn(path + ": warning: the file ends without \"endsolid\"");
  } else {
    read_binary(path, bytes, parsed, frame, mesh);
  }
  join_corners(mesh);
  return mesh;
}

}  // namespace grelha
