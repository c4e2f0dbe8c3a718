#include "tests/support/same_grids.hpp"

#include <cstring>
#include <span>

#include "kernel/world/world_impl.hpp"

namespace grelha::test {
namespace {

template <class T>
bool same(const T& a, const T& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

bool same(const CellStore& a, const CellStore& b) {
  bool all = true;
  const auto compare = [&](const auto& one, const auto& other) { all = all && same(one, other); };
  for_each_finite_shape([&]<class Shape>() {
    const auto& one = a.of<Shape>();
    const auto& other = b.of<Shape>();
    compare(one.first, other.first);
    if constexpr (Shape::kInBlocks) {
      compare(one.blocks, other.blocks);
      compare(one.boxes, other.boxes);
      compare(one.first_block, other.first_block);
    } else {
      compare(one.id, other.id);
      compare(one.rows, other.rows);
    }
  });
  return all && a.references == b.references;
}

}  // namespace

bool same_grids(const World& a, const World& b) {
  const World::Impl &x = a.impl(), &y = b.impl();
  bool all = same(x.outside, y.outside) && x.grids.size() == y.grids.size();
  for (std::size_t i = 0; all && i < x.grids.size(); ++i)
    all = same(std::span(x.grids[i]->grid.lo), std::span(y.grids[i]->grid.lo)) &&
          same(std::span(x.grids[i]->grid.cell), std::span(y.grids[i]->grid.cell)) &&
          x.grids[i]->grid.cells == y.grids[i]->grid.cells &&
          same(x.grids[i]->grid.store, y.grids[i]->grid.store) &&
          same(x.grids[i]->grid.distance, y.grids[i]->grid.distance) &&
          x.grids[i]->grid.occupied == y.grids[i]->grid.occupied;
  return all;
}

}  // namespace grelha::test
