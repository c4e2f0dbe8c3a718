#include "kernel/perspective/seen.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Of n parts the one that holds x, or the nearest.
int clamped(double x, int n) {
  if (!(x > 0))
    return 0;
  return std::min(static_cast<int>(std::min(x, static_cast<double>(n))), n - 1);
}

void scale_side(HalfPlane& s, const PointFace& f) {
  const double size = std::abs(s.a) + std::abs(s.b) + std::abs(s.c);
  s.c += s.a * f.u + s.b * f.v;
  s.a /= f.per_u;
  s.b /= f.per_v;
  const double across = std::abs(s.a) + std::abs(s.b);
  const double margin = s.margin + kLookUp * size + kSideRounding * across;
  const double scale = margin > 0 ? 1 / margin : 0;
  s.a *= scale;
  s.b *= scale;
  s.c = s.c * scale + 1;
}

}  // namespace

void Seen::to_tiles(const PointFace& f) {
  const double per[2] = {f.per_u, f.per_v}, at[2] = {f.u, f.v};
  for (int j = 0; j < 2; ++j) {
    outline.lo[j] = (outline.lo[j] - at[j] - kLookUp) * per[j] - kPlaceRounding;
    outline.hi[j] = (outline.hi[j] - at[j] + kLookUp) * per[j] + kPlaceRounding;
  }
  for (HalfPlane& s : outline.side)
    scale_side(s, f);
  outline.near -= f.depth;
  outline.far -= f.depth;
}

int TileWalk::row_of(double y) const {
  return clamped((y - raster_.y) / raster_.width, raster_.rows);
}

TileRun TileWalk::run_of(const Seen& seen, int row) const {
  const double below = raster_.y + row * raster_.width - slack_[1];
  const double above = raster_.y + (row + 1) * raster_.width + slack_[1];
  double lo = seen.outline.lo[0];
  double hi = seen.outline.hi[0];
  for (const HalfPlane& s : seen.outline.side) {
    const double c = s.c + s.b * (s.b > 0 ? above : below);
    if (s.a > 0)
      lo = std::max(lo, -c / s.a - slack_[0]);
    else if (s.a < 0)
      hi = std::min(hi, -c / s.a + slack_[0]);
    else if (c < 0)
      return {0, 0};
  }
  const double end = raster_.x + raster_.columns * raster_.width + slack_[0];
  if (!(lo <= hi) || hi < raster_.x - slack_[0] || lo > end)
    return {0, 0};
  return {
      clamped((lo - raster_.x) / raster_.width, raster_.columns),
      clamped((hi - raster_.x) / raster_.width, raster_.columns) + 1,
  };
}

}  // namespace grelha
