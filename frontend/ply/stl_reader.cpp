#include "frontend/ply/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "frontend/files/load_progress.hpp"
#include "frontend/files/other_formats.hpp"
#include "frontend/files/text.hpp"
#include "frontend/ply/stl_colors.hpp"
#include "frontend/scene/mesh.hpp"
#include "frontend/scene/scene_file.hpp"

namespace grelha {
namespace {

/// How the triangles lie in a binary STL file.
struct StlLayout {
  std::uint64_t triangles = 0;
  bool big_endian = false;
  bool has_lengths = false;  ///< the attribute of a triangle counts the bytes that follow it
  std::uint64_t end = 0;     ///< bytes before the end of the last triangle
};

/// Reads STL in text: `solid`, `facet`, `outer loop`, `vertex x y z`, and the ends of these, in
/// letters of any case. Each corner becomes a vertex. Loops of more than three vertices are
/// polygons.
class StlText {
 public:
  StlText(const std::string& path,
          std::string_view bytes,
          const Warn& warn,
          ParseProgress& progress,
          const Frame& frame,
          Mesh& mesh);
  void read();

 private:
  /// Words of one meaning are one: `end loop`, `ENDLOOP`. kUnknown: of no meaning.
  enum class Keyword {
    kUnknown,
    kSolid,
    kFacet,
    kOuter,
    kVertex,
    kColor,
    kEndLoop,
    kEndFacet,
    kEndSolid
  };

  Keyword keyword_of(std::string_view word) const;
  void take(Keyword keyword, std::string_view word);
  void take_unknown(std::string_view word);
  void skip_comment(std::string_view word);
  void skip_rest();
  std::string_view take_name(bool behind_end);
  void begin_solid(std::string_view name);
  bool content_begins() const;
  double coordinate();
  void read_vertex();
  void end_loop(std::string_view word);
  void expect_no_loop(std::string_view word) const;
  void finish();

