// Sums and products of floats of all sizes against rational numbers: no rounding, and no more parts
// than there is room for.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "kernel/base/expansion.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

/// A number with few digits or many, of any size.
double any_float(Random& random, double range) {
  const double size = random.log_in(1 / range, range) * random.sign();
  return static_cast<float>(random.chance(.3) ? std::ldexp(1., std::ilogb(size)) : size);
}

TEST(Expansions, AreWhatRationalNumbersAre) {
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    Random random(seed);
    const double range = random.chance(.5) ? 1e3 : 1e30;
    Expansion sum;
    mpq_class truth = 0;
    for (int term = 0; term < 12; ++term) {
      Expansion product(any_float(random, range));
      mpq_class exact = product.estimate();
      for (int factor = 0; factor < 5; ++factor) {
        const double x = any_float(random, range);
        const double y = random.chance(.5) ? any_float(random, range) : 0;
        product = product * Expansion::difference(x, y);
        exact *= mpq_class(x) - mpq_class(y);
      }
      sum += product;
      truth += exact;
      if (random.chance(.2)) {  // what cancels but for the last of it
        const double near = sum.estimate();
        sum.add(-near);
        truth -= near;
      }
      ASSERT_EQ(sum.sign(), sgn(truth)) << seed;
      const mpq_class error = abs(mpq_class(sum.estimate()) - truth);
      ASSERT_LE(error, abs(truth) * mpq_class(0x1p-51)) << seed;
    }
  }
}

}  // namespace
}  // namespace grelha::test
