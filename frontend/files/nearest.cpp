#include "frontend/files/nearest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "frontend/files/text.hpp"

namespace grelha {

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
  constexpr std::size_t kLongest = 64;  // longer words are noise, no typing errors
  if (word_found.size() > kLongest)
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
