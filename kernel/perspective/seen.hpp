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

/// What is seen of a primitive through a face: in directions first, then in tiles of the face.
struct Seen {
  Outline outline;
  std::uint32_t id = kNoPrimitive;
  int face = 0;
  bool large = false;  ///< it stands in no grid of the scene

  /// From directions to tiles. Sides are scaled as blocks hold them.
  void to_tiles(const PointFace& face);
};

/// The squares of a raster that a primitive may be met in.
class TileWalk {
 public:
  TileWalk(const TileRaster& raster, const PointFace& face)
      : raster_(raster),
        slack_{kLookUp * face.per_u + kPlaceRounding, kLookUp * face.per_v + kPlaceRounding} {}
  /// Calls visit(number) for each; x runs fastest.
  template <class Visit>
  void each(const Seen& seen, const Visit& visit) const {
    const int last = row_of(seen.outline.hi[1]);
    for (int y = row_of(seen.outline.lo[1]); y <= last; ++y) {
      const TileRun run = run_of(seen, y);
      for (int x = run.begin; x < run.end; ++x)
        visit(static_cast<std::uint32_t>(y * raster_.columns + x));
    }
  }

 private:
  int row_of(double y) const;
  TileRun run_of(const Seen& seen, int row) const;
  TileRaster raster_;
  double slack_[2];  ///< what look-ups round by, in tiles
};

/// Many of them, in pages that threads fill side by side.
class SeenPages {
 public:
  static constexpr std::uint32_t kPage = 1024;
  /// One thread's way to add.
  class Writer {
   public:
    explicit Writer(SeenPages& to) : to_(to) {}
    Seen& next() {
      if (at_ == kPage) {
        page_ = to_.add();
        at_ = 0;
      }
      return page_[at_++];
    }

   private:
    SeenPages& to_;
    Seen* page_ = nullptr;
    std::uint32_t at_ = kPage;
  };
  std::size_t pages() const { return pages_.size(); }
  Seen& operator[](std::uint32_t i) { return pages_[i / kPage][i % kPage]; }
  const Seen& operator[](std::uint32_t i) const { return pages_[i / kPage][i % kPage]; }

 private:
  /// Pages are asked for one, two, four and so on at a time: many small ones are many faults.
  static constexpr std::size_t kMostAtATime = 16;

  Seen* add() {
    const std::lock_guard lock(mutex_);
    if (left_ == 0) {
      left_ = std::min(pages_.size() + 1, kMostAtATime);
      memory_.emplace_back().resize(left_ * kPage);
    }
    Seen* const page = memory_.back().data() + memory_.back().size() - left_ * kPage;
    --left_;
    for (std::uint32_t i = 0; i < kPage; ++i)
      page[i].id = kNoPrimitive;
    pages_.push_back(page);
    return page;
  }
  std::mutex mutex_;
  std::vector<RawVector<Seen>> memory_;
  std::vector<Seen*> pages_;
  std::size_t left_ = 0;  ///< pages of the last memory
};

}  // namespace grelha
