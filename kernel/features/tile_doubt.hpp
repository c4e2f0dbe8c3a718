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

/// Corners of the square of `size` pixels whose upper left one is (x, y) of its tile.
inline SquareCorners corners_of_square(int x, int y, int size) {
  const int first = y * kCornersARow + x;
  const int down = size * kCornersARow;
  return {{first, first + size, first + down + size, first + down}};
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

/// A square of a tile's pixels: its upper left pixel, from that of the tile, and its side.
struct TileSquare {
  int x, y, size;

  int first() const { return y * kTile + x; }
  std::uint64_t bits() const { return square_bits(first(), size); }
  SquareCorners corners() const { return corners_of_square(x, y, size); }
  TileSquare quarter(int i) const {
    const int half = size / 2;
    return {x + i % 2 * half, y + i / 2 * half, half};
  }
};

/// Pixels that are asked anything.
inline std::uint64_t all_of(const PixelsAsked& asked) {
  return asked.things | asked.shadows | asked.if_bent;
}

/// What the corners of squares that may be looked at are asked.
struct CornersAsked {
  bool any[kTileCorners] = {};
  std::uint64_t lights[kTileCorners] = {};

  void add(const PixelsAsked& asked, const TileSquare& square) {
    if ((all_of(asked) & square.bits()) == 0)
      return;
    const std::uint64_t of = lights_of(asked, square.bits());
    for (const int at : square.corners().at) {
      any[at] = true;
      lights[at] |= of;
    }
    for (int i = 0; square.size > 1 && i < 4; ++i)
      add(asked, square.quarter(i));
  }
};

/// Sends the rays of a tile whose upper left pixel is (x0, y0), from the eye.
inline void trace_tile(
    const FrameView& f, int x0, int y0, const PixelsAsked& asked, CornerField& field) {
  CornersAsked corners;
  corners.add(asked, {0, 0, kTile});
  const Vec3f eye{f.eye[0], f.eye[1], f.eye[2]};
  for (int at = 0; at < kTileCorners; ++at) {
    if (!corners.any[at])
      continue;
    const float x = static_cast<float>(x0 + at % kCornersARow);
    const float y = static_cast<float>(y0 + at / kCornersARow);
    field.set(at, {eye, direction_through(f, x, y)}, corners.lights[at]);
  }
  field.trace();
}

/// Bits of the pixels of a tile at a corner of which something clear shows, or a mirror of weight
/// `least`, of those asked.
inline std::uint64_t bent_pixels(const SceneView& scene,
                                 const ShadingView& shading,
                                 const CornerField& field,
                                 std::uint64_t asked,
                                 float least) {
  std::uint64_t bent = 0;
  for (std::uint64_t left = asked; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    for (const int at : corners_of_square(i % kTile, i / kTile, 1).at)
      if (field.id(at) != kNoPrimitive && is_bent(scene, shading, field.id(at), least))
        bent |= std::uint64_t{1} << i;
  }
  return bent;
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

/// Doubt of the pixels of a square that are asked. Squares that are plain as a whole save their
/// parts. A beam is a little wider than its square: what only touches an edge counts as well.
inline void square_doubt(Watcher& watcher,
                         CornerField& field,
                         const TileSquare& square,
                         int bounces,
                         const PixelsAsked& asked,
                         PixelDoubts& found) {
  const std::uint64_t bits = square.bits();
  if ((all_of(asked) & bits) == 0)
    return;
  const bool whole = square.size > 1;
  const LookFor look{(asked.things & bits) != 0, lights_of(asked, bits)};
  const Doubt doubt = watcher.doubt({field, square.corners(), whole ? kSquareGrowth : kPixelGrowth},
                                    whole,
                                    {bounces, kClearsFollowed},
                                    1,
                                    look);
  if (!whole || doubt.none()) {
    set_square(found, square.first(), square.size, doubt);
    return;
  }
  for (int i = 0; i < 4; ++i)
    square_doubt(watcher, field, square.quarter(i), bounces, asked, found);
}

/// Doubt of the pixels of an 8 x 8 tile that are asked.
inline void tile_doubt(const SceneView& scene,
                       const ShadingView& shading,
                       const FrameView& f,
                       int x0,
                       int y0,
                       int bounces,
                       float least,
                       const PixelsAsked& asked,
                       PixelDoubts& found,
                       Counters& n) {
  Watcher watcher(scene, shading, least, n);
  PixelsAsked of = asked;
  if (!shading.reflects && !shading.refracts)
    of.if_bent = 0;
  if (all_of(of) == 0)
    return;
  CornerField field(scene, shading, n);
  trace_tile(f, x0, y0, of, field);
  of.if_bent = bent_pixels(scene, shading, field, of.if_bent, watcher.least_sent());
  square_doubt(watcher, field, {0, 0, kTile}, bounces, of, found);
}

}  // namespace grelha::GRELHA_ISA
