#include "frontend/files/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace grelha {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_blank(char c) {
  return static_cast<unsigned char>(c) <= ' ';
}
bool ends_line(char c) {
  return c == '\n' || c == '\r';
}

/// Decimal exponent of a well-formed number that no float can hold: its sign tells overflow from
/// underflow.
long decimal_exponent(std::string_view word) {
  // digits before the point, zeros before the first other digit
  long digits = 0, leading = 0, exponent = 0;
  bool point = false, started = false;
  std::size_t i = 0;
  for (; i < word.size() && word[i] != 'e' && word[i] != 'E'; ++i) {
    if (word[i] == '.')
      point = true;
    if (!is_digit(word[i]))
      continue;
    started = started || word[i] != '0';
    if (started && !point)
      ++digits;
    if (!started && point)
      ++leading;
  }
  if (i < word.size()) {
    std::string_view power = word.substr(i + 1);
    const bool negative = power.starts_with('-');
    if (power.starts_with('+'))
      power.remove_prefix(1);
    const auto read = std::from_chars(power.data(), power.data() + power.size(), exponent);
    if (read.ec != std::errc())
      exponent = negative ? -1000000000000L : 1000000000000L;
  }
  return exponent + (digits > 0 ? digits : -leading);
}

template <class Float>
bool parse(std::string_view word, Float& value) {
  const char *first = word.data(), *last = first + word.size();
  if (first != last && *first == '+') {
    if (++first != last && (*first == '-' || *first == '+'))
      return false;
  }
  const auto read = std::from_chars(first, last, value);
  if (read.ptr != last || read.ec == std::errc::invalid_argument)
    return false;
  if (read.ec == std::errc::result_out_of_range) {
    value = decimal_exponent(word) > 0 ? std::numeric_limits<Float>::infinity() : Float(0);
    if (*first == '-')
      value = -value;
  }
  return true;
}

}  // namespace

bool to_number(std::string_view word, float& value) {
  return parse(word, value);
}
bool to_number(std::string_view word, double& value) {
  return parse(word, value);
}

bool to_integer(std::string_view word, std::int64_t& value) {
  const char *first = word.data(), *last = first + word.size();
  const auto read = std::from_chars(first, last, value);
  if (read.ec == std::errc() && read.ptr == last)
    return true;
  double number = 0;
  if (!to_number(word, number) || !std::isfinite(number) || number != std::floor(number))
    return false;
  constexpr double kWhole = 0x1p53;  // every double from here on is whole, and none the one written
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  value = std::abs(number) <= kWhole ? std::int64_t(number) : number > 0 ? kMost : -kMost;
  return true;
}

bool looks_like_number(std::string_view word) {
  std::size_t i = 0;
  if (i < word.size() && (word[i] == '+' || word[i] == '-'))
    ++i;
  if (i < word.size() && word[i] == '.')
    ++i;
  if (i < word.size() && is_digit(word[i]))
    return true;
  float ignored;
  return to_number(word, ignored);
}

constexpr std::size_t kLongestShown = 40;

constexpr auto is_unprintable = [](char c) { return c < ' ' || c > '~'; };

std::string printable(std::string_view word) {
  std::string shown(word.substr(0, kLongestShown));
  std::ranges::replace_if(shown, is_unprintable, '?');
  return word.size() > kLongestShown ? shown + "..." : shown;
}

std::string quoted(std::string_view word) {
  return word.empty() ? "end of file" : '"' + printable(word) + '"';
}

Words::Words(std::string file, std::string_view text, std::size_t begin, char comment)
    : file_(std::move(file)),
      begin_(text.data()),
      end_(text.data() + text.size()),
      at_(text.data() + begin),
      comment_(comment),
      known_(text.data()) {}

const char* Words::skip_blanks(const char* p, bool stay_on_line, bool& line_ended) const {
  for (; p != end_; ++p) {
    if (*p == comment_ && comment_ != '\0') {
      p = std::find_if(p, end_, ends_line);
      if (p == end_)
        break;
    }
    if (!is_blank(*p))
      break;
    if (!ends_line(*p))
      continue;
    if (stay_on_line)
      break;
    line_ended = true;
  }
  return p;
}

const char* Words::word_end(const char* p) const {
  while (p != end_ && !is_blank(*p) && (*p != comment_ || comment_ == '\0'))
    ++p;
  return p;
}

std::string_view Words::next() {
  fresh_line_ = at_ == begin_;
  const char* first = skip_blanks(at_, false, fresh_line_);
  at_ = word_end(first);
  return {first, std::size_t(at_ - first)};
}

std::string_view Words::peek() const {
  bool ignored = false;
  const char* first = skip_blanks(at_, false, ignored);
  return {first, std::size_t(word_end(first) - first)};
}

std::string_view Words::peek_on_line() const {
  bool ignored = false;
  const char* first = skip_blanks(at_, true, ignored);
  return {first, std::size_t(word_end(first) - first)};
}

void Words::skip_line() {
  at_ = std::find_if(at_, end_, ends_line);
}

std::string_view Words::rest_of_line() {
  const char* last = std::find_if(at_, end_, ends_line);
  const char* stop = comment_ == '\0' ? last : std::find(at_, last, comment_);
  const char* first = at_;
  while (first != stop && is_blank(*first))
    ++first;
  while (stop != first && is_blank(stop[-1]))
    --stop;
  at_ = last;
  return {first, std::size_t(stop - first)};
}

Position Words::position(std::string_view word) const {
  const char* at = word.data();
  if (at < known_) {
    known_ = begin_;
    known_line_ = 1;
  }
  for (const char* p = known_; p < at; ++p) {
    if (!ends_line(*p))
      continue;
    if (*p == '\r' && p + 1 != end_ && p[1] == '\n') {
      if (p + 1 == at)
        break;  // the word "ends" between the two bytes of one line end
      ++p;
    }
    known_ = p + 1;
    ++known_line_;
  }
  return {file_, known_line_, std::uint64_t(at - known_) + 1, std::uint64_t(at - begin_)};
}

}  // namespace grelha
