// The rows of tests/stability/rows.hpp on a few rays: none may be lost, false or meet what it left.
#include <gtest/gtest.h>

#include "tests/stability/grelha_tracer.hpp"

namespace grelha::stability {

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

namespace {

class Stability : public testing::TestWithParam<Row> {};

TEST_P(Stability, NothingIsLostFalseOrMetAgain) {
  for (const char* const isa : {"scalar", "best"}) {
    GrelhaTracer grelha(*find_variant(isa));
    const Counts c = run(GetParam(), grelha, 3000, 7);
    EXPECT_GT(c.answers, 50u);
    EXPECT_EQ(c.wrong(), 0u) << c.lost << " lost, " << c.false_ << " false, " << c.self << " self-hits of " << c.answers << ", " << isa << ", " << c.first;
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, Stability, testing::ValuesIn(all_rows()), [](const auto& p) {
  std::string name;
  for (const char* c = p.param.name; *c; ++c) name += std::isalnum(static_cast<unsigned char>(*c)) ? *c : '_';
  return name;
});

}  // namespace
}  // namespace grelha::stability
