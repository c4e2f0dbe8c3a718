#pragma once
// A picture whose samples are spent by error, see RefineOptions: rendered bit by bit, interrupted,
// saved, gone on with, to the bits of one that was rendered in one go. docs/sampling.md has the
// derivations.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/world.hpp"
#include "kernel/base/pages.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/shade/guarded_progress.hpp"

namespace grelha {

/// Side of a block of pixels whose samples are taken together: a packet is full even if each pixel
/// takes few samples.
inline constexpr int kBlockSide = 4;
inline constexpr int kBlockPixels = kBlockSide * kBlockSide;

/// A picture in blocks, row by row; those at its right and lower edges may have fewer pixels.
struct Blocks {
  int width, height;  ///< pixels
  int columns, rows;

  Blocks(int of_width, int of_height)
      : width(of_width),
        height(of_height),
        columns((of_width + kBlockSide - 1) / kBlockSide),
        rows((of_height + kBlockSide - 1) / kBlockSide) {}

  std::size_t count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  std::size_t of(int x, int y) const {
    return static_cast<std::size_t>(y / kBlockSide) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x / kBlockSide);
  }
  std::size_t of_pixel(std::size_t p) const {
    const auto w = static_cast<std::size_t>(width);
    return of(static_cast<int>(p % w), static_cast<int>(p / w));
  }

  /// Calls visit(pixel) for those of a block, along a Z.
  template <class Visit>
  void each_pixel(std::size_t block, const Visit& visit) const {
    const auto c = static_cast<std::size_t>(columns);
    const int x0 = static_cast<int>(block % c) * kBlockSide;
    const int y0 = static_cast<int>(block / c) * kBlockSide;
    for (int k = 0; k < kBlockPixels; ++k) {
      const int x = x0 + tile_x(k), y = y0 + tile_y(k);
      if (x < width && y < height)
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(x));
    }
  }
  std::size_t pixels(std::size_t block) const {
    std::size_t count = 0;
    each_pixel(block, [&](std::size_t) { ++count; });
    return count;
  }

  /// All blocks, tile by tile: those that follow each other share packets and cells of grids.
  std::vector<std::uint32_t> by_tiles() const {
    constexpr int kOfTile = kTile / kBlockSide;
    std::vector<std::uint32_t> order;
    reserve_to_fill(order, count());
    for (int ty = 0; ty < rows; ty += kOfTile)
      for (int tx = 0; tx < columns; tx += kOfTile)
        for (int k = 0; k < kOfTile * kOfTile; ++k) {
          const int x = tx + k % kOfTile, y = ty + k / kOfTile;
          if (x < columns && y < rows)
            order.push_back(static_cast<std::uint32_t>(of(x * kBlockSide, y * kBlockSide)));
        }
    return order;
  }
};

inline constexpr int kMostLog = 16;
static_assert(1 << kMostLog == kMostSamples);
/// Logarithm of the samples that a pixel begins with: two packets a block, and a difference of
/// eighths in each pixel.
inline constexpr int kFirstLog = 3;
static_assert(1 << kFirstLog == kLeastMost);
/// Times that a round doubles a block at most: consecutive samples of a pixel share packets.
inline constexpr int kMostDoublings = 3;

/// Results of checks of a picture's error: sums over the blocks that checks doubled, each times the
/// number of blocks it stands for. The squared difference of a block's old and new halves tells
/// what the old samples were worth, without a model: E[(A - B)^2] / 4 = V(n) - V(2n).
struct CheckSums {
  /// of blocks whose samples differed: squared errors y and claimed variances x, and their products
  double y = 0, x = 0, yy = 0, xy = 0, xx = 0;
  /// of blocks whose samples agreed, which claim nothing: n y, its square, pixels
  double ny = 0, nyny = 0, count = 0;

  /// Gives all sums so far a weight.
  void weigh(double weight) {
    for (double* const sum : {&y, &x, &yy, &xy, &xx, &ny, &nyny, &count})
      *sum *= weight;
  }
  /// Factor of the variance over what blocks claim.
  double ratio() const;
  /// Variance of one sample where samples agree.
  double by_sample() const { return count > 0 ? ny / count : 0; }
};

/// A block that a check doubles.
struct CheckedBlock {
  std::uint32_t block;
  float claim;       ///< variance of a pixel that it claimed before; 0: its samples agreed
  float stands_for;  ///< so many blocks
};

