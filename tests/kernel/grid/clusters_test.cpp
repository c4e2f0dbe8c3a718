// Tests scenes for which one level of cells, or the number of cells that a density asks for, would
// be too much.

#include <gtest/gtest.h>

#include <algorithm>

#include "kernel/world/world_impl.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

TEST(Clusters, GetCellsOfTheirOwnSize) {
  const Scene scene = towns_in_a_desert(5, 6000);
  const World world(scene, {});
  std::size_t most = 0;
  for (const auto& built : world.impl().grids) {
    const Grid& g = built->grid;
    const auto& first = g.store.of<Sphere>().first;
    for (std::size_t c = 0; c + 1 < first.size(); ++c)
      most = std::max<std::size_t>(most, first[c + 1] - first[c]);
  }
  EXPECT_LT(most, 4096u) << "of 24600 spheres";  // what is called bad; without clusters it is 18001
}

TEST(Clusters, AreNotSeenWhereThereAreNone) {
  const Scene even = random_mixture(5, 20000);
  EXPECT_EQ(World(even, {}).grids().size(), 1u);
  // All in one place: no cells would help.
  Scene one_place = empty_scene();
  for (int i = 0; i < 3000; ++i)
    one_place.geometry.spheres.add({1, 2, 3}, .5f, 0);
  EXPECT_EQ(World(one_place, {}).grids().size(), 1u);
}

TEST(References, AreBounded) {
  Scene heap_of_copies = empty_scene();
  for (int i = 0; i < 50000; ++i)
    add_triangle(heap_of_copies, {0, 0, 0}, {1, .1f, .2f}, {.1f, 1, .9f});
  const World world(heap_of_copies, {});
  // 800 each without a bound
  for (const GridStats& g : world.grids())
    EXPECT_LE(g.references, 64u * 50000u);
}

}  // namespace
}  // namespace grelha::test
