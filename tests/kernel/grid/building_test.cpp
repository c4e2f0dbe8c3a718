// Building a World: what it says it will take, how far it says it is, and that it can be stopped.

#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <vector>

#include "frontend/nff/nff_reader.hpp"
#include "grelha/render.hpp"
#include "scenes/generators.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
// clang's runtime for threads defines operator new in an archive: a second one does not link
#define GRELHA_NEW_IS_TAKEN
#endif
#endif

namespace {

/// Bytes that operator new has handed out, now and at most.
std::atomic<std::ptrdiff_t> owned = 0, most = 0;

#ifdef GRELHA_NEW_IS_TAKEN
constexpr bool kCounted = false;
}  // namespace
#else
constexpr bool kCounted = true;

void* count(void* p, std::size_t bytes) {
  if (!p)
    throw std::bad_alloc();
  const std::ptrdiff_t now = owned += static_cast<std::ptrdiff_t>(bytes);
  for (std::ptrdiff_t m = most; m < now && !most.compare_exchange_weak(m, now);) {
  }
  return p;
}
void* count(void* p) {
  return count(p, p ? malloc_usable_size(p) : 0);
}

void give_back(void* p) {
  owned -= static_cast<std::ptrdiff_t>(malloc_usable_size(p));
  std::free(p);
}

}  // namespace

void* operator new(std::size_t n) {
  return count(std::malloc(n));
}
// A block that begins on a large page may extend to another page that is never touched, so the
// requested size is counted. It is stored in front of the returned pointer.
void* operator new(std::size_t n, std::align_val_t a) {
  const auto front = static_cast<std::size_t>(a);
  void* p = nullptr;
  if (posix_memalign(&p, front, front + n) != 0)
    throw std::bad_alloc();
  char* const given = static_cast<char*>(p) + front;
  std::memcpy(given - sizeof n, &n, sizeof n);
  return count(given, n);
}
void operator delete(void* p) noexcept {
  give_back(p);
}
void operator delete(void* p, std::size_t) noexcept {
  give_back(p);
}
void operator delete(void* p, std::align_val_t a) noexcept {
  std::size_t n = 0;
  std::memcpy(&n, static_cast<char*>(p) - sizeof n, sizeof n);
  owned -= static_cast<std::ptrdiff_t>(n);
  std::free(static_cast<char*>(p) - static_cast<std::size_t>(a));
}
void operator delete(void* p, std::size_t, std::align_val_t a) noexcept {
  operator delete(p, a);
}
#endif

