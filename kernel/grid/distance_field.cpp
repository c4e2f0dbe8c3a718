#include "kernel/grid/distance_field.hpp"

#include <algorithm>

#include "kernel/grid/grid.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

/// Makes a row of `nx` distances no greater than those of the lower of two rows `k` away allow;
/// returns the greatest.
int bring_nearer(std::uint8_t* to,
                 const std::uint8_t* a,
                 const std::uint8_t* b,
                 std::ptrdiff_t nx,
                 std::ptrdiff_t k) {
  const auto least = static_cast<std::uint8_t>(k);
  std::uint8_t most = 0;
  for (std::ptrdiff_t x = 0; x < nx; ++x) {
    const std::uint8_t near = std::max(least, std::min(a[x], b[x]));
    to[x] = std::min(to[x], near);
    most = std::max(most, to[x]);
  }
  return most;
}

/// to[i] = min over k of max(k, from[i - k steps], from[i + k steps]) along one axis, for a row of
/// `nx` lines at once; `at` of `n`.
void nearest_along(const std::uint8_t* from,
                   std::uint8_t* to,
                   std::ptrdiff_t nx,
                   std::ptrdiff_t step,
                   std::ptrdiff_t at,
                   std::ptrdiff_t n) {
  std::copy_n(from, nx, to);
  for (std::ptrdiff_t k = 1; k < 255; ++k) {
    const std::uint8_t* const below = at - k >= 0 ? from - k * step : nullptr;
    const std::uint8_t* const above = at + k < n ? from + k * step : nullptr;
    if (!below && !above)
      return;
    // what is farther away than the farthest can better nothing
    if (bring_nearer(to, below ? below : above, above ? above : below, nx, k) <= k + 1)
      return;
  }
}

/// A row along x, by two sweeps.
void sweep(std::uint8_t* row, std::ptrdiff_t nx) {
  const auto step = [](std::uint8_t& to, std::uint8_t from) {
    to = static_cast<std::uint8_t>(std::min<int>(to, from + 1));
  };
  for (std::ptrdiff_t x = 1; x < nx; ++x)
    step(row[x], row[x - 1]);
  for (std::ptrdiff_t x = nx - 1; x-- > 0;)
    step(row[x], row[x + 1]);
}

}  // namespace

void chebyshev_distance(std::vector<std::uint8_t>& d,
                        const std::array<std::uint32_t, 3>& cells,
                        int threads) {
  const std::ptrdiff_t nx = cells[0];
  const std::ptrdiff_t ny = cells[1];
  const std::ptrdiff_t nz = cells[2];
  std::vector<std::uint8_t> other(d.size());
  const auto along_x_and_y = [&](std::size_t z) {
    const std::ptrdiff_t slice = static_cast<std::ptrdiff_t>(z) * nx * ny;
    for (std::ptrdiff_t y = 0; y < ny; ++y)
      sweep(d.data() + slice + y * nx, nx);
    for (std::ptrdiff_t y = 0; y < ny; ++y)
      nearest_along(d.data() + slice + y * nx, other.data() + slice + y * nx, nx, nx, y, ny);
  };
  const auto along_z = [&](std::size_t slice) {
    const auto z = static_cast<std::ptrdiff_t>(slice);
    for (std::ptrdiff_t row = z * ny; row < (z + 1) * ny; ++row)
      nearest_along(other.data() + row * nx, d.data() + row * nx, nx, nx * ny, z, nz);
  };
  each_turn(cells[2], threads, along_x_and_y);
  each_turn(cells[2], threads, along_z);
}

std::vector<std::uint8_t> chebyshev_distance(const std::vector<std::uint8_t>& occupied,
                                             const std::array<std::uint32_t, 3>& cells) {
  std::vector<std::uint8_t> d(occupied.size());
  for (std::size_t c = 0; c < d.size(); ++c)
    d[c] = occupied[c] ? 0 : 255;
  chebyshev_distance(d, cells, 1);
  return d;
}

}  // namespace grelha
