#include "kernel/perspective/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/primitive/rounding.hpp"

namespace grelha {
namespace {

constexpr double kMostTiles = 4096;  ///< along an axis of a face

}  // namespace

void Window::add(const Window& w) {
  for (int j = 0; j < 2; ++j) {
    lo[j] = std::min(lo[j], w.lo[j]);
    hi[j] = std::max(hi[j], w.hi[j]);
  }
  near = std::min(near, w.near);
  seen += w.seen;
}

void Window::add(const Outline& o) {
  add(Window{
      {o.lo[0], o.lo[1]},
      {o.hi[0], o.hi[1]},
      o.near,
      1,
  });
}

void Window::lay_tiles(PointFace& face, double tiles) const {
  double size[2];
  for (int j = 0; j < 2; ++j)
    size[j] = std::max(hi[j] - lo[j], 0x1p-40) * (1 + 0x1p-10);
  const double edge = std::sqrt(size[0] * size[1] / std::max(tiles, 1.));
  const double most = std::clamp(std::ceil(tiles), 1., kMostTiles);
  face.nx = std::clamp(std::round(size[0] / edge), 1., most);
  face.ny = std::clamp(std::round(size[1] / edge), 1., most);
  face.u = lo[0] - size[0] * 0x1p-12;
  face.v = lo[1] - size[1] * 0x1p-12;
  face.per_u = face.nx / size[0];
  face.per_v = face.ny / size[1];
}

float least_depth(const Seen& seen) {
  return float_not_above(seen.outline.near);
}

void set_outline(OutlineBlock& block, std::uint32_t k, const Seen& seen, const Tile& t) {
  const bool beyond = t.width == 0;  // places mean nothing there
  for (int i = 0; i < 3; ++i) {
    const HalfPlane& s = seen.outline.side[i];
    const double at_corner = s.c + (s.a * t.x + s.b * t.y);
    block.side[i][0][k] = beyond ? 0 : static_cast<float>(s.a * t.width);
    block.side[i][1][k] = beyond ? 0 : static_cast<float>(s.b * t.width);
    block.side[i][2][k] = beyond ? 1 : static_cast<float>(at_corner);
  }
  block.near[k] = least_depth(seen);
  block.far[k] = beyond || !seen.outline.solid ? std::numeric_limits<float>::infinity()
                                               : float_not_below(seen.outline.far);
  block.id[k] = seen.id;
}

void set_box(BoxBlock& block, std::uint32_t k, const Seen& seen, const Tile& t) {
  const double at[2] = {t.x, t.y};
  const bool beyond = t.width == 0;
  const double columns = beyond ? 0 : 1 / t.width;
  for (int j = 0; j < 2; ++j) {
    const double lo = beyond ? -1 : (seen.outline.lo[j] - at[j]) * columns;
    const double hi = beyond ? 2 : (seen.outline.hi[j] - at[j]) * columns;
    block.lo[j][k] = float_not_above(std::max(lo, -1.));
    block.hi[j][k] = float_not_below(std::min(hi, 2.));
  }
  block.near[k] = least_depth(seen);
  block.id[k] = seen.id;
}

}  // namespace grelha
