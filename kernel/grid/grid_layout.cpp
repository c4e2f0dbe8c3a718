#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>

#include "kernel/grid/cell_finder.hpp"
#include "kernel/shapes/rounding.hpp"
#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

constexpr double kMostCells = 1024;     ///< along an axis
constexpr double kMostReferences = 64;  ///< per primitive; the scenes measured have 1.3 to 10
/// references in all, unless so many primitives need more; 200 MB
constexpr double kMostInAll = 1 << 22;
constexpr double kSmallShare = 8;  ///< any grid of a scene may hold an eighth of kMostInAll
/// references per primitive, however many there are; scenes of a million have 1.3 to 2.6
constexpr double kAlways = 4;
/// primitives from which the number of references is estimated
constexpr std::size_t kFirstProbes = 128, kMoreProbes = std::size_t{1} << 14;

/// costs of a ray and of a cell on its way; 1 is that of a reference (measured: piles of paper)
constexpr double kRay = 64, kVisit = 8;
constexpr double kOpen = .01;  ///< of rays, which pass between piles
/// references of the mean primitive from which cells may become longer than high, most counted
constexpr double kReachFar = 16, kMostCounted = 1 << 13;
constexpr std::size_t kMoreCells = 2;  ///< times those that the density asks for, at most
constexpr double kClear = 1.5;         ///< times less cost, for packets are lost

using Factors = std::array<double, 3>;  ///< times the cells of each axis that the density asks for
constexpr Factors kCubes = {1, 1, 1};

/// A cube root from + - * / alone, so that resolutions agree between machines; Newton's steps until
/// they stop falling.
double cube_root(double x) {
  double r = x > 1 ? x : 1;
  for (;;) {
    const double next = r - (r - x / (r * r)) / 3;
    if (!(next < r))
      return r;
    r = next;
  }
}

/// Calls look(run) for runs of ids, which are all in the end.
template <class Look>
void each_run(std::span<const std::uint32_t> ids, int threads, const Look& look) {
  constexpr std::size_t kRun = std::size_t{1} << 12;
  each_turn((ids.size() + kRun - 1) / kRun, threads, [&](std::size_t i) {
    look(ids.subspan(i * kRun, std::min(kRun, ids.size() - i * kRun)));
  });
}

/// Grows a box by another; returns the square of that one's diagonal.
double add_box(Box& to, const Box& b) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    sum += (b.hi[a] - b.lo[a]) * (b.hi[a] - b.lo[a]);
    to.lo[a] = std::min(to.lo[a], b.lo[a]);
    to.hi[a] = std::max(to.hi[a], b.hi[a]);
  }
  return sum;
}

}  // namespace

Extent extent_of(const Primitives& p, std::span<const std::uint32_t> ids, int threads) {
  Extent all;
  std::mutex mutex;
  each_run(ids, threads, [&](std::span<const std::uint32_t> run) {
    Box box;
    double longest = 0;  // squared: one root in the end
    for (const std::uint32_t id : run)
      longest = std::max(longest, add_box(box, p.box(id)));
    const std::lock_guard lock(mutex);  // least and most do not depend on the order
    if (!box.empty())
      all.box.add(box);
    all.longest = std::max(all.longest, std::sqrt(longest));
  });
  return all;
}

std::vector<std::uint32_t> longer_than(const Primitives& p,
                                       std::span<const std::uint32_t> ids,
                                       double diagonal,
                                       std::size_t most,
                                       int threads) {
  std::vector<std::uint32_t> found(most + 1);
  std::atomic<std::size_t> next = 0;
  each_run(ids, threads, [&](std::span<const std::uint32_t> run) {
    for (const std::uint32_t id : run) {
      if (!(p.box(id).diagonal() > diagonal))
        continue;
      if (const std::size_t at = next++; at < found.size())
        found[at] = id;
    }
  });
  found.resize(std::min(next.load(), found.size()));
  std::sort(found.begin(), found.end());
  return found;
}

namespace {

/// Cells that a density asks for per length; extents that are nothing beside the largest become a
/// thousandth of it.
double cells_per_length(double (&extent)[3], std::size_t count, double density) {
  double largest = std::max({extent[0], extent[1], extent[2]});
  if (!(largest > 0))
    largest = 1e-30;  // every primitive at one point of the origin: any cell does
  for (double& e : extent)
    e = std::max(e, largest / 1000);
  return density / cube_root(extent[0] * extent[1] * extent[2] / static_cast<double>(count));
}

/// The corner of a grid around a box, and its extent from there.
void set_corner(Grid& g, const Box& b, double (&extent)[3]) {
  for (int a = 0; a < 3; ++a) {
    // a float, so that walks subtract it without an error of its own
    g.lo[a] = float_not_above(b.lo[a]);
    extent[a] = b.hi[a] - g.lo[a];
  }
}

/// Cells of a grid whose corner and pad are known; returns how many.
std::size_t divide(Grid& g, const double (&extent)[3], double per_length, const Factors& times) {
  std::size_t cells = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    // Cells no smaller than 2 pad: one outlier a million scenes away makes a pad that would put
    // everything in every cell.
    const double n = std::min((extent[a] * per_length + 1) * times[a], extent[a] / (2 * g.pad));
    g.cells[a] = static_cast<std::uint32_t>(std::clamp(n, 1., kMostCells));
    g.cell[a] = extent[a] / g.cells[a];
    cells *= g.cells[a];
  }
  return cells;
}