  std::string_view bytes_;
  Words words_;
  const Warn& warn_;
  ParseProgress& progress_;
  const Frame& frame_;
  Mesh& mesh_;
  std::size_t loop_ = 0;  ///< the first vertex of the loop
  bool in_loop_ = false, in_solid_ = false, ended_ = false;
  std::string_view skipped_;  ///< the first word of no meaning
  std::string_view name_;     ///< of the solid that begins with the next facet,
  bool begun_ = true;         ///< if one does
};

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

/// The number of triangles that the header says, and what follows it holds at most.
std::uint64_t promised_stl_triangles(std::string_view bytes) {
  return bytes.size() < kBegin ? 0 : word_at(bytes.data() + kBegin - 4, false);
}

std::uint64_t most_stl_triangles(std::string_view bytes) {
  return body(bytes) / kTriangle;
}

/// Returns whether the first triangle has coordinates as meshes have them, not all of them 0.
bool has_plausible_triangle(std::string_view bytes) {
  if (bytes.size() < kBegin + kTriangle || !is_plausible(bytes, plain(1)))
    return false;
  const std::string_view corners = bytes.substr(kBegin + kNormal, kAttribute - kNormal);
  return corners.find_first_not_of('\0') != corners.npos;
}

/// Finds the layout by which a header of 80 bytes, a count and its triangles make up the whole
/// file. Counts of 0 and 2^32 - 1 are those of programs that do not know it when they begin: then
/// the size tells.
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

/// Finds the layout of a file with more bytes than its triangles take. None where the file is
/// shorter than its count says.
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

/// Appends three vertices for each triangle. Returns their attributes where these are no lengths.
std::vector<std::uint16_t> read_stl_binary(std::string_view bytes,
                                           const StlLayout& layout,
                                           ParseProgress& progress,
                                           const Frame& frame,
                                           Mesh& mesh) {
  std::vector<std::uint16_t> attributes;
  if (!layout.has_lengths)
    attributes.reserve(layout.triangles);
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
    const std::size_t attribute = attribute_at(p);
    if (!layout.has_lengths)
      attributes.push_back(static_cast<std::uint16_t>(
          layout.big_endian ? attribute >> 8 | attribute << 8 : attribute));
    p += kTriangle + (layout.has_lengths ? attribute : 0);
    progress.at(p);
  }
  return attributes;
}

/// No keyword has more letters; a string of so many needs no memory.
std::string lower(std::string_view word) {
  constexpr std::size_t kMaxSquaredLength = 15;
  return in_small_letters(word.substr(0, kMaxSquaredLength));
}

bool begins_comment(std::string_view word) {
  return word.starts_with('#') || word.starts_with("//") || word.starts_with("/*") ||
         word.starts_with(';') || word.starts_with('%') || word.starts_with('!');
}

/// A number as to_number() reads it, or with an exponent of Fortran (1.D0), a comma for the point,
/// or a comma or a comment behind it.
bool parse_coordinate(std::string_view word, double& value) {
  if (to_number(word, value))
    return true;
  std::string plain(word.substr(0, std::min(word.find('#'), word.find("//"))));
  if (plain.size() > 1 && (plain.back() == ',' || plain.back() == ';'))
    plain.pop_back();
  const bool has_digit = std::ranges::any_of(plain, [](char c) { return c >= '0' && c <= '9'; });
  const bool has_point = plain.find('.') != plain.npos;
  for (char& c : plain) {
    if (c == 'D' || c == 'd')
      c = 'e';
    if (c == ',' && !has_point)
      c = '.';
  }
  return has_digit && to_number(plain, value);
}

/// Returns whether the word `vertex` stands in the text, before a number.
bool has_stl_vertex(std::string_view text) {
  constexpr std::size_t kFirstBytes = std::size_t(1) << 16;
  Words words("", text.substr(0, kFirstBytes), 0, Comments::kNone);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    if (word.size() == std::strlen("vertex") && lower(word) == "vertex") {
      double ignored = 0;
      if (parse_coordinate(words.peek(), ignored))
        return true;
    }
  return false;
}

/// Returns whether the text begins with a solid, or a facet, and has a vertex.
bool begins_stl_text(std::string_view text) {
  Words words("", text, byte_order_mark(text), Comments::kNone);
  std::string_view word = words.next();
  for (; begins_comment(word); word = words.next())
    words.skip_line();
  const std::string first = lower(word);
  return (first == "solid" || first == "facet") && has_stl_vertex(text);
}

StlText::StlText(const std::string& path,
                 std::string_view bytes,
                 const Warn& warn,
                 ParseProgress& progress,
                 const Frame& frame,
                 Mesh& mesh)
    : bytes_(bytes),
      words_(path, bytes, byte_order_mark(bytes), Comments::kNone),
      warn_(warn),
      progress_(progress),
      frame_(frame),
      mesh_(mesh) {}

StlText::Keyword StlText::keyword_of(std::string_view word) const {
  static constexpr std::pair<std::string_view, Keyword> kNames[] = {
      {"vertex", Keyword::kVertex},
      {"facet", Keyword::kFacet},
      {"outer", Keyword::kOuter},
      {"loop", Keyword::kOuter},
      {"endloop", Keyword::kEndLoop},
      {"endfacet", Keyword::kEndFacet},
      {"endsolid", Keyword::kEndSolid},
      {"solid", Keyword::kSolid},
      {"color", Keyword::kColor},
      {"colour", Keyword::kColor},
  };
  const std::string name = lower(word);
  const auto found = std::ranges::find(kNames, name, [](const auto& n) { return n.first; });
  return found == std::end(kNames) ? Keyword::kUnknown : found->second;
}

/// Returns whether the next word on the line is a keyword with what belongs to it, not a word of
/// a name or a remark: some files are one line.
bool StlText::content_begins() const {
  const std::string_view word = words_.peek_on_line();
  const Keyword keyword = keyword_of(word);
  if (keyword == Keyword::kEndLoop || keyword == Keyword::kEndFacet ||
      keyword == Keyword::kEndSolid)
    return true;
  const std::string name = lower(word);
  if (name != "vertex" && name != "facet" && name != "outer" && name != "end")
    return false;
  Words ahead = words_;
  ahead.next();
  const std::string second = lower(ahead.peek_on_line());
  if (name == "vertex")
    return looks_like_number(ahead.peek_on_line());
  if (name == "outer")
    return second == "loop";
  if (name == "end")
    return second == "loop" || second == "facet" || second == "solid";
  ahead.next();
  return second == "outer" || (second == "normal" && looks_like_number(ahead.peek_on_line()));
}

/// Skips what stands behind words of a line, a comment with it.
void StlText::skip_rest() {
  for (std::string_view word = words_.peek_on_line(); !word.empty() && !content_begins();
       word = words_.peek_on_line()) {
    words_.next();
    if (begins_comment(word))
      return skip_comment(word);
  }
}

/// Takes the name of a solid, which may be any text, up to the first facet on its line, its end, or
/// the next solid behind `endsolid`.
std::string_view StlText::take_name(bool behind_end) {
  std::string_view name;
  for (std::string_view word = words_.peek_on_line(); !word.empty(); word = words_.peek_on_line()) {
    const Keyword keyword = keyword_of(word);
    if ((keyword == Keyword::kFacet && content_begins()) || keyword == Keyword::kEndSolid ||
        (behind_end && keyword == Keyword::kSolid))
      break;
    words_.next();
    const char* const begin = name.empty() ? word.data() : name.data();
    name = {begin, std::size_t(word.data() + word.size() - begin)};
  }
  return name.substr(0, name.find('\0'));
}

/// What follows is a solid of its own.
void StlText::begin_solid(std::string_view name) {
  name_ = name;
  begun_ = true;
}

void StlText::skip_comment(std::string_view word) {
  if (!word.starts_with("/*"))
    return words_.skip_line();
  for (std::string_view w = word; !w.empty(); w = words_.next())
    if (w.ends_with("*/") && (w.data() != word.data() || w.size() > 3))
      return;
  throw ParseError(words_.position(word), "\"*/\" behind \"/*\"", "end of file");
}

double StlText::coordinate() {
  const std::string_view word = words_.next();
  double value = 0, ignored = 0;
  if (!parse_coordinate(word, value))
    throw ParseError(words_.position(word), "a number of the vertex", quoted(word));
  const std::size_t comment = std::min(word.find('#'), word.find("//"));
  if (comment < word.size() && !to_number(word, ignored))
    words_.go_on_at(word.data() + comment);
  return value;
}

void StlText::read_vertex() {
  std::array<double, 3> p{};
  for (double& of_axis : p)
    of_axis = coordinate();
  mesh_.add_vertex(frame_.inside(p));
  if (!words_.peek_on_line().empty())
    skip_rest();
}

void StlText::end_loop(std::string_view word) {
  std::size_t end = mesh_.vertex_count();
  const auto is_first = [&](std::size_t v) {
    return mesh_.x[v] == mesh_.x[loop_] && mesh_.y[v] == mesh_.y[loop_] &&
           mesh_.z[v] == mesh_.z[loop_];
  };
  if (end > loop_ + 3 && is_first(end - 1)) {  // some programs come back to it
    --end;
    for (std::vector<float>* const of : {&mesh_.x, &mesh_.y, &mesh_.z})
      of->pop_back();
  }
  if (end < loop_ + 3)
    throw ParseError(words_.position(word), "three vertices before \"endloop\"", quoted(word));
  for (std::size_t v = loop_; v < end; ++v)
    mesh_.indices.push_back(std::uint32_t(v));
  mesh_.close_face(std::uint32_t(end - loop_));
  if (std::exchange(begun_, false))
    mesh_.solids.push_back({std::string(name_)});
  ++mesh_.solids.back().faces;
  mesh_.solids.back().corners += end - loop_;
  loop_ = end;
  in_loop_ = false;
}

void StlText::expect_no_loop(std::string_view word) const {
  if (in_loop_ || mesh_.vertex_count() > loop_)
    throw ParseError(words_.position(word), "\"endloop\" behind three vertices", quoted(word));
}

void StlText::take_unknown(std::string_view word) {
  if (begins_comment(word))
    return skip_comment(word);
  if (in_loop_ || mesh_.vertex_count() > loop_)
    throw ParseError(words_.position(word), "\"vertex\" or \"endloop\"", quoted(word));
  if (in_solid_ && looks_like_number(word))
    return;  // a normal on lines of its own
  if (skipped_.empty() && !ended_)
    skipped_ = word;
  words_.skip_line();
}

void StlText::take(Keyword keyword, std::string_view word) {
  ended_ = keyword == Keyword::kEndSolid || (ended_ && keyword == Keyword::kUnknown);
  switch (keyword) {
    case Keyword::kUnknown:
      return take_unknown(word);
    case Keyword::kVertex:
      return read_vertex();
    case Keyword::kOuter:
      expect_no_loop(word);
      in_loop_ = true;
      if (keyword_of(words_.peek_on_line()) == Keyword::kOuter)
        words_.next();
      return skip_rest();
    case Keyword::kEndLoop:
      end_loop(word);
      return skip_rest();
    case Keyword::kEndFacet:
      if (mesh_.vertex_count() > loop_)
        end_loop(word);  // whose own end is missing
      return expect_no_loop(word), skip_rest();
    case Keyword::kFacet:
      in_solid_ = true;
      return expect_no_loop(word), skip_rest();
    case Keyword::kColor:
      return words_.skip_line();
    case Keyword::kSolid:
      in_solid_ = true;
      return expect_no_loop(word), begin_solid(take_name(false));
    case Keyword::kEndSolid:
      take_name(true);
      return expect_no_loop(word), begin_solid({});
  }
}

void StlText::finish() {
  const std::string_view end = words_.next();
  expect_no_loop(end);
  if (mesh_.face_count() == 0 && !skipped_.empty()) {
    refuse_other_format(words_.file(), "STL", bytes_);
    throw ParseError(
        words_.position(skipped_), "\"solid\", \"facet\" or another word of STL", quoted(skipped_));
  }
  if (mesh_.face_count() == 0 && !ended_)
    throw ParseError(words_.position(end), "a facet, or \"endsolid\"", quoted(end));
  if (!skipped_.empty() && warn_)
    warn_(words_.position(skipped_).text() + ": warning: no line of an STL file begins with " +
          quoted(skipped_) + "; such lines are skipped");
  if (!ended_ && warn_)
    warn_(words_.file() + ": warning: the file ends without \"endsolid\"");
}

void StlText::read() {
  for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
    Keyword keyword = keyword_of(word);
    if (keyword == Keyword::kUnknown && lower(word) == "end") {
      const std::string joined = "end" + lower(words_.peek_on_line());
      keyword = keyword_of(joined);
      if (keyword != Keyword::kUnknown)
        words_.next();
    }
    take(keyword, word);
    progress_.at(words_.cursor());
  }
  finish();
}

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