/// All that is known of a picture between two pieces of its work.
///
/// Every pixel starts with 2^kFirstLog samples; each round then doubles those of the blocks whose
/// variance would fall most for each new ray. A pixel's samples are one Owen-scrambled sequence:
/// E[(A - B)^2] / 4 of the means A, B of its halves is V(n/2) - V(n), without a model; that V falls
/// by `variance_ratio` a doubling, measured over the picture, gives V(n).
///
/// The rounds that end nothing are the same whatever error, samples or seconds are asked for. From
/// the first other round on the picture is `limited`.
struct Refinement {
  int width = 0;
  int height = 0;
  std::vector<std::int64_t> sums;  ///< [pixels][3] linear RGB, units of 2^-32
  /// [pixels][3] squared differences of halves, quarters, eighths, summed by level
  std::array<std::vector<float>, 3> squares;
  std::vector<std::uint32_t> box;  ///< [pixels] that target rays hit, see PixelBox; 0: none
  /// [blocks] variance that things with boxes may add, until the block has samples in those
  std::vector<float> missed;
  std::vector<float> cost;  ///< [blocks] rays a sample takes, of the chunk last sampled with it
  /// [blocks] log2 of the samples of each pixel; 0: none yet
  std::vector<std::uint8_t> log;
  /// [blocks] the same once the round in work is done
  std::vector<std::uint8_t> goal;
  /// blocks that the round in work has not reached yet, in its order; empty between rounds
  std::vector<std::uint32_t> wanted;
  std::vector<CheckedBlock> checking;  ///< blocks of the check in work; empty: it is none
  /// over the last rounds, sums of squared differences of halves: of all samples, of the new ones
  double variance_drop = 0;
  double variance_level = 0;
  double round_drop = 0, round_level = 0;  ///< the same of the round in work
  float variance_ratio = .4f;              ///< V(n) / V(n/2)
  CheckSums checked;                       ///< results of checks
  int checks = 0;                          ///< of the picture's error
  int repeats = 0;                         ///< checks since the last round that was none
  std::uint64_t checked_at = 0;            ///< samples there were at the last one
  std::uint64_t check_samples = 0;         ///< that checks took
  int rounds = 0;                          ///< done, without checks
  Limit limit = Limit::kNone;  ///< that ended the picture, or ends it after the round in work
  bool limited = false;
  bool finished = false;
  std::uint64_t rays = 0;  ///< sent so far
  double forecast = 0;     ///< rays that the whole picture takes, as far as is known
  double seconds = 0;      ///< spent so far
  double share = 0;        ///< of the way to the target, as far as is known
  /// the picture before it was limited, where RefineOptions::refinable asks for it: one at most
  std::vector<Refinement> before;

  Blocks blocks() const { return {width, height}; }
};

/// Samples that each pixel of a block has.
inline std::uint32_t sample_count(const Refinement& r, std::size_t block) {
  return r.log[block] == 0 ? 0 : 1u << r.log[block];
}

/// Mean of `samples` samples, of channel i % 3 of pixel i / 3.
inline float mean_so_far(const Refinement& r, std::size_t i, std::uint32_t samples) {
  return static_cast<float>(static_cast<double>(r.sums[i]) /
                            (kLightUnit * static_cast<double>(samples)));
}

/// A picture without samples.
Refinement make_refinement(const Camera& camera);

/// Goes on until the target is met, see Picture::advance(). Returns true if it is. `stats.error`
/// and `maps`, where given, describe the picture so far; other counts are of this call. Throws like
/// render().
bool refine(const World& world,
            const Camera& camera,
            const RenderOptions& options,
            Refinement& r,
            RenderStats& stats,
            SampleMaps* maps = nullptr,
            const ShouldContinue& should_continue = {});

/// True if the sizes of the arrays match and rendering can produce every number. Check a loaded
/// file with this before going on with it.
bool is_valid(const Refinement& r);

/// Goes back to what the picture was before it was limited, so that other limits go on from there.
/// Returns false if that was not kept.
bool lift_limits(Refinement& r);

/// Number of samples taken, over all pixels.
std::uint64_t total_samples(const Refinement& r);

/// The picture so far; pixels without samples are black.
Image picture_so_far(const Refinement& r);

}  // namespace grelha
