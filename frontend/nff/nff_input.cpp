#include "frontend/nff/nff_input.hpp"

#include "frontend/scene/scene_builder.hpp"

namespace grelha {

void NffInput::fail(std::string_view word, const std::string& expected) const {
  throw ParseError(position(word), expected, quoted(word));
}

void NffInput::warn_once(std::string_view kind, std::string_view word, const std::string& message) {
  if (warning_list.first(kind))
    warning_list.add_line(position(word), message);
}

float NffInput::number(const char* what) {
  float value;
  if (words.next_number(value))
    return value;
  const std::string_view word = words.next();
  if (!to_number(word, value))
    fail(word, std::string("a number for ") + what);
  return value;
}

void NffInput::check_bounds(std::string_view word, float value, const char* what) const {
  if (!is_finite_float(value))
    fail(word, std::string("a finite number, at most 1e18, for ") + what);
}

float NffInput::bounded(const char* what) {
  const std::string_view word = words.next();
  float value;
  if (!to_number(word, value))
    fail(word, std::string("a number for ") + what);
  check_bounds(word, value, what);
  return value;
}

Float3 NffInput::point(const char* what) {
  const float x = number(what), y = number(what), z = number(what);
  return {x, y, z};
}

Float3 NffInput::bounded_point(const char* what) {
  const float x = bounded(what), y = bounded(what), z = bounded(what);
  return {x, y, z};
}

double NffInput::wide_number(const char* what) {
  const std::string_view word = words.next();
  double value;
  if (!to_number(word, value))
    fail(word, std::string("a number for ") + what);
  return value;
}

Float3 NffInput::framed_point(const char* what) {
  if (frame == Frame{})
    return point(what);
  const double x = wide_number(what), y = wide_number(what), z = wide_number(what);
  return frame.inside({x, y, z});
}

Float3 NffInput::bounded_framed_point(const char* what) {
  const Words before = words;
  const Float3 as_it_stands = bounded_point(what);
  if (frame == Frame{})
    return as_it_stands;
  words = before;
  return framed_point(what);
}

float NffInput::length(const char* what) {
  return frame == Frame{} ? number(what) : frame.length(wide_number(what));
}

std::size_t NffInput::count(const char* what, std::size_t least_bytes) {
  const std::string_view word = words.next();
  std::int64_t value = 0;
  if (!to_integer(word, value) || value < 0)
    fail(word, std::string("a whole number for ") + what);
  const std::size_t most = words.bytes_left() / least_bytes;
  if (std::uint64_t(value) > most)
    throw ParseError(position(word),
                     "at most " + std::to_string(most) + " for " + what + " (the file ends before)",
                     quoted(word));
  return std::size_t(value);
}

std::vector<NumberWord> NffInput::numbers(std::size_t enough, const char* what) {
  std::vector<NumberWord> found;
  for (;;) {
    std::string_view word = words.peek_on_line();
    if (word.empty() && found.size() < enough)
      word = words.peek();
    if (!looks_like_number(word))
      return found;
    words.next();
    NumberWord number{0, word};
    if (!to_number(word, number.value))
      fail(word, std::string("a number for ") + what);
    check_bounds(word, number.value, what);
    found.push_back(number);
  }
}

}  // namespace grelha
