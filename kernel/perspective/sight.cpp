#include "kernel/perspective/sight.hpp"

#include <bit>

#include "kernel/perspective/turns.hpp"
#include "kernel/primitive/rounding.hpp"

namespace grelha {
namespace {

/// What one turn adds to the whole.
struct TurnSight {
  Window window[kFaces];
  std::vector<std::uint32_t> around;
};

/// Faces that a primitive is seen through, which are added to the part.
std::uint32_t faces_seen(
    const Onlooker& onlooker, std::uint32_t id, const Box& box, double distance, TurnSight& to) {
  std::uint32_t seen = 0;
  for (unsigned left = onlooker.faces(box); left != 0; left &= left - 1) {
    const int f = std::countr_zero(left);
    Bounds bounds;
    if (!onlooker.see_about(id, box, f, distance, bounds))
      continue;
    if (onlooker.is_large(id))
      to.window[f].add_large(bounds);
    else
      to.window[f].add(bounds);
    seen |= 1u << f;
  }
  return seen;
}

void survey_turn(const Onlooker& onlooker, std::size_t turn, TurnSight& to, Glance* glances) {
  onlooker.each(turn, [&](std::size_t i, std::uint32_t id) {
    const Box box = onlooker.box(id);
    const float distance = float_not_above(onlooker.distance(id, box));
    const bool has_outline = onlooker.has_outline(distance);
    if (!has_outline)
      to.around.push_back(id);
    glances[i] = {distance, has_outline ? faces_seen(onlooker, id, box, distance, to) : 0};
  });
}

}  // namespace

Sight survey(const Onlooker& onlooker, int threads) {
  Sight sum;
  sum.glances.resize(onlooker.count());
  std::vector<TurnSight> parts(onlooker.turns());
  each_turn(parts.size(), threads, [&](std::size_t turn) {
    survey_turn(onlooker, turn, parts[turn], sum.glances.data());
  });
  for (const TurnSight& part : parts) {  // in their order: sums of floats depend on it
    sum.around.insert(sum.around.end(), part.around.begin(), part.around.end());
    for (int f = 0; f < kFaces; ++f)
      sum.window[f].add(part.window[f]);
  }
  std::sort(sum.around.begin(), sum.around.end());
  return sum;
}

}  // namespace grelha
