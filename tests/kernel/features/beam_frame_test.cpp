// The pyramid that stands for a beam's four rays: how far from them it may be.

// A copy of its own, which the linker cannot take for the kernel's.
#define GRELHA_ISA beam_frame
#define GRELHA_ISA_beam_frame 1

#include <gtest/gtest.h>

#include <numbers>

#include "kernel/features/beam.hpp"
#include "kernel/features/corner_hits.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {
namespace {

using beam_frame::across;
using beam_frame::Beam;
using beam_frame::BeamFrame;
using beam_frame::CornerSurfaces;
using beam_frame::farthest_hit;
using beam_frame::frame_of;
using beam_frame::kCorners;
using beam_frame::place;
using beam_frame::Place;
using Vector = beam_frame::Vec3<float>;

/// Signs of the corners along x and y.
constexpr float kSigns[kCorners][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/// From the square of half side `half` at z = 0, along -z, spread by `spread` a unit of way.
Beam square_beam(float half, float spread) {
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    const auto [x, y] = kSigns[i];
    b.org[i] = {x * half, y * half, 0};
    b.dir[i] = normalize(Vector{x * spread, y * spread, -1});
  }
  return b;
}

TEST(BeamFrame, IsThereForNarrowBeamsAlone) {
  BeamFrame f;
  EXPECT_TRUE(frame_of(square_beam(0, .04f), f));   // 3.2 degrees to a corner
  EXPECT_FALSE(frame_of(square_beam(0, .05f), f));  // 4
  EXPECT_FALSE(frame_of(square_beam(0, .5f), f));
}

/// A patch that is seen from its side is as thin as a sheet, straight across or along a slant.
/// What rounds moves the corners by up to 2.5 u (of two million beams), which is so many times the
/// beam: .3125 of one as thin as 8 u, and thinner ones are none.
TEST(BeamFrame, IsThereForNoSheet) {
  Random random(4);
  int beams = 0;
  int sheets = 0;
  for (int i = 0; i < 20000; ++i) {
    const Float3 toward = random.direction();
    const Vector axis{toward.x, toward.y, toward.z};
    Vector u, v;
    across(axis, u, v);
    const float wide = static_cast<float>(random.log_in(1e-5, .02));
    const float thin = static_cast<float>(random.log_in(1e-9, 1e-4));
    const float slant = static_cast<float>(random.chance(.5) ? random.log_in(1e-5, .02) : 0);
    Beam b;
    for (int k = 0; k < kCorners; ++k) {
      const auto [x, y] = kSigns[k];
      b.org[k] = {0, 0, 0};
      b.dir[k] = normalize(axis + (x * wide + y * slant) * u + (y * thin) * v);
    }
    BeamFrame f;
    if (!frame_of(b, f)) {
      ++sheets;
      continue;
    }
    ++beams;
    for (int k = 0; k < kCorners; ++k) {
      const Place p = place(f, b.dir[k]);
      ASSERT_NEAR(p.x, kSigns[k][0], .32) << i << ": " << wide << ' ' << thin << ' ' << slant;
      ASSERT_NEAR(p.y, kSigns[k][1], .32) << i << ": " << wide << ' ' << thin << ' ' << slant;
    }
  }
  EXPECT_GT(beams, 5000);
  EXPECT_GT(sheets, 5000);
}

/// Rays that never meet, on their way of up to a hundred widths: they stay at the corners of the
/// pyramid to a hundredth of it, at their start by what floats hold of a far apex.
TEST(BeamFrame, HoldsParallelRays) {
  for (const float half : {1e-3f, 1.f, 1e3f}) {
    const Beam b = square_beam(half, 0);
    BeamFrame f;
    ASSERT_TRUE(frame_of(b, f)) << half;
    for (const float way : {0.f, 1.f, 10.f, 100.f})
      for (int i = 0; i < kCorners; ++i) {
        const Place p = place(f, b.org[i] + (way * half) * b.dir[i]);
        EXPECT_NEAR(p.x, kSigns[i][0], .01) << half << ' ' << way;
        EXPECT_NEAR(p.y, kSigns[i][1], .01) << half << ' ' << way;
      }
  }
}

/// Rays that spread, at any size of what they are in: they stay at the corners of the pyramid.
TEST(BeamFrame, HoldsSpreadingRaysOfAnySize) {
  for (const float half : {1e-6f, 1e-3f, 1.f, 1e3f, 1e6f}) {
    const Beam b = square_beam(half, .01f);
    BeamFrame f;
    ASSERT_TRUE(frame_of(b, f)) << half;
    for (const float way : {0.f, 10.f, 100.f, 1e3f})
      for (int i = 0; i < kCorners; ++i) {
        const Place p = place(f, b.org[i] + (way * half) * b.dir[i]);
        EXPECT_NEAR(p.x, kSigns[i][0], .001) << half << ' ' << way;
        EXPECT_NEAR(p.y, kSigns[i][1], .001) << half << ' ' << way;
      }
  }
}

/// The beam around the rays of one eye at 0 through a square, at z = -1, of half side `half`: from
/// where they pass a plane through (0, 0, -1).
Beam beam_from_plane(float half, const Vector& normal) {
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    const auto [x, y] = kSigns[i];
    b.dir[i] = normalize(Vector{x * half, y * half, -1});
    b.org[i] = (-normal.z / dot(b.dir[i], normal)) * b.dir[i];
  }
  return b;
}

