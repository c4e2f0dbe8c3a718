// Primitives looked at eight at a time give what the scalar copy gives of them, bit for bit,
// whatever the instruction set.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "kernel/perspective/tolerances.hpp"
#include "kernel/query/variants.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// Up to eight neighbours of one kind.
Few some_of(Random& random, const Primitives& p) {
  const std::uint32_t first =
      p.first_finite() + static_cast<std::uint32_t>(random.below(p.finite_count()));
  const PrimitiveKind kind = p.kind_of(first);
  Few few;
  const int most = 1 + static_cast<int>(random.below(kOutlines));
  for (std::uint32_t id = first; few.count < most && p.ids.has(kind, id); ++id)
    few.id[few.count++] = id;
  return few;
}

PointFace tiles_of_a_face() {
  PointFace face;
  face.u = face.v = -.9;
  face.nx = face.ny = 16;
  face.per_u = face.per_v = face.nx / 1.8;
  face.depth = .1;
  return face;
}

/// What one copy says of some primitives.
struct Said {
  Glance glances[kOutlines] = {};
  Window window[kFaces];
  SeenFew seen[kFaces];

  Said(const LookLoops& loops, const Primitives& p, const Viewpoint& from, const Few& few) {
    WindowRows rows[kFaces];
    loops.survey(p, from, few, 0b1010, rows, glances);
    float distance[kOutlines] = {};
    for (int k = 0; k < few.count; ++k)
      distance[k] = std::max(glances[k].distance, static_cast<float>(2 * kNearest * from.pad));
    for (int f = 0; f < kFaces; ++f) {
      window[f].add(rows[f]);
      loops.see(p, from, few, distance, f, tiles_of_a_face(), seen[f]);
    }
  }
};

void expect_row(const float (&a)[kOutlines], const float (&b)[kOutlines], int k) {
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a[k]), std::bit_cast<std::uint32_t>(b[k]));
}
void expect_row(const double (&a)[kOutlines], const double (&b)[kOutlines], int k) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a[k]), std::bit_cast<std::uint64_t>(b[k]));
}
template <class Row, std::size_t n>
void expect_row(const Row (&a)[n][kOutlines], const Row (&b)[n][kOutlines], int k) {
  for (std::size_t i = 0; i < n; ++i)
    expect_row(a[i], b[i], k);
}

/// Primitive k of some, through one face.
void expect_same(const SeenFew& a, const SeenFew& b, int k) {
  expect_row(a.lo, b.lo, k);
  expect_row(a.hi, b.hi, k);
  expect_row(a.near, b.near, k);
  expect_row(a.anchor, b.anchor, k);
  expect_row(a.last, b.last, k);
  EXPECT_EQ(a.on_tiles >> k & 1, b.on_tiles >> k & 1);
  expect_row(a.box_lo, b.box_lo, k);
  expect_row(a.box_hi, b.box_hi, k);
  if (!a.sided)
    return;
  expect_row(a.far, b.far, k);
  expect_row(a.side, b.side, k);
  for (int i = 0; i < 3; ++i) {
    expect_row(a.side_of[i].b, b.side_of[i].b, k);
    expect_row(a.side_of[i].c, b.side_of[i].c, k);
    expect_row(a.side_of[i].per_lo, b.side_of[i].per_lo, k);
    expect_row(a.side_of[i].lo, b.side_of[i].lo, k);
    expect_row(a.side_of[i].per_hi, b.side_of[i].per_hi, k);
    expect_row(a.side_of[i].hi, b.side_of[i].hi, k);
  }
}

void expect_same(const Window& a, const Window& b) {
  for (int j = 0; j < 2; ++j) {
    EXPECT_EQ(a.lo[j], b.lo[j]);
    EXPECT_EQ(a.hi[j], b.hi[j]);
    EXPECT_EQ(a.across[j], b.across[j]);
  }
  EXPECT_EQ(a.near, b.near);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.large, b.large);
}

void expect_same(const Said& a, const Said& b, const Few& few) {
  for (int k = 0; k < few.count; ++k) {
    EXPECT_EQ(a.glances[k].distance, b.glances[k].distance);
    EXPECT_EQ(a.glances[k].faces, b.glances[k].faces);
  }
  for (int f = 0; f < kFaces; ++f) {
    expect_same(a.window[f], b.window[f]);
    EXPECT_EQ(a.seen[f].seen, b.seen[f].seen);
    EXPECT_EQ(a.seen[f].sided, b.seen[f].sided);
    for (unsigned left = a.seen[f].seen; left != 0; left &= left - 1)
      expect_same(a.seen[f], b.seen[f], std::countr_zero(left));
  }
}

class Looks : public testing::TestWithParam<const Variant*> {};

TEST_P(Looks, GiveTheScalarBits) {
  if (!GetParam()->runs_here())
    GTEST_SKIP() << "this processor lacks it";
  const Scene scene = random_mixture(71, 600);
  const Primitives p(scene.geometry);
  Random random(72);
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    const Float3 at = random.point(random.log_in(.3, 30));
    const double pad = random.log_in(1e-6, 1e-2);
    const Viewpoint from{{at.x, at.y, at.z}, pad, pad / 16};
    const Few few = some_of(random, p);
    const Said scalar(variants()[0]->loops.look, p, from, few);
    expect_same(Said(GetParam()->loops.look, p, from, few), scalar, few);
    ASSERT_FALSE(HasFailure()) << "round " << i << ", kind of " << few.id[0];
    for (const SeenFew& face : scalar.seen)
      seen += std::popcount(face.seen);
  }
  EXPECT_GT(seen, 10000);
}

INSTANTIATE_TEST_SUITE_P(Isa,
                         Looks,
                         testing::ValuesIn(variants().begin(), variants().end()),
                         [](const auto& p) { return std::string(p.param->name); });

}  // namespace
}  // namespace grelha::test
