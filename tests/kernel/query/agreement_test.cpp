// Every query about triangles gives the answers of rational numbers: from near, far and very far,
// on either side, in every interval, beside nearly edge-on triangles and among copies.
#include <gtest/gtest.h>

#include "tests/support/agreement.hpp"

namespace grelha::test {
namespace {

TEST(Agreement, EveryQueryAnswersAsRationalNumbersDo) {
  std::uint64_t seed = 0;
  for (const auto& [name, scene] : agreement_meshes()) {
    const bool is_dense = scene.geometry.triangles.a.size() > 4000;
    HardRays rays(scene, ++seed);
    std::vector<Ray> asked(is_dense ? 40 : 1500);
    for (Ray& ray : asked)
      ray = rays.next();
    const WrongAnswers w = Judge(scene).ask(asked, seed);
    EXPECT_GT(w.hits, asked.size() / 9) << name;
    EXPECT_EQ(w.closest, 0u) << name;
    EXPECT_EQ(w.occluded, 0u) << name;
    EXPECT_EQ(w.lists, 0u) << name;
    EXPECT_EQ(w.counts, 0u) << name;
    EXPECT_EQ(w.filters, 0u) << name;
    EXPECT_EQ(w.uv, 0u) << name;
    EXPECT_EQ(w.crossings, 0u) << name;
  }
}

}  // namespace
}  // namespace grelha::test
