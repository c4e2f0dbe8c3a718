#pragma once
// Pictures by subdivision: squares that are split where their corners disagree.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "grelha/camera.hpp"
#include "grelha/image.hpp"
#include "grelha/render_options.hpp"
#include "grelha/stats.hpp"
#include "grelha/subdivision.hpp"
#include "grelha/world.hpp"
#include "kernel/shade/guarded_progress.hpp"

namespace grelha {

struct SubdivisionState {
  Image image;                     ///< tiles that are not done are black
  std::vector<std::uint8_t> done;  ///< [tiles] 1: done; see Tiles
  double share = 0;                ///< done
};

/// A picture without points. Throws std::invalid_argument for a size that has no lattice.
SubdivisionState make_subdivision(int width, int height);

/// True if rendering can produce every number. Check a loaded file with this before going on with
/// it.
bool is_valid(const SubdivisionState& s);

// Makes tiles of a picture by subdivision. Knows nothing of rays: whoever makes one says what a
// point sees.

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct TileRect {
  int x0, y0, x1, y1;
};

/// Tiles of a picture, row by row. A point on the border of two is seen by both: no pixel depends
/// on how large they are.
class Tiles {
 public:
  /// `side` pixels a side; 0: from 32 to 8, fewer the deeper squares are split.
  Tiles(const Image& image, const Subdivision& options, int side = 0);
  std::size_t size() const { return rows_ * columns_; }
  TileRect operator[](std::size_t tile) const;

 private:
  int width_, height_, side_;
  std::size_t rows_, columns_;
};

/// Sets the colours of points that are all different, neighbours next to each other.
using TracePoints = std::function<void(std::span<const LatticePoint> points, Float3* colours)>;

/// Throws std::invalid_argument for options out of their range.
void check_subdivision(const Subdivision& options);

/// Makes the pixels of a tile: of each the mean of the four corners of its square, or of its four
/// quarters where it is split.
void subdivide(const TileRect& tile,
               const Subdivision& options,
               const TracePoints& trace,
               Image& image);

/// Goes on with a picture by subdivision, see Picture::advance(). Returns whether it is finished.
/// Threads take tiles as they come. `stats` are of this call. Throws like render().
bool render_subdivided(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       SubdivisionState& picture,
                       RenderStats& stats,
                       const ShouldContinue& should_continue = {});

}  // namespace grelha
