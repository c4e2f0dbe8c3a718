#pragma once
// How the grids of a scene are laid out, planned, estimated and filled.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "grelha/world.hpp"
#include "kernel/grid/grid.hpp"
#include "kernel/shapes/primitives.hpp"

namespace grelha {

/// Ids that follow each other.
struct IdRange {
  std::uint32_t first = 0, end = 0;
  bool operator==(const IdRange&) const = default;
};

/// Ascending ids as ranges, or none if they are too scattered.
inline constexpr std::size_t kMostRanges = 1024;
inline std::vector<IdRange> ranges_of(std::span<const std::uint32_t> ids) {
  std::vector<IdRange> ranges;
  for (std::size_t i = 0; i < ids.size();) {
    if (ranges.size() == kMostRanges)
      return {};
    const std::uint32_t first = ids[i];
    while (++i < ids.size() && ids[i] == ids[i - 1] + 1)
      ;
    ranges.push_back({first, ids[i - 1] + 1});
  }
  return ranges;
}

inline bool overlap(std::span<const IdRange> some, std::span<const IdRange> others) {
  for (const IdRange& one : some)
    for (const IdRange& other : others)
      if (one.first < other.end && other.first < one.end)
        return true;
  return false;
}

// Progress of a build, reported by the threads that build.

class BuildProgress {
 public:
  BuildProgress() = default;  ///< reports nothing
  explicit BuildProgress(const std::function<bool(double)>& report) : report_(report) {}

  /// Starts the next stage, which has `steps` steps and takes `share` of the whole; the stages
  /// before it are done. Called by one thread.
  void expect(double share, std::size_t steps) {
    share_ = end_;
    end_ += share;
    step_ = share / static_cast<double>(std::max<std::size_t>(steps, 1));
    tell(share_);
  }
  /// Reports that a step is done. Called by any thread.
  void step() {
    if (!report_)
      return;
    const std::lock_guard one_at_a_time(mutex_);
    tell(share_ = std::min(share_ + step_, end_));
  }
  void finish() { tell(1); }

  /// True if the caller stopped the build. Called by any thread.
  bool stopped() const { return cancelled_.load(std::memory_order_relaxed); }
  void throw_if_cancelled() const {
    if (stopped())
      throw Stopped();
  }

 private:
  void tell(double share) {
    if (report_ && !stopped() && !report_(std::min(share, 1.)))
      cancelled_ = true;
  }
  std::function<bool(double)> report_;
  double share_ = 0;
  double end_ = 0;
  double step_ = 0;
  std::atomic<bool> cancelled_ = false;
  std::mutex mutex_;
};

// Chooses the cells of grids.

/// Threads that have enough to do: starting one costs as much as some hundred primitives.
inline int thread_count_for(int threads, std::size_t work) {
  return static_cast<int>(
      std::clamp<std::size_t>(work / 512, 1, static_cast<std::size_t>(threads)));
}

/// Chooses the cells of a grid over some primitives (ids ascending, at least one), M = density.
/// fill_grid() then writes its lists, and reports its share of the whole.
///
/// Resolution  cells per axis = M extent / cbrt(volume / count) + 1 (Cleary & Wyvill 1988;
///             Amanatides & Woo's report form). Extents below 1/1000 of the largest count as that.
///             At most 1024 cells an axis, none smaller than 2 pad. Cells are coarsened by halves
///             if primitives of a probe would stand in more than 64 cells on average, or all
///             primitives together in more than 2^22 (or 4 each).
/// Stretch     Where the mean primitive would stand in more than 16 cells, as sheets do, these move
///             from axis to axis by factors of two. A ray is expected to cost 64 + visits (8 +
///             references of a cell). It crosses the planes of an axis by the area of the grid
///             across it, on 1 / (1 + boxes met) of its way; a hundredth of rays go all of it.
/// Guarantee   every primitive stands in each cell that its box grown by `pad` overlaps, unless the
///             cell lies beyond `pad` of its surface. In each cell spheres and cones ascend by id,
///             triangles stand as BlockOrder says. Same lists on every machine, by any number of
///             threads.
/// Source      Lagae & Dutré, "Compact, Fast and Robust Grids for Ray Tracing", 2008: count, sum,
///             scatter. Kalojanov & Slusallek, "A Parallel Algorithm for Construction of Uniform
///             Grids", 2009: pairs of cell and primitive, sorted by cell.
Grid layout_grid(const Primitives& primitives,
                 std::span<const std::uint32_t> ids,
                 const Box& box,
                 double density,
                 double pad);

/// The edge of the cells that a density asks for; what layout_grid() makes of it also depends on
/// the pad.
double cell_edge(const Box& box, std::size_t count, double density);

/// Box of some finite primitives, and the longest diagonal of any.
struct Extent {
  Box box;
  double longest = 0;
};
Extent extent_of(const Primitives& primitives, std::span<const std::uint32_t> ids, int threads);
/// Returns the `ids` whose box has a longer diagonal, ascending; if there are more than `most`, any
/// most + 1 such ids.
std::vector<std::uint32_t> longer_than(const Primitives& primitives,
                                       std::span<const std::uint32_t> ids,
                                       double diagonal,
                                       std::size_t most,
                                       int threads);

// Clusters: many primitives in few cells, where one level of cells is not enough.

/// Takes clusters out of some primitives in a box: towns in a desert, where cells of a grid of that
/// density would hold too much. Each cluster is for a grid of its own, with cells of its own size.
/// `ids` (ascending) keeps the rest. At most `most` clusters are taken, each smaller than half the
/// box, so that taking ends.
///
/// Method  a thousand primitives, evenly picked, are a probe. If the mean primitive of the probe
///         shares its cell with more than kBad, cells with more than kCluster are clustered. Those
///         that touch and the cells around them are one cluster. Only then are all primitives
///         looked at.
std::vector<std::vector<std::uint32_t>> take_clusters(const Primitives& p,
                                                      std::vector<std::uint32_t>& ids,
                                                      const Box& box,
                                                      double density,
                                                      std::size_t most);

// Decides which primitives get which grid, and what that will take, before any list is written.

/// Ascending ids: a list, or while that is empty, ranges. Where a scene moves, most groups stay and
/// need no list, which would take longer than all else.
struct IdGroup {
  std::vector<std::uint32_t> list;
  std::vector<IdRange> ranges;

