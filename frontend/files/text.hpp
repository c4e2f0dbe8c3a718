#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "frontend/files/parse_error.hpp"

namespace grelha {

/// A whole word as a number: decimal, with or without sign and exponent, inf or nan, also as
/// Microsoft's C library wrote these (1.#INF, -1.#IND00, 1.#QNAN). Too large becomes infinite, too
/// small zero. False when the word is anything else ("1.5.2", "0x10", "").
bool to_number(std::string_view word, float& value);
bool to_number(std::string_view word, double& value);
/// A whole word as an integer; numbers such as "3.0" or "+3" count. A number that is too large
/// becomes the largest int64, so that the caller's message names its own limit.
bool to_integer(std::string_view word, std::int64_t& value);

/// Returns true if a word is meant as a number, well formed or not: a digit follows its sign and
/// point, or to_number() accepts it.
bool looks_like_number(std::string_view word);

/// Bytes of the mark that some editors put before UTF-8: 3, or 0 when the text has none.
std::size_t byte_order_mark(std::string_view text);

/// The word with ASCII's capital letters made small.
std::string in_small_letters(std::string_view word);

/// Shortens a word, and replaces unprintable bytes.
std::string printable(std::string_view word);

/// A word as it stands in a message: quoted, shortened, nothing unprintable; "end of file" for the
/// empty word.
std::string quoted(std::string_view word);

/// The comments that Words steps over: none, or `#` and `//` to the end of their line and `/*` to
/// `*/`.
enum class Comments : std::uint8_t { kNone, kAll };

/// Text in memory as words between spaces. Every byte up to ' ' is a space; LF, CRLF and lone CR
/// end lines. Words are views into the text, so that their position can be asked later and costs
/// nothing until then.
class Words {
 public:
  /// `text` must outlive this. Reading starts at byte `begin`. A comment begins wherever it stands,
  /// also behind a word; a `/*` that nothing closes is a word.
  Words(std::string file, std::string_view text, std::size_t begin, Comments comments);

  std::string_view next();  ///< next word on any line; empty at the end of the file
  /// Steps over the next word if it is a number, written as most are: `value`, as to_number() reads
  /// it. False, and nothing is stepped over, for other words, comments, the end.
  bool next_number(float& value);
  std::string_view peek() const;  ///< what next() would return, left in place
  /// empty when the line ends first; then data() is where it ends
  std::string_view peek_on_line() const;
  bool at_line_start() const {
    return at_line_start_;
    /// whether the last next() stepped over a line end, or was the first
  }
  void skip_line();  ///< to the end of this line; the next word is fresh
  /// Consumes the text up to a comment or the line end, and returns it trimmed. A quoted text
  /// extends to the next quote. In a name, `//` and `/*` begin a comment only behind a space.
  std::string_view tail_of_line();

  /// Continues reading at a position of the text that cursor() returned or would return.
  void go_on_at(const char* at) { at_ = at; }

  std::size_t bytes_left() const { return std::size_t(end_ - at_); }
  std::size_t size() const { return std::size_t(end_ - begin_); }
  const char* cursor() const { return at_; }
  const std::string& file() const { return file_; }

  /// The position of a word of this text. Cheap for calls in ascending order.
  Position position(std::string_view word) const;

 private:
  const char* skip_spaces(const char* p, bool stay_on_line, bool& line_ended) const;
  const char* word_end(const char* p) const;
  const char* past_comment(const char* p) const;
  const char* find_close(const char* from) const;
  const char* name_end(const char* first) const;

  std::string file_;
  const char *begin_, *end_, *at_;
  Comments comments_;
  bool at_line_start_ = true;
  mutable const char* known_;  ///< start of the line last counted to
  mutable std::uint64_t last_line_ = 1;
  /// the first "*/" (or the end) behind a position that was searched from
  mutable const char *searched_ = nullptr, *close_ = nullptr;
};

/// Makes text safe for a terminal that reads UTF-8. File names and words of scenes are untrusted: a
/// control character in them could move the cursor, set a title or hide text. Each becomes `?`.
/// Line ends stay.
std::string printable_text(std::string_view text);

/// The same for text that must stay on one line.
std::string printable_line(std::string_view text);

/// Letters to add, drop, change or swap with their neighbour to make `b` of `a` (each place edited
/// once).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The word that was probably meant by the one found: the first of the nearest, at most a third of
/// its letters away, or one that it begins; capitals are as small letters. Empty when there is
/// none.
std::string_view nearest(std::string_view word_found, std::span<const std::string_view> words);

/// `; did you mean WORD?`, or nothing.
std::string suggest(std::string_view found, std::span<const std::string_view> words);

}  // namespace grelha
