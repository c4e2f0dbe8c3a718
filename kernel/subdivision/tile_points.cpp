#include "kernel/subdivision/tile_points.hpp"

#include <algorithm>
#include <iterator>

namespace grelha {
namespace {

/// Bits of x at every other place.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000FFFF0000FFFFu;
  x = (x | x << 8) & 0x00FF00FF00FF00FFu;
  x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

bool lies_on(std::uint32_t steps, int line) {
  return steps == static_cast<std::uint32_t>(line) * kLatticeSteps;
}

}  // namespace

std::uint64_t morton(LatticePoint p) {
  return spread(p.x) | spread(p.y) << 1;
}

void TilePoints::load_border(const TileRect& rect,
                             const std::vector<BorderPoint>& above,
                             const std::vector<BorderPoint>& left,
                             std::vector<Float3>& colours) {
  rect_ = rect;
  known_.clear();
  fresh_.clear();
  right_border_.clear();
  lower_border_.clear();
  std::set_union(above.begin(),
                 above.end(),
                 left.begin(),
                 left.end(),
                 std::back_inserter(known_),
                 [](const BorderPoint& a, const BorderPoint& b) { return a.key < b.key; });
  numbered_ = known_.size();
  if (colours.size() >= numbered_)
    return;  // those of a tile to go on with
  colours.clear();
  for (const BorderPoint& k : known_)
    colours.push_back(k.colour);
}

const BorderPoint* TilePoints::known_at(LatticePoint p, std::uint64_t key) const {
  if (!lies_on(p.x, rect_.x0) && !lies_on(p.y, rect_.y0))
    return nullptr;
  const auto before = [](const BorderPoint& a, std::uint64_t k) { return a.key < k; };
  const auto at = std::lower_bound(known_.begin(), known_.end(), key, before);
  return at != known_.end() && at->key == key ? &*at : nullptr;
}

std::uint32_t TilePoints::number(LatticePoint p, std::uint64_t key) {
  const BorderPoint* const known = known_at(p, key);
  const std::uint32_t id = static_cast<std::uint32_t>(
      known ? static_cast<std::size_t>(known - known_.data()) : numbered_ + fresh_.size());
  if (!known)
    fresh_.push_back(p);
  if (lies_on(p.x, rect_.x1))
    right_border_.push_back({key, id});
  if (lies_on(p.y, rect_.y1))
    lower_border_.push_back({key, id});
  return id;
}

void TilePoints::accept_fresh() {
  numbered_ += fresh_.size();
  fresh_.clear();
}

void TilePoints::store_border(const std::vector<Float3>& colours,
                              std::vector<BorderPoint>& lower,
                              std::vector<BorderPoint>& right) {
  store(right_border_, colours, right);
  store(lower_border_, colours, lower);
}

void TilePoints::store(std::vector<Border>& border,
                       const std::vector<Float3>& colours,
                       std::vector<BorderPoint>& to) {
  std::sort(
      border.begin(), border.end(), [](const Border& a, const Border& b) { return a.key < b.key; });
  to.clear();
  for (const Border& b : border)
    to.push_back({b.key, colours[b.id]});
}

}  // namespace grelha
