#pragma once
// What is seen of primitives through the faces around a point, in tiles, and as lists hold it.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <new>
#include <vector>

#include "kernel/perspective/tolerances.hpp"
#include "kernel/perspective/view.hpp"
#include "kernel/scene/raw_vector.hpp"

namespace grelha {

/// Squares of a face, in its tiles: the corner of the first, how wide each is, and how many.
struct TileRaster {
  double x, y, width;
  int columns, rows;
};

/// Squares of one row that a primitive may be met in: from `begin` to before `end`.
struct TileRun {
  int begin, end;
};

/// A side of each, where primitives have any: b y + c = at, and x >= at per_lo + lo, x <= at per_hi
/// + hi. One of the two is no bound.
struct SeenSide {
  double b[kOutlines], c[kOutlines];
  double per_lo[kOutlines], lo[kOutlines];
  double per_hi[kOutlines], hi[kOutlines];
};

/// What is seen of up to eight primitives through one face, in its tiles: rows with a place for
/// each.
struct alignas(64) SeenFew {
  double lo[2][kOutlines], hi[2][kOutlines];  ///< where rays may meet it
  SeenSide side_of[3];
  // the same as lists hold it, from the anchor on
  float box_lo[2][kOutlines], box_hi[2][kOutlines];
  float side[9][kOutlines];
  float near[kOutlines], far[kOutlines];
  float anchor[2][kOutlines];  ///< the tile that it begins in, and that it ends in
  float last[2][kOutlines];
  unsigned seen;      ///< a bit for each of which there is anything
  unsigned on_tiles;  ///< and not only beyond all tiles
  bool sided;
};

/// The squares of a raster that a primitive may be met in.
class TileWalk {
 public:
  explicit TileWalk(const TileRaster& raster)
      : raster_(raster),
        squares_(1 / raster.width),
        last_{raster.columns - 1., raster.rows - 1.},
        end_(raster.x + raster.columns * raster.width + kPlaceRounding) {}
  /// Calls visit(number) for each of primitive k's; x runs fastest.
  template <class Visit>
  void each(const SeenFew& seen, int k, const Visit& visit) const {
    const int first = clamped((seen.lo[1][k] - raster_.y) * squares_, last_[1]);
    const int last = clamped((seen.hi[1][k] - raster_.y) * squares_, last_[1]);
    const bool by_sides = first != last && seen.sided;
    for (int y = first; y <= last; ++y) {
      const TileRun run = by_sides ? run_of(seen, k, y) : run_between(seen.lo[0][k], seen.hi[0][k]);
      for (int x = run.begin; x < run.end; ++x)
        visit(static_cast<std::uint32_t>(y * raster_.columns + x));
    }
  }

 private:
  /// Of parts up to number `last` the one that holds x, or the nearest.
  static int clamped(double x, double last) {
    return static_cast<int>(std::min(std::max(0., x), last));
  }
  TileRun run_of(const SeenFew& seen, int k, int row) const {
    const double below = raster_.y + row * raster_.width - kPlaceRounding;
    const double above = raster_.y + (row + 1) * raster_.width + kPlaceRounding;
    double lo = seen.lo[0][k];
    double hi = seen.hi[0][k];
    for (const SeenSide& s : seen.side_of) {  // without branches, that nobody could foretell
      const double at = s.c[k] + std::max(s.b[k] * below, s.b[k] * above);
      lo = std::max(lo, at * s.per_lo[k] + s.lo[k]);
      hi = std::min(hi, at * s.per_hi[k] + s.hi[k]);
    }
    return run_between(lo, hi);
  }
  TileRun run_between(double lo, double hi) const {
    if (!(lo <= hi) || hi < raster_.x - kPlaceRounding || lo > end_)
      return {0, 0};
    return {
        clamped((lo - raster_.x) * squares_, last_[0]),
        clamped((hi - raster_.x) * squares_, last_[0]) + 1,
    };
  }

  TileRaster raster_;
  double squares_;  ///< a tile's width
  double last_[2];
  double end_;
};

/// A tile of a face that what is seen of a primitive is told from.
struct Anchor {
  std::uint16_t x = 0;
  std::uint16_t y = 0;