namespace grelha::test {
namespace {

struct Case {
  const char* name;
  int size;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name << ' ' << c.size;
}

/// Small triangles anywhere in a cube: most blocks are not full. In clumps of so many that follow
/// each other.
Scene soup(int count, int clump = 1) {
  Scene scene = empty_scene();
  Random random(3);
  Float3 p;
  for (int i = 0; i < count; ++i) {
    if (i % clump == 0)
      p = random.point(1);
    add_triangle(scene, p, at(p, .02, random.direction()), at(p, .02, random.direction()));
  }
  return scene;
}

Scene scene_of(const Case& c) {
  const std::string name = c.name;
  if (name == "soup")
    return soup(c.size);
  if (name == "clumps")
    return soup(c.size, 16);
  if (name == "sheets")
    return stacked_sheets(c.size);
  if (name == "towns")
    return towns_in_a_desert(5, c.size);
  std::ostringstream text;
  scenes::find_generator(name)->write(text, {c.size, false, ""});
  return read_nff(name + ".nff", text.str(), [](const std::string&) {}).scene;
}

class Building : public testing::TestWithParam<Case> {};

/// References are estimated from 16,000 picked primitives, whose mean is known within 5 % (three
/// standard deviations, if one is twice the mean). The blocks of a cell are wrong by at most half a
/// block: a tenth with the five triangles per cell of a soup. The allowed error of a fifth covers
/// both, and the overhead of malloc for each array.
TEST_P(Building, TakesWhatItSaid) {
  if (!kCounted)
    GTEST_SKIP() << "this sanitizer keeps operator new to itself";
  const Scene scene = scene_of(GetParam());
  const BuildOptions options{.threads = 2};
  const BuildMemory said = World::estimate(scene, options);
  const std::ptrdiff_t before = owned;
  most = before;
  const World world(scene, options);
  const double peak = static_cast<double>(most - before) / static_cast<double>(said.peak);
  const double kept = static_cast<double>(owned - before) / static_cast<double>(said.kept);
  EXPECT_GT(peak, 1 / 1.2);
  EXPECT_LT(peak, 1.2);
  EXPECT_GT(kept, 1 / 1.2);
  EXPECT_LT(kept, 1.2);
}

INSTANTIATE_TEST_SUITE_P(Scenes,
                         Building,
                         testing::Values(Case{"balls", 5},
                                         Case{"mount", 8},
                                         Case{"tree", 13},
                                         Case{"rings", 14},
                                         Case{"gears", 5},
                                         Case{"lattice", 20},
                                         Case{"stadium", 15},
                                         Case{"tetra", 8},
                                         Case{"soup", 100000},
                                         Case{"clumps", 300000},
                                         Case{"sheets", 10000},
                                         Case{"towns", 30000}));

TEST(BuildingWithoutGrid, TakesWhatItSaid) {
  if (!kCounted)
    GTEST_SKIP() << "this sanitizer keeps operator new to itself";
  const Scene scene = random_mixture(5, 100000);
  const BuildOptions options{.grid = false};
  const BuildMemory said = World::estimate(scene, options);
  const std::ptrdiff_t before = owned;
  most = before;
  const World world(scene, options);
  EXPECT_NEAR(static_cast<double>(most - before) / static_cast<double>(said.peak), 1, .2);
  EXPECT_NEAR(static_cast<double>(owned - before) / static_cast<double>(said.kept), 1, .2);
}

TEST(Building, IsRefusedWhatItMayNotTake) {
  const Scene scene = soup(20000);
  const BuildMemory need = World::estimate(scene, {});
  EXPECT_NO_THROW(World(scene, {.most_bytes = need.peak}));
  const std::ptrdiff_t before = owned;
  most = before;
  try {
    World(scene, {.most_bytes = need.peak - 1});
    ADD_FAILURE() << "built";
  } catch (const TooLarge& error) {
    EXPECT_EQ(error.need.peak, need.peak);
    EXPECT_EQ(error.need.kept, need.kept);
  }
  EXPECT_LT(most - before, static_cast<std::ptrdiff_t>(need.peak / 3))
      << "nothing was built before it was refused";
}

/// One group, many, near and far grids, clusters, no grid, nothing.
std::vector<Scene> all_sorts() {
  std::vector<Scene> all{soup(20000),
                         random_mixture(5, 3000),
                         towns_in_a_desert(5, 6000),
                         scene_of({"stadium", 6}),
                         empty_scene()};
  return all;
}

TEST(Building, TellsHowFarItIs) {
  for (const Scene& scene : all_sorts())
    for (const bool grid : {true, false}) {
      double last = 0;
      int calls = 0;
      bool ascends = true, may_stop = false;
      const World world(scene, {.grid = grid, .threads = 3, .progress = [&](double share) {
                                  ascends &= share >= last && share <= 1;
                                  may_stop |= share > .3 && share < .9;
                                  last = share;
                                  ++calls;
                                  return true;
                                }});
      EXPECT_TRUE(ascends);
      EXPECT_EQ(last, 1);
      EXPECT_GT(calls, 2);
      EXPECT_EQ(may_stop, !world.grids().empty());
    }
}

TEST(Building, StopsWhenTold) {
  for (const Scene& scene : all_sorts()) {
    int all = 0;
    World(scene, {.threads = 3, .progress = [&](double) { return ++all > 0; }});
    for (int stop = 1; stop <= all; stop += std::max(1, all / 20)) {
      const std::ptrdiff_t before = owned;
      std::atomic<int> calls = 0;
      EXPECT_THROW(World(scene, {.threads = 3, .progress = [&](double) { return ++calls < stop; }}),
                   Stopped)
          << stop << " of " << all;
      EXPECT_EQ(calls, stop) << "nobody is asked again";
      EXPECT_EQ(owned, before) << "everything is given back";
    }
  }
}

}  // namespace
}  // namespace grelha::test
