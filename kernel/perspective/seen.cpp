#include "kernel/perspective/seen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/perspective/tolerances.hpp"
#include "kernel/primitive/rounding.hpp"

namespace grelha {
namespace {

/// Of n parts the one that holds x, or the nearest.
int clamped(double x, int n) {
  if (!(x > 0))
    return 0;
  return std::min(static_cast<int>(std::min(x, static_cast<double>(n))), n - 1);
}

Anchor anchor_of(const PointFace& face, const Bounds& seen) {
  const auto along = [](double x, double n) {
    return static_cast<std::uint16_t>(clamped(x, std::max(static_cast<int>(n), 1)));
  };
  return {along(seen.lo[0], face.nx), along(seen.lo[1], face.ny)};
}

/// Tiles that lists tell a primitive's place over, along the longer axis.
double span_of(const PointFace& face, const Bounds& seen) {
  const Anchor from = anchor_of(face, seen);
  const double x = std::min(seen.hi[0], face.nx) - from.x;
  const double y = std::min(seen.hi[1], face.ny) - from.y;
  return std::max(std::max(x, y), 1.);
}

/// A face's corner, and how wide its tiles are.
struct FaceTiles {
  double u, v, width, height;
};

void scale_side(const FaceTiles& f, double rounding, HalfPlane& s) {
  s.c += s.a * f.u + s.b * f.v;
  s.a *= f.width;
  s.b *= f.height;
  const double across = std::abs(s.a) + std::abs(s.b);
  const double margin = s.margin + rounding * across;
  const double scale = margin > 0 ? 1 / margin : 0;
  s.a *= scale;
  s.b *= scale;
  s.c = s.c * scale + 1;
}

}  // namespace

void to_tiles(const PointFace& f, Bounds& o) {
  const double per[2] = {f.per_u, f.per_v}, at[2] = {f.u, f.v};
  for (int j = 0; j < 2; ++j) {
    o.lo[j] = (o.lo[j] - at[j]) * per[j] - kPlaceRounding;
    o.hi[j] = (o.hi[j] - at[j]) * per[j] + kPlaceRounding;
  }
  o.near -= f.depth;
  o.far -= f.depth;
}

void to_tiles(const PointFace& f, Outline& o) {
  to_tiles(f, static_cast<Bounds&>(o));
  const FaceTiles tiles{
      f.u,
      f.v,
      1 / f.per_u,
      1 / f.per_v,
  };
  const double rounding = kOutlineRounding * (1 + kSpanRounding * span_of(f, o));
  for (HalfPlane& s : o.side)
    scale_side(tiles, rounding, s);
}

SeenOutline::SeenOutline(const PointFace& face, const Outline& seen, std::uint32_t of)
    : near(float_not_above(seen.near)),
      far(seen.solid ? float_not_below(seen.far) : std::numeric_limits<float>::infinity()),
      id(of),
      anchor(anchor_of(face, seen)) {
  for (int i = 0; i < 3; ++i) {
    const HalfPlane& s = seen.side[i];
    side[i][0] = static_cast<float>(s.a);
    side[i][1] = static_cast<float>(s.b);
    side[i][2] = static_cast<float>(s.c + (s.a * anchor.x + s.b * anchor.y));
  }
}

SeenBox::SeenBox(const PointFace& face, const Bounds& seen, std::uint32_t of)
    : near(float_not_above(seen.near)), id(of), anchor(anchor_of(face, seen)) {
  const double at[2] = {double(anchor.x), double(anchor.y)};
  for (int j = 0; j < 2; ++j) {
    lo[j] = float_not_above(seen.lo[j] - at[j]);
    hi[j] = float_not_below(seen.hi[j] - at[j]);
  }
}

int TileWalk::row_of(double y) const {
  return clamped((y - raster_.y) * squares_, raster_.rows);
}

TileRun TileWalk::run_between(double lo, double hi) const {
  const double end = raster_.x + raster_.columns * raster_.width + kPlaceRounding;
  if (!(lo <= hi) || hi < raster_.x - kPlaceRounding || lo > end)
    return {0, 0};
  return {
      clamped((lo - raster_.x) * squares_, raster_.columns),
      clamped((hi - raster_.x) * squares_, raster_.columns) + 1,
  };
}

TileRun TileWalk::run_of(const Outline& seen, int row) const {
  const double below = raster_.y + row * raster_.width - kPlaceRounding;
  const double above = raster_.y + (row + 1) * raster_.width + kPlaceRounding;
  double lo = seen.lo[0];
  double hi = seen.hi[0];
  for (const HalfPlane& s : seen.side) {
    const double c = s.c + s.b * (s.b > 0 ? above : below);
    if (s.a > 0)
      lo = std::max(lo, -c / s.a - kPlaceRounding);
    else if (s.a < 0)
      hi = std::min(hi, -c / s.a + kPlaceRounding);
    else if (c < 0)
      return {0, 0};
  }
  return run_between(lo, hi);
}

}  // namespace grelha
