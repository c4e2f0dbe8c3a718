#include "kernel/perspective/sight.hpp"

#include "kernel/perspective/tolerances.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

/// What one turn adds to the whole.
struct TurnSight {
  Window window[kFaces];
  std::vector<std::uint32_t> around;
};

void survey_turn(const Onlooker& onlooker, std::size_t turn, TurnSight& to, Glance* glances) {
  WindowRows window[kFaces];
  const std::size_t end = onlooker.end(turn);
  for (std::size_t i = onlooker.begin(turn); i < end;) {
    const Few few = onlooker.few(i, end);
    onlooker.survey(few, window, glances + i);
    for (int k = 0; k < few.count; ++k, ++i)
      if (!onlooker.has_outline(glances[i]))
        to.around.push_back(few.id[k]);
  }
  for (int f = 0; f < kFaces; ++f)
    to.window[f].add(window[f]);
}

}  // namespace

bool Onlooker::has_outline(const Glance& glance) const {
  return glance.distance > kNearest * from_.pad;
}

Few Onlooker::few(std::size_t i, std::size_t end) const {
  Few few;
  const PrimitiveKind kind = kind_of(ids_[i]);
  for (; i < end && few.count < kOutlines && primitives_.ids.has(kind, ids_[i]); ++i)
    few.id[few.count++] = ids_[i];
  return few;
}

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
