#include "frontend/files/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace grelha {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_space(char c) {
  return static_cast<unsigned char>(c) <= ' ';
}
bool ends_line(char c) {
  return c == '\n' || c == '\r';
}

/// The text that Microsoft's C library wrote behind `1.` for infinities and NaNs.
constexpr std::string_view kMsvcNames[] = {"#INF", "#IND", "#QNAN", "#SNAN"};
/// The same names cut to a few digits, and rounded as if the letters were digits.
constexpr std::string_view kRoundedNames[] = {
    "#IO", "#J", "#QNB", "#QO", "#R", "#SNB", "#SO", "#T"};

/// Returns the end of such a name, with the digits that fill its width and an exponent; or nullptr.
const char* past_name(const char* p, const char* end, std::span<const std::string_view> names) {
  const std::string_view text(p, std::size_t(end - p));
  const auto found =
      std::ranges::find_if(names, [text](std::string_view name) { return text.starts_with(name); });
  if (found == names.end())
    return nullptr;
  p = std::find_if_not(p + found->size(), end, is_digit);
  if (p != end && *p == 'e')
    p = std::find_if_not(p + 1, end, [](char c) { return is_digit(c) || c == '+' || c == '-'; });
  return p == end || is_space(*p) ? p : nullptr;
}

template <class Float>
bool parse_name(std::string_view word, Float& value) {
  const bool negative = word.starts_with('-');
  if (negative || word.starts_with('+'))
    word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  if (!word.starts_with("1."))
    return false;
  const char* const name = word.data() + 2;
  if (past_name(name, end, kMsvcNames) != end && past_name(name, end, kRoundedNames) != end)
    return false;
  using Limits = std::numeric_limits<Float>;
  const Float found = word.starts_with("1.#INF") ? Limits::infinity() : Limits::quiet_NaN();
  value = negative ? -found : found;
  return true;
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
    return parse_name(word, value);
  if (read.ec == std::errc::result_out_of_range) {
    value = Float(std::strtod(std::string(first, last).c_str(), nullptr));  // infinite or zero
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

std::size_t byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? kMark.size() : 0;
}

std::string in_small_letters(std::string_view word) {
  std::string small(word);
  for (char& c : small)
    c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
  return small;
}

constexpr std::size_t kLongestPrinted = 40;

constexpr auto is_not_ascii = [](char c) { return c < ' ' || c > '~'; };

std::string printable(std::string_view word) {
  std::string printed(word.substr(0, kLongestPrinted));
  std::ranges::replace_if(printed, is_not_ascii, '?');
  return word.size() > kLongestPrinted ? printed + "..." : printed;
}

std::string quoted(std::string_view word) {
  return word.empty() ? "end of file" : '"' + printable(word) + '"';
}

Words::Words(std::string file, std::string_view text, std::size_t begin, Comments comments)
    : file_(std::move(file)),
      begin_(text.data()),
      end_(text.data() + text.size()),
      at_(text.data() + begin),
      comments_(comments),
      known_(text.data()) {}

const char* Words::skip_spaces(const char* p, bool stay_on_line, bool& line_ended) const {
  while (p != end_) {
    const char* const past = is_space(*p) ? p + 1 : past_comment(p);
    if (past == p)
      break;
    if (std::any_of(p, past, ends_line)) {
      if (stay_on_line)
        break;
      line_ended = true;
    }
    p = past;
  }
  return p;
}

/// Returns the first "*/" from `from` on, or the end of the text. Calls in ascending order read the
/// text once.
const char* Words::find_close(const char* from) const {
  if (!searched_ || from < searched_ || from > close_) {
    const std::string_view rest(from, std::size_t(end_ - from));
    searched_ = from;
    close_ = from + std::min(rest.find("*/"), rest.size());
  }
  return close_;
}

/// Returns the end of the comment that begins at `p`, or `p` if none does.
const char* Words::past_comment(const char* p) const {
  if (comments_ == Comments::kNone || p == end_)
    return p;
  if (*p == '#') {
    const bool behind_one = p - begin_ >= 2 && p[-1] == '.' && p[-2] == '1';
    return behind_one && past_name(p, end_, kMsvcNames) ? p : std::find_if(p, end_, ends_line);
  }
  if (*p != '/' || p + 1 == end_)
    return p;
  if (p[1] == '/')
    return std::find_if(p, end_, ends_line);
  if (p[1] != '*')
    return p;
  const char* const close = find_close(p + 2);
  return close == end_ ? p : close + 2;
}

const char* Words::word_end(const char* p) const {
  while (p != end_ && !is_space(*p) && past_comment(p) == p)
    ++p;
  return p;
}

std::string_view Words::next() {
  at_line_start_ = at_ == begin_;
  const char* first = skip_spaces(at_, false, at_line_start_);
  at_ = word_end(first);
  return {first, std::size_t(at_ - first)};
}

bool Words::next_number(float& value) {
  const char* const first = std::find_if_not(at_, end_, is_space);
  float found;
  const auto read = std::from_chars(first, end_, found);
  const bool is_whole =
      read.ptr == end_ || is_space(*read.ptr) || past_comment(read.ptr) != read.ptr;
  if (read.ec != std::errc() || !is_whole)
    return false;
  value = found;
  at_ = read.ptr;
  return true;
}

std::string_view Words::peek() const {
  bool ignored = false;
  const char* first = skip_spaces(at_, false, ignored);
  return {first, std::size_t(word_end(first) - first)};
}

std::string_view Words::peek_on_line() const {
  bool ignored = false;
  const char* first = skip_spaces(at_, true, ignored);
  return {first, std::size_t(word_end(first) - first)};
}

void Words::skip_line() {
  while (at_ != end_ && !ends_line(*at_)) {
    const char* const past = past_comment(at_);
    at_ = past == at_ ? at_ + 1 : past;
  }
}

/// Returns the end of a name of several words, before a comment or the end of its line.
const char* Words::name_end(const char* first) const {
  const char *const line_end = std::find_if(first, end_, ends_line), *p = first;
  if (p != line_end && (*p == '"' || *p == '\''))
    if (const char* const quote = std::find(p + 1, line_end, *p); quote != line_end)
      p = quote + 1;
  for (; p != line_end; ++p) {
    const bool is_apart = p == first || is_space(p[-1]);
    if ((*p == '#' || is_apart) && past_comment(p) != p)
      break;
  }
  return p;
}

std::string_view Words::tail_of_line() {
  const auto is_gap = [](char c) { return is_space(c) && !ends_line(c); };
  const char* const first = std::find_if_not(at_, end_, is_gap);
  const char* stop = name_end(first);
  at_ = stop;
  skip_line();
  while (stop != first && is_space(stop[-1]))
    --stop;
  return {first, std::size_t(stop - first)};
}

Position Words::position(std::string_view word) const {
  const char* at = word.data();
  if (at < known_) {
    known_ = begin_;
    last_line_ = 1;
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
    ++last_line_;
  }
  return {file_, last_line_, std::uint64_t(at - known_) + 1, std::uint64_t(at - begin_)};
}

std::string printable_text(std::string_view text) {
  std::string clean;
  unsigned char before = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_wide = byte >= 0x80 && byte < 0xA0 && (before < 0x80 || before == 0xC2);
    const bool is_control = (byte < 0x20 && byte != '\n') || byte == 0x7F || is_wide;
    if (is_wide && before == 0xC2)
      clean.pop_back();
    clean += is_control ? '?' : c;
    before = byte;
  }
  return clean;
}