/// So many primitives, evenly picked, or up to twice as many.
std::vector<std::uint32_t> pick(std::span<const std::uint32_t> ids, std::size_t probes) {
  const std::size_t stride = std::max<std::size_t>(1, ids.size() / probes);
  std::vector<std::uint32_t> picked;
  for (std::size_t i = stride / 2; i < ids.size(); i += stride)
    picked.push_back(ids[i]);
  return picked;
}

/// Cells that the mean primitive stands in; counting ends with more than `most`.
double mean_references(double most,
                       const Primitives& p,
                       const std::vector<std::uint32_t>& ids,
                       const Grid& g) {
  const CellFinder finder(p, g);
  const double count = static_cast<double>(ids.size());
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < ids.size() && static_cast<double>(sum) <= most * count; ++i)
    finder(ids[i], [&](std::size_t) { ++sum; });
  return static_cast<double>(sum) / count;
}

/// True if the mean primitive stands in more than `most` cells. One of a few may be the largest of
/// all: where these say so, many are asked.
bool have_more(double most,
               const Primitives& p,
               std::span<const std::uint32_t> ids,
               const Grid& g) {
  return mean_references(most, p, pick(ids, kFirstProbes), g) > most &&
         mean_references(most, p, pick(ids, kMoreProbes), g) > most;
}

/// References that the mean one of `count` primitives may have. A heap of large ones, or of
/// slivers, would stand in thousands of cells each, and memory end. Grids of a scene share what
/// there is by their primitives; small ones, which need little, get more.
double most_references(const Primitives& p, std::size_t count) {
  const double served =
      std::min(static_cast<double>(p.ids.end()), kSmallShare * static_cast<double>(count));
  return std::clamp(kMostInAll / served, kAlways, kMostReferences);
}

double half_surface(const double (&e)[3]) {
  return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

/// What a ray through a grid is expected to cost, by some of its primitives; see layout_grid().
struct RayCost {
  const Primitives& p;
  std::vector<std::uint32_t> picked;
  double count;
  double crossed[3];  ///< planes across an axis that a ray meets, over all of them

  RayCost(const Primitives& all, std::span<const std::uint32_t> ids, const double (&extent)[3])
      : p(all), picked(pick(ids, kFirstProbes)), count(static_cast<double>(ids.size())) {
    double sum = 0;
    for (const std::uint32_t id : picked) {
      const Box b = p.box(id);
      sum += half_surface({b.hi[0] - b.lo[0], b.hi[1] - b.lo[1], b.hi[2] - b.lo[2]});
    }
    const double surface = half_surface(extent);
    const double met = sum / surface * count / static_cast<double>(picked.size());
    for (std::size_t a = 0; a < 3; ++a)
      crossed[a] =
          (kOpen + (1 - kOpen) / (1 + met)) * extent[(a + 1) % 3] * extent[(a + 2) % 3] / surface;
  }
  double references(const Grid& g) const { return mean_references(kMostCounted, p, picked, g); }
  double operator()(const Grid& g) const {
    double visits = 1;
    for (std::size_t a = 0; a < 3; ++a)
      visits += (g.cells[a] - 1.) * crossed[a];
    const double in_cell = references(g) * count / static_cast<double>(cell_count(g.cells));
    return kRay + visits * (kVisit + in_cell);
  }
};

/// Moves cells from axis to axis while that saves costs; kCubes, unless it saves clearly.
Factors choose_factors(Grid g, const RayCost& cost, const double (&extent)[3], double per_length) {
  const std::size_t most = kMoreCells * divide(g, extent, per_length, kCubes);
  if (!(cost.references(g) > kReachFar))
    return kCubes;
  const double before = cost(g);
  double least = before;
  Factors best = kCubes;
  for (Factors from = {}; from != best;) {
    from = best;
    for (std::size_t i = 0; i < 9; ++i) {
      Factors moved = from;
      moved[i / 3] *= 2;
      moved[i % 3] /= 2;
      if (divide(g, extent, per_length, moved) <= most && cost(g) < least) {
        least = cost(g);
        best = moved;
      }
    }
  }
  return kClear * least < before ? best : kCubes;
}

}  // namespace

double cell_edge(const Box& box, std::size_t count, double density) {
  double extent[3] = {box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]};
  const double per_length = cells_per_length(extent, count, density);
  return std::max(1 / per_length, std::max({extent[0], extent[1], extent[2]}) / kMostCells);
}

Grid layout_grid(const Primitives& p,
                 std::span<const std::uint32_t> ids,
                 const Box& box,
                 double density,
                 double pad) {
  Box b = box;
  b.grow(2 * pad);  // once for the cells' contents, once for the entry of rays
  Grid g;
  g.pad = pad;
  double extent[3];
  set_corner(g, b, extent);
  const double per_length = cells_per_length(extent, ids.size(), density);
  const Factors times = choose_factors(g, RayCost(p, ids, extent), extent, per_length);
  g.stretched = times != kCubes;
  std::size_t cells = divide(g, extent, per_length, times);
  const double most = most_references(p, ids.size());
  for (double coarser = per_length / 2; cells > kMostReferences && have_more(most, p, ids, g);
       coarser /= 2)
    cells = divide(g, extent, coarser, times);
  return g;
}

}  // namespace grelha