/// Joins corners of a solid with the same coordinates, which are all that tells which triangles
/// touch.
void join_corners(Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.x.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto place = [&](std::uint32_t i) {
    const auto bits = [](float c) { return std::bit_cast<std::uint32_t>(c == 0 ? 0.f : c); };
    return std::tuple(bits(mesh.x[i]), bits(mesh.y[i]), bits(mesh.z[i]));
  };
  std::vector<std::size_t> ends;  // of the corners of each solid
  for (const Solid& solid : mesh.solids)
    ends.push_back((ends.empty() ? 0 : ends.back()) + solid.corners);
  if (ends.empty())
    ends.push_back(order.size());
  mesh.indices.resize(order.size());  // first the first corner at each place
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    const std::span corners(order.data() + begin, end - begin);
    std::ranges::sort(corners, [&](std::uint32_t a, std::uint32_t b) {
      return std::tuple(place(a), a) < std::tuple(place(b), b);
    });
    for (std::size_t k = 0; k < corners.size(); ++k)
      mesh.indices[corners[k]] = k > 0 && place(corners[k]) == place(corners[k - 1])
                                     ? mesh.indices[corners[k - 1]]
                                     : corners[k];
    begin = end;
  }
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
                   const Frame& frame,
                   bool with_colors) {
  Mesh mesh;
  ParseProgress parsed(progress, bytes.data());
  const auto exact = exact_stl_layout(bytes);
  if (!exact && is_text(bytes)) {
    StlText(path, bytes, warn, parsed, frame, mesh).read();
    join_corners(mesh);
    return mesh;
  }
  const StlLayout layout = exact ? *exact : loose_layout(path, bytes, warn);
  const auto attributes = read_stl_binary(bytes, layout, parsed, frame, mesh);
  join_corners(mesh);
  if (with_colors)
    color_stl_faces(bytes.substr(0, kHeader), attributes, mesh);
  return mesh;
}

}  // namespace grelha
