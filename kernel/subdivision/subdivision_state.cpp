#include "kernel/subdivision/subdivision_state.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "grelha/subdivision.hpp"

namespace grelha {
namespace {

bool ascends(const std::vector<BorderPoint>& border) {
  const auto falls = [](const BorderPoint& a, const BorderPoint& b) { return a.key >= b.key; };
  return std::adjacent_find(border.begin(), border.end(), falls) == border.end();
}

bool is_side(int side) {
  return side >= 1 && side <= kMostSubdividedSide;
}

}  // namespace

SubdivisionState make_subdivision(int width, int height) {
  if (!is_side(width) || !is_side(height))
    throw std::invalid_argument("a subdivided picture has sides from 1 to " +
                                std::to_string(kMostSubdividedSide));
  SubdivisionState state;
  state.image = Image(width, height);
  return state;
}

bool is_sound(const SubdivisionState& s) {
  if (!is_side(s.image.width) || !is_side(s.image.height) || !(s.share >= 0) || s.share > 1)
    return false;
  return ascends(s.left) && std::all_of(s.above.begin(), s.above.end(), ascends);
}

}  // namespace grelha
