#include "kernel/adaptive/pixel_features.hpp"

#include "kernel/marks/glows.hpp"
#include "kernel/marks/small_things.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

constexpr int kBouncesWatched = 2;  ///< mirrors
/// Of more lights samples tell sooner whether they shine evenly beside an edge than beams do
/// (measured: with 32 that takes .4 of the time, with 1 to 3 between .9 and 1.1).
constexpr int kLightsWatched = 4;

std::size_t pixel_at(const Refinement& r, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(r.width) +
         static_cast<std::size_t>(x);
}

/// Pixels of a tile, a bit each.
struct TilePixels {
  std::uint64_t agree = 0;  ///< those whose samples agree
  std::uint64_t edges = 0;  ///< that differ from those around, and are left to samples
  PixelsAsked asked;
};

/// The picture when its first samples are there, and what looks for what they missed.
struct Search {
  const World::Impl& world;
  const Setup& setup;
  const PixelErrors& errors;
  const SmallThings& things;
  const Glows& glows;
  const float faint;  ///< differences to pixels around that show no edge
  const float dear;   ///< such from which on samples take longer than beams
  const float least;  ///< weight of light that is followed
  Refinement& r;

  /// What pixel i of a tile, (x, y), is asked.
  void ask(int x, int y, int i, TilePixels& of) const {
    const std::uint64_t bit = std::uint64_t{1} << i;
    if (errors.agrees(pixel_at(r, x, y)))
      ask_agreeing(x, y, i, of);
    else
      ask_varying(x, y, i, of);
    if (of.asked.lights[i] != 0)
      of.asked.shadows |= bit;
  }

  void ask_agreeing(int x, int y, int i, TilePixels& of) const {
    const std::uint64_t bit = std::uint64_t{1} << i;
    const float contrast = errors.contrast(x, y);
    const bool lit_by_few = world.shading.light_count <= kLightsWatched;
    const bool watched = contrast > dear && lit_by_few;
    of.agree |= bit;
    if (contrast > faint && !watched)
      of.edges |= bit;
    if (contrast > dear || things.thin.has(x, y))
      of.asked.things |= bit;
    of.asked.lights[i] = watched ? ~std::uint64_t{0} : things.lights(x, y);
    if (things.mirrored)
      of.asked.if_bent |= bit;
  }

  /// Where samples vary only what is small is missed for long.
  void ask_varying(int x, int y, int i, TilePixels& of) const {
    const std::uint64_t bit = std::uint64_t{1} << i;
    if (things.small.has(x, y)) {
      of.asked.things |= bit;
      of.asked.lights[i] = ~std::uint64_t{0};
    }
    if (things.stand_alone)
      of.asked.if_bent |= bit;
  }

  TilePixels pixels_of(int x0, int y0) const {
    TilePixels of;
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = x0 + i % kTile;
      const int y = y0 + i / kTile;
      if (x < r.width && y < r.height)
        ask(x, y, i, of);
    }
    return of;
  }

  /// The tile whose upper left pixel is (x0, y0).
  void search_tile(int x0, int y0, TraceCounts& counts) const {
    const TilePixels of = pixels_of(x0, y0);
    PixelDoubts found;
    setup.variant.loops.doubt(world.view,
                              world.shading,
                              setup.frame,
                              x0,
                              y0,
                              kBouncesWatched,
                              least,
                              of.asked,
                              found,
                              counts);
    for (int i = 0; i < kTile * kTile; ++i) {
      if (!((of.agree | of.asked.things | of.asked.shadows | of.asked.if_bent) >> i & 1))
        continue;
      const std::size_t p = pixel_at(r, x0 + i % kTile, y0 + i / kTile);
      // Where samples vary, what they vary by may be all there is, but for what is so small that it
      // has a box. Should they agree later, the pixels around tell.
      if (setup.frame.lens) {  // it is not where the middle of the lens sees it
        found.inside[i] = std::max(found.inside[i], found.boxed[i]);
      } else {
        r.boxed[p] = found.boxed[i];
        r.box[p] = found.box[i];
      }
      if (!(of.agree >> i & 1))
        continue;
      r.inside[p] = found.inside[i];
      r.around[p] = of.edges >> i & 1 ? 1 : found.around[i];
    }
    add_glows(x0, y0);
  }

  /// Where samples vary, a lamp shows more than they do.
  void add_glows(int x0, int y0) const {
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = x0 + i % kTile;
      const int y = y0 + i / kTile;
      if (x < r.width && y < r.height)
        r.inside[pixel_at(r, x, y)] = std::max(r.inside[pixel_at(r, x, y)], glows.brightest(x, y));
    }
  }
};

}  // namespace

void find_hidden_features(const World::Impl& world,
                          const Setup& setup,
                          const PixelErrors& errors,
                          double error,
                          int threads,
                          Refinement& r,
                          TraceCounts& counts) {
  const SmallThings things(world, setup, threads, counts);
  const Glows glows(world, setup, error * kFaintGlow);
  const float faint = PixelErrors::faint(error);
  const float dear = PixelErrors::dear(error);
  const Search search{world, setup, errors, things, glows, faint, dear, errors.forgiven(error), r};
  const int columns = (r.width + kTile - 1) / kTile;
  const int rows = (r.height + kTile - 1) / kTile;
  Thrown thrown;
#pragma omp parallel num_threads(threads)
  {
    TraceCounts mine;
#pragma omp for schedule(dynamic, 4)
    for (int tile = 0; tile < columns * rows; ++tile)
      thrown.in([&] { search.search_tile(tile % columns * kTile, tile / columns * kTile, mine); });
#pragma omp critical(grelha_stats)
    counts += mine;
  }
  thrown.on();
}

}  // namespace grelha
