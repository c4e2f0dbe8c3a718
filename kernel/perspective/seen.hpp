#pragma once
// What is seen of primitives through the faces around a point, in tiles.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "grelha/rays.hpp"
#include "kernel/perspective/outline.hpp"
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

/// From directions to tiles of a face.
void to_tiles(const PointFace& face, Bounds& bounds);
/// The same with sides, which are scaled so that what they leave open is 1.
void to_tiles(const PointFace& face, Outline& outline);

/// The squares of a raster that a primitive may be met in.
class TileWalk {
 public:
  explicit TileWalk(const TileRaster& raster) : raster_(raster), squares_(1 / raster.width) {}
  /// Calls visit(number) for each; x runs fastest. `seen`: in tiles.
  template <class Visit>
  void each(const Outline& seen, const Visit& visit) const {
    const int first = row_of(seen.lo[1]);
    const int last = row_of(seen.hi[1]);
    for (int y = first; y <= last; ++y) {
      const TileRun run = first == last ? bounds_of(seen) : run_of(seen, y);
      for (int x = run.begin; x < run.end; ++x)
        visit(static_cast<std::uint32_t>(y * raster_.columns + x));
    }
  }

 private:
  int row_of(double y) const;
  TileRun run_of(const Outline& seen, int row) const;
  TileRun bounds_of(const Bounds& seen) const { return run_between(seen.lo[0], seen.hi[0]); }
  TileRun run_between(double lo, double hi) const;
  TileRaster raster_;
  double squares_;  ///< a tile's width
};

/// A tile of a face that what is seen of a primitive is told from.
struct Anchor {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
};

/// What lists hold of a primitive that has an outline, in tiles from its anchor on. A line of
/// memory: lists are put together from them in no order.
struct alignas(64) SeenOutline {
  float side[3][3];  ///< as in OutlineBlock
  float near, far;
  std::uint32_t id;
  Anchor anchor;

  SeenOutline() = default;
  SeenOutline(const PointFace& face, const Outline& seen, std::uint32_t id);
};

/// The same of a sphere.
struct alignas(32) SeenBox {
  float lo[2], hi[2];
  float near;
  std::uint32_t id;
  Anchor anchor;

  SeenBox() = default;
  SeenBox(const PointFace& face, const Bounds& seen, std::uint32_t id);
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
    /// Returns the number of what was added.
    std::uint32_t add(const Seen& seen) {
      if (at_ == kPage) {
        first_ = to_.add(page_);
        at_ = 0;
      }
      page_[at_] = seen;
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

}  // namespace grelha
