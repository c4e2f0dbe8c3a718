// The rows of tests/stability/rows.hpp on a few rays: none may be lost, false or hit what it left.
#include <gtest/gtest.h>

#include "tests/stability/grelha_tracer.hpp"
#include "tests/stability/pictures.hpp"

namespace grelha::stability {

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.name;
}
void PrintTo(const PictureRow& row, std::ostream* out) {
  *out << row.name;
}

namespace {

class Stability : public testing::TestWithParam<Row> {};

TEST_P(Stability, NothingIsLostFalseOrMetAgain) {
  for (const Variant* const variant : variants()) {
    if (!variant->is_supported())
      continue;
    GrelhaTracer grelha(*variant);
    const Counts c = run(GetParam(), grelha, 2000, 7);
    EXPECT_GT(c.answers, 50u);
    EXPECT_EQ(c.wrong(), 0u) << c.lost << " lost, " << c.false_ << " false, " << c.self
                             << " self-hits of " << c.answers << ", " << variant->name << ", "
                             << c.first;
  }
}

template <class Info>
std::string name_of(const Info& info) {
  std::string name;
  for (const char* c = info.param.name; *c; ++c)
    name += std::isalnum(static_cast<unsigned char>(*c)) ? *c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Rows, Stability, testing::ValuesIn(all_rows()), [](const auto& p) {
  return name_of(p);
});

/// A line crosses at most nx + ny + nz - 2 cells, and a triangle .001 wide in cells of .5 hardly
/// more.
TEST(References, LongThinDiagonalsAreInAsManyCellsAsALine) {
  for (const Row& row : walk_rows()) {
    if (std::string_view(row.name) != "long thin diagonals")
      continue;
    Random random(1);
    row.make(random, 1, [](const Trial& trial) {
      const World world(trial.scene, {});
      ASSERT_EQ(world.grids().size(), 1u);
      const GridStats g = world.grids()[0];
      EXPECT_LE(g.references,
                trial.scene.geometry.triangles.size() * (g.cells[0] + g.cells[1] + g.cells[2]));
    });
    return;
  }
  FAIL() << "no such row";
}

class StabilityOfPictures : public testing::TestWithParam<PictureRow> {};

TEST_P(StabilityOfPictures, NoPixelIsWrong) {
  const PictureCounts c = GetParam().run(16);
  EXPECT_GT(c.pixels, 0u);
  EXPECT_EQ(c.wrong, 0u) << "of " << c.pixels << ": " << c.first;
}

INSTANTIATE_TEST_SUITE_P(Rows,
                         StabilityOfPictures,
                         testing::ValuesIn(picture_rows()),
                         [](const auto& p) { return name_of(p); });

}  // namespace
}  // namespace grelha::stability