  Anchor() = default;
  /// Of primitive k.
  Anchor(const SeenFew& seen, int k)
      : x(static_cast<std::uint16_t>(seen.anchor[0][k])),
        y(static_cast<std::uint16_t>(seen.anchor[1][k])) {}
};

/// What lists hold of a primitive that has an outline, in tiles from its anchor on. A line of
/// memory: lists are put together from them in no order.
struct alignas(64) SeenOutline {
  float side[3][3];  ///< as in OutlineBlock
  float near, far;
  std::uint32_t id;
  Anchor anchor;

  SeenOutline() = default;
  SeenOutline(const SeenFew& seen, int k, std::uint32_t of)
      : near(seen.near[k]), far(seen.far[k]), id(of), anchor(seen, k) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        side[i][j] = seen.side[3 * i + j][k];
  }
};

/// The same of a sphere.
struct alignas(32) SeenBox {
  float lo[2], hi[2];
  float near;
  std::uint32_t id;
  Anchor anchor;

  SeenBox() = default;
  SeenBox(const SeenFew& seen, int k, std::uint32_t of)
      : near(seen.near[k]), id(of), anchor(seen, k) {
    for (int j = 0; j < 2; ++j) {
      lo[j] = seen.box_lo[j][k];
      hi[j] = seen.box_hi[j][k];
    }
  }
};

/// Many of them, in pages that threads fill side by side.
template <class Seen>
class SeenPages {
 public:
  static constexpr std::uint32_t kPage = 1024;
  /// One thread's way to add.
  class Writer {
   public:
    explicit Writer(SeenPages& to) : to_(to) {}
    /// Adds primitive k, which has an id. Returns the number of what was added.
    std::uint32_t add(const SeenFew& seen, int k, std::uint32_t id) {
      if (at_ == kPage) {
        first_ = to_.add(page_);
        at_ = 0;
      }
      new (page_ + at_) Seen(seen, k, id);
      return first_ + at_++;
    }

   private:
    SeenPages& to_;
    Seen* page_ = nullptr;
    std::uint32_t first_ = 0;
    std::uint32_t at_ = kPage;
  };
  const Seen& operator[](std::uint32_t i) const { return pages_[i / kPage][i % kPage]; }

 private:
  /// Pages are asked for one, two, four and so on at a time: many small ones are many faults.
  static constexpr std::size_t kMostAtATime = 32;

  /// A new page; returns the number of its first place.
  std::uint32_t add(Seen*& page) {
    const std::lock_guard lock(mutex_);
    if (left_ == 0) {
      left_ = std::min(pages_.size() + 1, kMostAtATime);
      memory_.emplace_back().resize(left_ * kPage);
    }
    page = memory_.back().data() + memory_.back().size() - left_ * kPage;
    --left_;
    pages_.push_back(page);
    return static_cast<std::uint32_t>((pages_.size() - 1) * kPage);
  }
  std::mutex mutex_;
  std::vector<RawVector<Seen>> memory_;
  std::vector<Seen*> pages_;
  std::size_t left_ = 0;  ///< pages of the last memory
};

/// What goes into a window, for each of eight places apart: sums of floats do not depend on how
/// many are taken at a time.
struct alignas(64) WindowRows {
  double lo[2][kOutlines], hi[2][kOutlines], near[kOutlines];
  double across[2][kOutlines], area[kOutlines];
  std::uint64_t seen = 0;
  std::uint64_t large = 0;
  WindowRows();
};

/// The part of a face that primitives are seen in, and how many.
struct Window {
  double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
  double near = 1e300;
  std::uint64_t seen = 0;
  std::uint64_t large = 0;    ///< others, which stand in no grid of the scene and widen no window
  double across[2] = {0, 0};  ///< sums of widths and heights
  double area = 0;
  void add(const Window& w);
  void add(const WindowRows& w);
  /// Lays about so many square tiles, over a little more than the window.
  void lay_tiles(PointFace& face, double tiles) const;
  /// What the lists of a face's tiles hold at most, by bounds of what is seen.
  double most_references(const PointFace& face) const;
};

/// A tile of any level: its corner and width in tiles of its face. Width 0: beyond all others.
struct Tile {
  double x, y, width;
  double columns;  ///< such tiles beside each other in one of the face; 0 beyond
  int face;
  Tile(double left, double top, double wide, int of)
      : x(left), y(top), width(wide), columns(wide > 0 ? 1 / wide : 0), face(of) {}
};

/// Sets place k of a block.
void set_place(OutlineBlock& block, std::uint32_t k, const SeenOutline& seen, const Tile& tile);
void set_place(BoxBlock& block, std::uint32_t k, const SeenBox& seen, const Tile& tile);

}  // namespace grelha