std::string printable_line(std::string_view text) {
  std::string line = printable_text(text);
  std::ranges::replace(line, '\n', '?');
  return line;
}

// Optimal string alignment: Wagner & Fischer's table by rows, with the row before the last one kept
// for swaps.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

namespace {

/// Returns the first word that begins with `found`, where that has letters enough to mean one.
std::string_view completed(std::string_view found, std::span<const std::string_view> words) {
  constexpr std::size_t kLetters = 3;
  const std::size_t begin = std::min(found.find_first_not_of('-'), found.size());
  if (found.size() - begin < kLetters)
    return {};
  const auto word = std::ranges::find_if(words, [&](auto w) { return w.starts_with(found); });
  return word == words.end() ? std::string_view() : *word;
}

}  // namespace

std::string_view nearest(std::string_view word_found, std::span<const std::string_view> words) {
  constexpr std::size_t kMaxSquaredLength = 64;  // longer words are noise, no typing errors
  if (word_found.size() > kMaxSquaredLength)
    return {};
  const std::string found = in_small_letters(word_found);
  std::string_view best;
  std::size_t least = found.size() / 3 + 1;
  for (const std::string_view word : words) {
    const std::size_t d = edit_distance(found, word);
    if (d < least && d < word.size()) {
      least = d;
      best = word;
    }
  }
  return best.empty() ? completed(found, words) : best;
}

std::string suggest(std::string_view found, std::span<const std::string_view> words) {
  const std::string_view word = nearest(found, words);
  return word.empty() ? "" : "; did you mean " + std::string(word) + '?';
}

}  // namespace grelha
