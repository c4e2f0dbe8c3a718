#include "frontend/nff/nff_words.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "frontend/files/nearest.hpp"

namespace grelha {
namespace {

// Full names of entities, for users who do not know the keyword. Keywords are too short for a
// search by edit distance.
constexpr std::pair<std::string_view, std::string_view> kFullNames[] = {
    {"sphere", "s"},      {"ball", "s"},          {"polygon", "p"},    {"triangle", "p"},
    {"tri", "p"},         {"quad", "p"},          {"patch", "pp"},     {"cone", "c"},
    {"cylinder", "c"},    {"plane", "pl"},        {"cube", "box"},     {"fill", "f"},
    {"color", "f"},       {"colour", "f"},        {"background", "b"}, {"viewpoint", "v"},
    {"lookfrom", "from"}, {"position", "from"},   {"lookat", "at"},    {"target", "at"},
    {"fov", "angle"},     {"size", "resolution"}, {"samples", "spp"},  {"environment", "env"},
    {"include", "ply"},
};
constexpr std::size_t kLongestSuggested = 64;  ///< no keyword is meant by more

char to_lower(char c) {
  return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c;
}

std::string lower_case(std::string_view word) {
  std::string small(word);
  std::ranges::transform(small, small.begin(), to_lower);
  return small;
}

/// The keyword of a full name; empty when it is none.
std::string_view short_for(std::string_view word) {
  const auto is_word = [word](const auto& name) { return name.first == word; };
  const auto found = std::ranges::find_if(kFullNames, is_word);
  return found == std::end(kFullNames) ? std::string_view() : found->second;
}

}  // namespace

std::string suggested_keyword(std::string_view word, std::span<const std::string_view> known) {
  if (word.size() > kLongestSuggested)
    return "";
  const std::string small = lower_case(word);
  if (std::find(known.begin(), known.end(), small) != known.end())
    return small;
  std::vector<std::string_view> all(known.begin(), known.end());
  for (const auto& name : kFullNames)
    all.push_back(name.first);
  const std::string_view near = nearest(small, all), keyword = short_for(near);
  return std::string(keyword.empty() ? near : keyword);
}

}  // namespace grelha