/// However slanted the plane is the apex is the eye. The mean of the corners is off the axis by
/// half^2 times the tangent of the slant, and a little more; offsets and growths round by some 16 u
/// of the way, which is 1 and more, where they are `half`. From an apex that is so far off, corners
/// are seen aside by as much of the width.
TEST(BeamFrame, HasItsApexAtTheEyeBehindSlantedPlanes) {
  constexpr double kUnit = 0x1p-24;
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const double slant = random.in(0, 75) * std::numbers::pi / 180;
    const double turn = random.in(0, 7);
    const float half = static_cast<float>(random.log_in(1e-3, .04));
    BeamFrame f;
    ASSERT_TRUE(frame_of(beam_from_plane(half,
                                         {static_cast<float>(std::sin(slant) * std::cos(turn)),
                                          static_cast<float>(std::sin(slant) * std::sin(turn)),
                                          static_cast<float>(std::cos(slant))}),
                         f));
    const double h = static_cast<double>(half);
    const double off = 2 * h * h * std::tan(slant) + 16 * kUnit / h;
    EXPECT_LE(length(f.apex), off) << i;
    for (int k = 0; k < 20; ++k) {
      const float x = static_cast<float>(random.in(-1, 1));
      const float y = static_cast<float>(random.in(-1, 1));
      const float way = static_cast<float>(random.log_in(1, 100));
      const Place p = place(f, way * Vector{x * half, y * half, -1});
      EXPECT_NEAR(p.x, x, off / h) << i;
      EXPECT_NEAR(p.y, y, off / h) << i;
    }
  }
}

/// The beam around the rays of one eye through a square, at z = -1, of half side `half`, which a
/// mirror through (0, 0, -1) sent on.
Beam mirrored_beam(float half, const Vector& normal) {
  const Vector at{0, 0, -1};
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    const auto [x, y] = kSigns[i];
    const Vector d = normalize(Vector{x * half, y * half, -1});
    b.org[i] = (dot(at, normal) / dot(d, normal)) * d;
    b.dir[i] = normalize(d - (2 * dot(d, normal)) * normal);
  }
  return b;
}

/// Widths that beams have, for those of their rays.
constexpr float kGrowths[] = {1, kPixelGrowth, kSquareGrowth};

