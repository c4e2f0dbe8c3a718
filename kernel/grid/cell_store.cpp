#include "kernel/grid/cell_store.hpp"

#include <limits>

namespace grelha {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kNowhere = std::numeric_limits<float>::infinity();

}  // namespace

void ListStore<Triangle>::resize_boxes(std::size_t rows) {
  boxes.resize(rows);
  first_block.resize(rows + 1);
  first_block[rows] = static_cast<std::uint32_t>(blocks.size());
}

void ListStore<Triangle>::end_row(std::size_t place) {
  constexpr float kNowhere = std::numeric_limits<float>::infinity();
  for (; place % kBlock != 0; ++place)
    for (int a = 0; a < 3; ++a) {
      boxes[place / kBlock].side[a][place % kBlock] = kNowhere;
      boxes[place / kBlock].side[3 + a][place % kBlock] = -kNowhere;
    }
}

void ListStore<Triangle>::put(std::size_t entry,
                              std::size_t place,
                              const Triangle::Fields<float>& triangle,
                              std::uint32_t of) {
  TriangleBlock& block = blocks[entry + place / kBlock];
  const std::size_t at = place % kBlock;
  for (int a = 0; a < 3; ++a) {
    block.a[a][at] = triangle.corner[0][a];
    block.b[a][at] = triangle.corner[1][a];
    block.c[a][at] = triangle.corner[2][a];
  }
  block.id[at] = of;
}

void ListStore<Triangle>::end_block(std::size_t entry, std::size_t place) {
  TriangleBlock& block = blocks[entry + place / kBlock];
  for (std::size_t i = place % kBlock; i < kBlock; ++i) {
    for (int a = 0; a < 3; ++a)
      block.a[a][i] = block.b[a][i] = block.c[a][i] = kNoNumber;
    block.id[i] = kNoPrimitive;
  }
}

Triangle::CellList ListStore<Triangle>::list() const {
  if (first.empty())
    return {};
  return {
      first.data(),
      blocks.data(),
      boxes.empty() ? nullptr : boxes.data(),
      boxes.empty() ? nullptr : first_block.data(),
  };
}

CellLists CellStore::lists() const {
  CellLists l;
  for_each_finite_shape([&]<class Shape>() {
    static_cast<typename Shape::CellList&>(l.of<Shape>()) = of<Shape>().list();
  });
  return l;
}

std::size_t CellStore::bytes() const {
  std::size_t sum = 0;
  for_each_finite_shape([&]<class Shape>() { sum += of<Shape>().bytes(); });
  return sum;
}

}  // namespace grelha
