#include "kernel/grid/distance_field.hpp"

#include <algorithm>

#include "kernel/grid/grid.hpp"

namespace grelha {
namespace {

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
    const std::uint8_t *const a = below ? below : above, *const b = above ? above : below;
    const auto least = static_cast<std::uint8_t>(k);
    std::uint8_t most = 0;
    for (std::ptrdiff_t x = 0; x < nx; ++x) {
      const std::uint8_t near = std::max(least, std::min(a[x], b[x]));
      to[x] = std::min(to[x], near);
      most = std::max(most, to[x]);
    }
    if (most <= k + 1)
      return;  // what is farther away can better nothing
  }
}

}  // namespace

void chebyshev_distance(std::vector<std::uint8_t>& d,
                        const std::array<std::uint32_t, 3>& cells,
                        int threads) {
  const std::ptrdiff_t nx = cells[0], ny = cells[1], nz = cells[2];
  std::vector<std::uint8_t> other(d.size());
#pragma omp parallel num_threads(threads)
  {
#pragma omp for schedule(static)
    for (std::ptrdiff_t z = 0; z < nz; ++z) {  // along x by two sweeps, then along y
      std::uint8_t* const slice = d.data() + z * nx * ny;
      for (std::ptrdiff_t y = 0; y < ny; ++y) {
        std::uint8_t* const row = slice + y * nx;
        for (std::ptrdiff_t x = 1; x < nx; ++x)
          row[x] = static_cast<std::uint8_t>(std::min<int>(row[x], row[x - 1] + 1));
        for (std::ptrdiff_t x = nx - 1; x-- > 0;)
          row[x] = static_cast<std::uint8_t>(std::min<int>(row[x], row[x + 1] + 1));
      }
      for (std::ptrdiff_t y = 0; y < ny; ++y)
        nearest_along(slice + y * nx, other.data() + (z * ny + y) * nx, nx, nx, y, ny);
    }
#pragma omp for schedule(static)
    for (std::ptrdiff_t y = 0; y < ny * nz; ++y)
      nearest_along(other.data() + y * nx, d.data() + y * nx, nx, nx * ny, y / ny, nz);
  }
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
