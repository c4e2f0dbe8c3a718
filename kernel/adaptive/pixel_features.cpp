#include "kernel/adaptive/pixel_features.hpp"

#include "kernel/query/variants.hpp"

namespace grelha {
namespace {

constexpr int kBouncesWatched = 2;  ///< mirrors

std::size_t pixel_at(const Refinement& r, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(r.width) +
         static_cast<std::size_t>(x);
}

/// Pixels of the tile at (x0, y0) whose samples agree, a bit each.
std::uint64_t agreeing_pixels(const Refinement& r, const PixelErrors& errors, int x0, int y0) {
  std::uint64_t agree = 0;
  for (int i = 0; i < kTile * kTile; ++i) {
    const int x = x0 + i % kTile;
    const int y = y0 + i / kTile;
    if (x < r.width && y < r.height && errors.agrees(pixel_at(r, x, y)))
      agree |= std::uint64_t{1} << i;
  }
  return agree;
}

/// The tile whose upper left pixel is (x0, y0).
void search_tile(const World::Impl& world,
                 const Setup& setup,
                 const PixelErrors& errors,
                 int x0,
                 int y0,
                 Refinement& r,
                 TraceCounts& counts) {
  const std::uint64_t agree = agreeing_pixels(r, errors, x0, y0);
  if (agree == 0)
    return;
  float inside[kTile * kTile], around[kTile * kTile];
  setup.variant.loops.doubt(world.view,
                            world.shading,
                            setup.frame,
                            x0,
                            y0,
                            kBouncesWatched,
                            agree,
                            inside,
                            around,
                            counts);
  for (int i = 0; i < kTile * kTile; ++i) {
    // what varies was met; should it agree later, its neighbours tell
    if (!(agree >> i & 1))
      continue;
    const std::size_t p = pixel_at(r, x0 + i % kTile, y0 + i / kTile);
    r.inside[p] = inside[i];
    r.around[p] = around[i];
  }
}

}  // namespace

void find_hidden_features(const World::Impl& world,
                          const Setup& setup,
                          const PixelErrors& errors,
                          int threads,
                          Refinement& r,
                          TraceCounts& counts) {
  const int columns = (r.width + kTile - 1) / kTile;
  const int rows = (r.height + kTile - 1) / kTile;
#pragma omp parallel num_threads(threads)
  {
    TraceCounts mine;
#pragma omp for schedule(dynamic, 4)
    for (int tile = 0; tile < columns * rows; ++tile)
      search_tile(world, setup, errors, tile % columns * kTile, tile / columns * kTile, r, mine);
#pragma omp critical(grelha_stats)
    counts += mine;
  }
}

}  // namespace grelha
