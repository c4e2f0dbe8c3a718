#include "kernel/perspective/seen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha {
namespace {

constexpr double kMostTiles = 4096;  ///< along an axis of a face

}  // namespace

WindowRows::WindowRows() {
  for (int k = 0; k < kOutlines; ++k) {
    for (int j = 0; j < 2; ++j) {
      lo[j][k] = 1e300;
      hi[j][k] = -1e300;
      across[j][k] = 0;
    }
    near[k] = 1e300;
    area[k] = 0;
  }
}

void Window::add(const Window& w) {
  for (int j = 0; j < 2; ++j) {
    lo[j] = std::min(lo[j], w.lo[j]);
    hi[j] = std::max(hi[j], w.hi[j]);
    across[j] += w.across[j];
  }
  near = std::min(near, w.near);
  seen += w.seen;
  large += w.large;
  area += w.area;
}

void Window::add(const WindowRows& w) {
  for (int k = 0; k < kOutlines; ++k) {
    for (int j = 0; j < 2; ++j) {
      lo[j] = std::min(lo[j], w.lo[j][k]);
      hi[j] = std::max(hi[j], w.hi[j][k]);
      across[j] += w.across[j][k];
    }
    near = std::min(near, w.near[k]);
    area += w.area[k];
  }
  seen += w.seen;
  large += w.large;
}

double Window::most_references(const PointFace& f) const {
  const double all = static_cast<double>(large) * (f.nx * f.ny + 1);
  return all + area * f.per_u * f.per_v + across[0] * f.per_u + across[1] * f.per_v +
         static_cast<double>(seen);
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

void set_place(OutlineBlock& block, std::uint32_t k, const SeenOutline& seen, const Tile& t) {
  const bool beyond = t.width == 0;  // places mean nothing there
  const float x = static_cast<float>(t.x - seen.anchor.x);
  const float y = static_cast<float>(t.y - seen.anchor.y);
  const float width = static_cast<float>(t.width);
  for (int i = 0; i < 3; ++i) {
    const float* const s = seen.side[i];
    const float at_corner = s[2] + (s[0] * x + s[1] * y);
    block.side[i][0][k] = beyond ? 0 : s[0] * width;
    block.side[i][1][k] = beyond ? 0 : s[1] * width;
    block.side[i][2][k] = beyond ? 1 : at_corner;
  }
  block.near[k] = seen.near;
  block.far[k] = beyond ? std::numeric_limits<float>::infinity() : seen.far;
  block.id[k] = seen.id;
}

void set_place(BoxBlock& block, std::uint32_t k, const SeenBox& seen, const Tile& t) {
  const double at[2] = {t.x - seen.anchor.x, t.y - seen.anchor.y};
  const double all = t.width == 0 ? 2 : 0;  // beyond all tiles: wherever it is
  for (int j = 0; j < 2; ++j) {
    const double lo = std::max(-1., (seen.lo[j] - at[j]) * t.columns - all);
    const double hi = std::min(2., (seen.hi[j] - at[j]) * t.columns + all);
    // twice what floats of at most 2 round by
    block.lo[j][k] = static_cast<float>(lo - kPlaceRounding);
    block.hi[j][k] = static_cast<float>(hi + kPlaceRounding);
  }
  block.near[k] = seen.near;
  block.id[k] = seen.id;
}

}  // namespace grelha
