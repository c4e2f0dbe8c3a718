#include "frontend/ply/stl_text.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "frontend/files/other_formats.hpp"

namespace grelha {
namespace {

/// No keyword has more letters; a string of so many needs no memory.
std::string lower(std::string_view word) {
  constexpr std::size_t kLongest = 15;
  return in_small_letters(word.substr(0, kLongest));
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

}  // namespace

bool has_stl_vertex(std::string_view text) {
  constexpr std::size_t kLook = std::size_t(1) << 16;
  Words words("", text.substr(0, kLook), 0, Comments::kNone);
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    if (word.size() == std::strlen("vertex") && lower(word) == "vertex") {
      double ignored = 0;
      if (parse_coordinate(words.peek(), ignored))
        return true;
    }
  return false;
}

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
  return found == std::end(kNames) ? Keyword::kNone : found->second;
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

/// Skips the name of a solid, which may be any text, up to the first facet on its line.
void StlText::skip_name() {
  for (std::string_view word = words_.peek_on_line(); !word.empty(); word = words_.peek_on_line()) {
    if (keyword_of(word) == Keyword::kFacet && content_begins())
      return;
    words_.next();
  }
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
  ended_ = keyword == Keyword::kEndSolid || (ended_ && keyword == Keyword::kNone);
  switch (keyword) {
    case Keyword::kNone:
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
      return expect_no_loop(word), skip_name();
    case Keyword::kEndSolid:
      return expect_no_loop(word), skip_name();
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
    if (keyword == Keyword::kNone && lower(word) == "end") {
      const std::string joined = "end" + lower(words_.peek_on_line());
      keyword = keyword_of(joined);
      if (keyword != Keyword::kNone)
        words_.next();
    }
    take(keyword, word);
    progress_.at(words_.cursor());
  }
  finish();
}

}  // namespace grelha