/// No point of the mirror lies beyond where the pyramid begins. The corners would be its ends, were
/// what the pyramid cuts out of it their trapezoid. It reaches beyond them by up to .08 of the way
/// between first and last.
TEST(BeamFrame, BeginsBehindItsMirror) {
  Random random(1);
  int beams = 0;
  for (int i = 0; i < 5000; ++i) {
    const Float3 n = random.direction();
    if (n.z < .1f)  // more than 84 degrees aslant
      continue;
    const Vector normal{n.x, n.y, n.z};
    Beam b = mirrored_beam(static_cast<float>(random.log_in(1e-5, .04)), normal);
    b.growth = kGrowths[i % 3];
    BeamFrame f;
    if (!frame_of(b, f))
      continue;
    ++beams;
    for (int part = 0; part < 25; ++part) {
      const float x = static_cast<float>(part % 5 - 2) / 2;
      const float y = static_cast<float>(part / 5 - 2) / 2;
      const Vector dir = f.axis + x * f.right + y * f.up;
      const float w = dot(Vector{0, 0, -1} - f.apex, normal) / dot(dir, normal);
      ASSERT_LE(w, f.depth) << i << ": " << x << ' ' << y;
    }
  }
  EXPECT_GT(beams, 1000);
}

/// A beam is as much wider than its rays as it is told.
TEST(BeamFrame, IsWiderThanItsRays) {
  for (const float growth : kGrowths) {
    Beam b = square_beam(1, .01f);
    b.growth = growth;
    BeamFrame f;
    ASSERT_TRUE(frame_of(b, f));
    for (int i = 0; i < kCorners; ++i) {
      const Place p = place(f, b.org[i] + 100.f * b.dir[i]);
      EXPECT_NEAR(p.x, kSigns[i][0] / growth, .001) << growth;
      EXPECT_NEAR(p.y, kSigns[i][1] / growth, .001) << growth;
    }
  }
}

/// A plane, or two that meet in a ridge between the corners, lies before the end of the beam, also
/// where that is wider than its rays.
TEST(BeamFrame, EndsBehindWhatItsCornersMet) {
  Random random(3);
  int beams = 0;
  for (int i = 0; i < 3000; ++i) {
    const double slant = random.in(0, 80) * std::numbers::pi / 180;
    const double turn = random.in(0, 7);
    Vector normal{static_cast<float>(std::sin(slant) * std::cos(turn)),
                  static_cast<float>(std::sin(slant) * std::sin(turn)),
                  static_cast<float>(std::cos(slant))};
    // the ridge goes along y through the middle: what is right of it mirrors the left half
    const bool ridge = i % 2 == 1;
    Beam b = square_beam(0, static_cast<float>(random.log_in(1e-3, .03)));
    b.growth = kGrowths[i % 3];
    BeamFrame f;
    ASSERT_TRUE(frame_of(b, f));
    const auto normal_at = [&](float x) {
      return ridge && x > 0 ? Vector{-normal.x, normal.y, normal.z} : normal;
    };
    const auto depth = [&](float x, float y) {
      const Vector dir = f.axis + x * f.right + y * f.up;
      return dot(Vector{0, 0, -1}, normal_at(x)) / dot(dir, normal_at(x));
    };
    CornerSurfaces s{};
    for (int k = 0; k < kCorners; ++k) {
      const auto [x, y] = kSigns[k];
      s[k].normal = normal_at(x);
      const float w = depth(x / b.growth, y / b.growth);
      s[k].point = (w / dot(b.dir[k], f.unit)) * b.dir[k];
    }
    const float far = farthest_hit(f, s);
    float deepest = 0;
    bool before = true;
    for (const auto [x, y] : kSigns) {
      before &= depth(x, y) > 0;
      deepest = std::max({deepest, depth(x, y), depth(x / b.growth, y / b.growth)});
    }
    if (!before)
      continue;
    ++beams;
    ASSERT_LT(deepest, far) << i;
    ASSERT_LT(far, 1.001f * deepest) << i;
  }
  EXPECT_GT(beams, 2000);
}

}  // namespace
}  // namespace grelha::test