  bool empty() const { return list.empty() && ranges.empty(); }
  std::size_t size() const;
  void add(IdRange ids);                      ///< behind all others, to ranges
  std::vector<std::uint32_t> take_list();     ///< of all, and forgets them
  std::vector<IdRange> short_ranges() const;  ///< as ranges_of()
};

struct GridPlan {
  IdGroup ids;
  Grid grid;  ///< over them, laid out and empty
};

/// Primitives that are planned together, and what was found of them.
struct PlannedGroup {
  std::vector<IdRange> ids;
  Extent extent;
  std::optional<Grid> grid;  ///< over all of them, laid out and empty
};

/// What the next plan of a scene that moves takes over.
struct PlanMemory {
  /// Objects that get grids of their own before others do, the first before the next.
  std::vector<Object> own;
  std::vector<PlannedGroup> groups;
  bool all_finite = false;       ///< no primitive had a number that is not
  std::vector<IdRange> changed;  ///< ids of primitives that may have one now
  // grids are of use to a plan of as many groups, of this density in a scene of this diagonal
  std::size_t group_count = 0;
  double density = 0, diagonal = 0;
};

struct Plan {
  std::vector<GridPlan> parts;
  std::vector<std::uint32_t> ungridded;  ///< ids without a grid, ascending
  Box all;                               ///< of everything finite
  PlanMemory memory;
};

constexpr double kPlanShare = .08;  ///< of the time of a build, before lists are written

int threads_of(const BuildOptions& options);
/// The pad around primitives for rays that start within `near_distance` of their box on each axis,
/// `near_distance` no less than its diagonal. Such rays are at most 1 + sqrt 3 near distances from
/// any primitive. A walk in float is off by at most 32 u of the near distance, and by as much along
/// its way (derived in docs/proofs.md).
double pad_of(double near_distance);
/// All finite primitives that have a position.
std::vector<std::uint32_t> valid_ids(const Primitives& p);
Plan plan_grids(const Primitives& p,
                const BuildOptions& options,
                BuildProgress& progress,
                const PlanMemory& before = {});

// Writes the lists of grids.

/// Writes the lists of a grid whose cells layout_grid() chose, and reports progress, `share` of
/// the whole.
void fill_grid(const Primitives& primitives,
               std::span<const std::uint32_t> ids,
               Grid& grid,
               int threads,
               BuildProgress& progress,
               double share);

/// All of `ids` as the one cell of a store without a grid.
CellStore build_list(const Primitives& primitives, std::span<const std::uint32_t> ids);

// Estimates the memory that a build will take.

/// The memory that carrying out a plan for a scene takes, including the plan's own lists.
///
/// Method  sixteen thousand primitives of each grid, picked at random, tell how many references
///         there will be and how many pairs of primitives share a cell. From the pairs follows how
///         many blocks of eight are not full. All else are counts.
BuildMemory memory_of(const SceneSpans& scene, const Primitives& p, const Plan& plan);
/// True if no plan for so many primitives takes nearly so many bytes: then no estimate is needed.
bool surely_fits(const Primitives& p, std::uint64_t bytes);

}  // namespace grelha
