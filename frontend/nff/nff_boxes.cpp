#include "frontend/nff/nff_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grelha {
namespace {

using Six = std::array<float, 6>;

/// Returns false if reading the box gives an error or drops it.
bool read_six(Words& words, Six& numbers) {
  const auto reads = [&](float& number) { return to_number(words.next(), number); };
  const auto is_finite = [](float number) { return std::isfinite(number); };
  return std::ranges::all_of(numbers, reads) && std::ranges::all_of(numbers, is_finite);
}

bool are_pairs(const Six& n) {
  return n[0] <= n[1] && n[2] <= n[3] && n[4] <= n[5];
}

bool are_vertices(const Six& n) {
  const bool ascend = n[0] <= n[3] && n[1] <= n[4] && n[2] <= n[5];
  const bool descend = n[0] >= n[3] && n[1] >= n[4] && n[2] >= n[5];
  return ascend || descend;
}

}  // namespace

BoxOrder aabb_order(Words words) {
  bool all_corners = true;
  Six numbers;
  for (std::string_view word = "aabb"; !word.empty(); word = words.next()) {
    if (word != "aabb" || !read_six(words, numbers))
      continue;
    if (!are_pairs(numbers))
      return BoxOrder::kVertices;
    all_corners = all_corners && are_vertices(numbers);
  }
  return all_corners ? BoxOrder::kVertices : BoxOrder::kPairs;
}

}  // namespace grelha
