// The rows of tests/stability/rows.hpp on a few rays: none may be lost, false or meet what it left.
#include <gtest/gtest.h>

#include "tests/stability/grelha_tracer.hpp"
#include "tests/stability/pictures.hpp"

namespace grelha::stability {

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }
void PrintTo(const PictureRow& row, std::ostream* out) { *out << row.name; }

namespace {

class Stability : public testing::TestWithParam<Row> {};

TEST_P(Stability, NothingIsLostFalseOrMetAgain) {
  for (const char* const isa : {"scalar", "best"}) {
    GrelhaTracer grelha(*find_variant(isa));
    const Counts c = run(GetParam(), grelha, 2000, 7);
    EXPECT_GT(c.answers, 50u);
    if (!GetParam().required) continue;  // walked through all the same
    EXPECT_EQ(c.wrong(), 0u) << c.lost << " lost, " << c.false_ << " false, " << c.self << " self-hits of " << c.answers << ", " << isa << ", " << c.first;
  }
}

template <class Info>
std::string name_of(const Info& info) {
  std::string name;
  for (const char* c = info.param.name; *c; ++c) name += std::isalnum(static_cast<unsigned char>(*c)) ? *c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Rows, Stability, testing::ValuesIn(all_rows()), [](const auto& p) { return name_of(p); });

class StabilityOfPictures : public testing::TestWithParam<PictureRow> {};

TEST_P(StabilityOfPictures, NoPixelIsWrong) {
  const PictureCounts c = GetParam().run(16);
  EXPECT_GT(c.pixels, 0u);
  EXPECT_EQ(c.wrong, 0u) << "of " << c.pixels << ": " << c.first;
}

INSTANTIATE_TEST_SUITE_P(Rows, StabilityOfPictures, testing::ValuesIn(picture_rows()), [](const auto& p) { return name_of(p); });

}  // namespace
}  // namespace grelha::stability
