#pragma once
// Doubt of the pixels of a tile.

#include <bit>

#include "kernel/features/doubt.hpp"
#include "kernel/scene/pixel_box.hpp"

namespace grelha::GRELHA_ISA {

/// From the eye through the place (x, y) of the picture.
inline Vec3f direction_through(const FrameView& f, float x, float y) {
  const float sx = x - .5f * static_cast<float>(f.width);
  const float sy = .5f * static_cast<float>(f.height) - y;
  const auto along = [&](int axis) {
    return (f.forward[axis] + sx * f.right[axis]) + sy * f.up[axis];
  };
  return normalize(Vec3f{along(0), along(1), along(2)});
}

/// Beam through the square of `size` pixels at (x0, y0), grown a little about its centre: what only
/// touches its edge counts as well.
inline Beam pixel_beam(const FrameView& f, int x0, int y0, int size) {
  const float half = .5f * static_cast<float>(size);
  const float x = static_cast<float>(x0) + half;
  const float y = static_cast<float>(y0) + half;
  const float reach = (size > 1 ? kSquareGrowth : kPixelGrowth) * half;
  constexpr float kSign[kCorners][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    b.org[i] = {f.eye[0], f.eye[1], f.eye[2]};
    b.dir[i] = direction_through(f, x + kSign[i][0] * reach, y + kSign[i][1] * reach);
  }
  return b;
}

/// Bits of the pixels of a tile of 8 x 8 at a corner of which something clear shows, or a mirror of
/// weight `least`.
inline std::uint64_t bent_pixels(const SceneView& scene,
                                 const ShadingView& shading,
                                 const FrameView& f,
                                 int x0,
                                 int y0,
                                 float least,
                                 Counters& n) {
  constexpr int kSide = kTile + 1;
  bool bent[kSide * kSide];
  for (int first = 0; first < kSide * kSide; first += kTile * kTile) {
    Packet<InFloat> p;
    p.size = first == 0 ? kTile * kTile : kSide * kSide - kTile * kTile;
    for (int i = 0; i < p.size; ++i) {
      const float x = static_cast<float>(x0 + (first + i) % kSide);
      const float y = static_cast<float>(y0 + (first + i) / kSide);
      set_ray(p, i, {f.eye[0], f.eye[1], f.eye[2]}, direction_through(f, x, y), kInfinity);
    }
    trace_packet<false>(scene, p, {p.size, true}, n);
    for (int i = 0; i < p.size; ++i)
      bent[first + i] =
          id_of(p.id[i]) != kNoPrimitive && is_bent(scene, shading, id_of(p.id[i]), least);
  }
  std::uint64_t bits = 0;
  for (int y = 0; y < kTile; ++y)
    for (int x = 0; x < kTile; ++x) {
      const bool* const at = bent + y * kSide + x;
      if (at[0] || at[1] || at[kSide] || at[kSide + 1])
        bits |= std::uint64_t{1} << (y * kTile + x);
    }
  return bits;
}

/// What of a pixel a box of its beam is, with room for what bends light on the way.
inline std::uint32_t box_of_pixel(const BeamBox& box) {
  if (!(box.lo[0] <= box.hi[0]))
    return 0;
  float lo[2], hi[2];
  for (int j = 0; j < 2; ++j) {
    const float room = kBoxRoom + kBoxGrowth * (box.hi[j] - box.lo[j]);
    lo[j] = .5f + .5f * kPixelGrowth * (box.lo[j] - room);
    hi[j] = .5f + .5f * kPixelGrowth * (box.hi[j] + room);
  }
  return packed({lo[0], lo[1], hi[0], hi[1]});
}

/// Sets the doubt of the pixels of a square.
inline void set_square(PixelDoubts& of, int first, int size, const Doubt& doubt) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int i = first + y * kTile + x;
      of.inside[i] = doubt.inside;
      of.around[i] = doubt.around;
      of.box[i] = box_of_pixel(doubt.box);
      of.boxed[i] = of.box[i] != 0 ? doubt.boxed : 0;
    }
}

/// Bits of the pixels of a square.
inline std::uint64_t square_bits(int first, int size) {
  const std::uint64_t row = ~std::uint64_t{0} >> (64 - size);
  std::uint64_t bits = 0;
  for (int y = 0; y < size; ++y)
    bits |= row << (first + y * kTile);
  return bits;
}

/// The lights that some pixels are asked about.
inline std::uint64_t lights_of(const PixelsAsked& asked, std::uint64_t bits) {
  std::uint64_t lights = 0;
  for (std::uint64_t left = asked.shadows & bits; left != 0; left &= left - 1)
    lights |= asked.lights[std::countr_zero(left)];
  return lights;
}

/// Doubt of the pixels of an 8 x 8 tile that are asked. Squares that are plain as a whole save
/// their parts.
inline void tile_doubt(Watcher& watcher,
                       const FrameView& f,
                       int x0,
                       int y0,
                       int size,
                       int bounces,
                       const PixelsAsked& asked,
                       PixelDoubts& found) {
  const int first = y0 % kTile * kTile + x0 % kTile;
  const std::uint64_t bits = square_bits(first, size);
  if (((asked.things | asked.shadows | asked.if_bent) & bits) == 0)
    return;
  const LookFor look{(asked.things & bits) != 0, lights_of(asked, bits)};
  const Doubt doubt =
      watcher.doubt(pixel_beam(f, x0, y0, size), size > 1, {bounces, kClearsFollowed}, 1, look);
  if (size == 1 || doubt.none()) {
    set_square(found, first, size, doubt);
    return;
  }
  const int h = size / 2;
  for (int i = 0; i < 4; ++i)
    tile_doubt(watcher, f, x0 + i % 2 * h, y0 + i / 2 * h, h, bounces, asked, found);
}

}  // namespace grelha::GRELHA_ISA
