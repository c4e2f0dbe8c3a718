// Sums and products of floats of all sizes against rational numbers: no rounding, and no more parts
// than there is room for.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "kernel/base/exact_numbers.hpp"
#include "kernel/shapes/hit.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rational.hpp"

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

mpq_class rational_of(Int128 n) {
  const Int128 size = n < 0 ? -n : n;
  const auto part = [&](int bit) {
    return mpz_class(static_cast<double>(std::uint32_t(size >> bit)));
  };
  mpz_class sum = ((part(96) * mpz_class(0x1p32) + part(64)) * mpz_class(0x1p32) + part(32)) *
                      mpz_class(0x1p32) +
                  part(0);
  return n < 0 ? mpq_class(-sum) : mpq_class(sum);
}

/// Products of three vectors of the largest integers, and of any: the sum that a determinant is.
TEST(WideIntegers, HoldDeterminants) {
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const bool largest = random.chance(.3);
    const double range = random.chance(.5) ? 1 : 1e-6;
    double v[3][3];
    for (auto& p : v)
      for (double& x : p)
        x = largest ? random.sign() * (0x1p40 - 1)
                    : static_cast<float>(random.sign() * random.log_in(range, 1));
    IntegerVector n[3];
    double unit = 0;
    if (!to_integers(v, 40, n, unit))
      continue;
    ++whole;
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        ASSERT_EQ(static_cast<double>(n[i].at[a]) * unit, v[i][a]);
    const Int128 found = dot(cross(n[0], n[1]), n[2]);
    mpq_class truth = 0;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      truth += (mpq_class(v[0][b]) * v[1][c] - mpq_class(v[0][c]) * v[1][b]) * v[2][a];
    }
    ASSERT_EQ(rational_of(found) * unit * unit * unit, truth) << seed;
    ASSERT_EQ(sign_of(found), sgn(truth));
    const Expansion same = expansion_of(found, unit * unit * unit);
    mpq_class rest = truth - same.estimate();
    ASSERT_LE(abs(rest - same.rest()), abs(truth) * mpq_class(0x1p-100)) << seed;
  }
  EXPECT_GT(whole, 8000);
  EXPECT_LT(whole, 19000);
}

/// Rays at corners, edges and faces of triangles whose numbers fit integers, and of others.
TEST(CrossTriangle, IsWhatRationalNumbersSay) {
  int met = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed);
    const double range = random.chance(.5) ? .1 : 1e-12;
    const auto number = [&] { return static_cast<float>(random.sign() * random.log_in(range, 1)); };
    const Float3 p[3] = {{number(), number(), number()},
                         {number(), number(), number()},
                         {number(), number(), number()}};
    const Float3 at = seed % 3 == 0   ? p[seed % 9 / 3]
                      : seed % 3 == 1 ? .5f * (p[0] + p[1])
                                      : .25f * (p[0] + p[1]) + .5f * p[2];
    const Float3 org = {number(), number(), number()};
    const Ray ray{org, at - org};
    const float corner[3][3] = {
        {p[0].x, p[0].y, p[0].z}, {p[1].x, p[1].y, p[1].z}, {p[2].x, p[2].y, p[2].z}};
    const ExactRay exact{{org.x, org.y, org.z}, {ray.dir.x, ray.dir.y, ray.dir.z}, 0, INFINITY};
    const ExactCrossing found = cross_triangle(exact, corner);
    const auto truth = rational::crossing(ray, p[0], p[1], p[2]);
    const bool is_there = truth && *truth > 0;
    ASSERT_EQ(found.some(), is_there) << seed;
    if (!is_there)
      continue;
    ++met;
    ASSERT_LE(abs(mpq_class(found.estimate()) - *truth), abs(*truth) * mpq_class(0x1p-49));
    const float near = static_cast<float>(found.estimate());
    ASSERT_EQ(found.compare(near), sgn(*truth - near)) << seed;
  }
  EXPECT_GT(met, 5000);
}

}  // namespace
}  // namespace grelha::test
