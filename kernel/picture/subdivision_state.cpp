#include "kernel/picture/subdivision_state.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "grelha/subdivision.hpp"

namespace grelha {
namespace {

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

bool is_valid(const SubdivisionState& s) {
  return is_side(s.image.width) && is_side(s.image.height) && s.share >= 0 && s.share <= 1 &&
         std::all_of(s.done.begin(), s.done.end(), [](std::uint8_t d) { return d <= 1; });
}

}  // namespace grelha
