#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <omp.h>

#include "kernel/grid/clusters.hpp"
#include "kernel/grid/grid_layout.hpp"
#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

/// so few primitives are faster looped over than walked through
constexpr std::size_t kFewest = 8;
constexpr std::size_t kMostOutside = 32;  ///< primitives without a grid, each tested by every ray
/// triangles; smaller objects share the grid of the loose ones
constexpr std::size_t kSmallObject = 256;
/// times the diagonal of the group's box: larger primitives get no grid
constexpr double kHuge = .5;
/// a cell: more would not make its lists shorter
constexpr double kMostPads = 64;
/// Scenes' diagonals: rays seldom start further away.
constexpr double kFarEnough = 4;
/// Times the scene's diagonal: error of rays that are moved to a grid in double, 100 roundings.
constexpr double kDoublesOff = 0x1p-46;
/// M; packets like it coarser than the report's 2 (docs/performance.md)
constexpr double kDensity = .7;

using Ids = std::vector<std::uint32_t>;

/// A NaN or an infinity: all bits of the exponent set.
bool is_number(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7F800000u) != 0x7F800000u;
}
bool are_numbers(Floats v) {
  std::uint32_t found = 0;
  for (const float x : v)
    found |= is_number(x) ? 0 : 1;
  return found == 0;
}

/// True if all numbers of all finite primitives are finite. Scans arrays in order, many at a time.
bool all_valid(const GeometrySpans& g) {
  bool sound = true;
  for_each_finite_shape([&]<class Shape>() {
    Shape::for_each_array(Shape::spans_of(g), [&](Floats v) { sound = sound && are_numbers(v); });
  });
  return sound;
}

bool is_valid(const Primitives& p, std::uint32_t id) {
  return p.visit(id, [&]<class Shape>(std::uint32_t i) {
    const auto one = p.of<Shape>()[i];
    bool sound = true;
    Shape::for_each_field([&](float x) { sound &= is_number(x); }, one);
    return sound;
  });
}

void append(Ids& to, std::uint32_t first, std::uint32_t end) {
  for (std::uint32_t id = first; id < end; ++id)
    to.push_back(id);
}

/// Triangles that are loose, or of small objects, join the first group; larger objects get one
/// each.
void group_triangles(const Primitives& p, std::vector<Ids>& groups) {
  const std::uint32_t first_id = p.ids.begin(PrimitiveKind::kTriangle);
  std::uint32_t next = first_id;
  for (const Object& o : p.geometry.objects) {
    const std::uint32_t first = first_id + o.first_triangle;
    append(groups.front(), next, first);
    next = first + o.triangle_count;
    if (o.triangle_count < kSmallObject || groups.size() >= static_cast<std::size_t>(kMostGrids)) {
      append(groups.front(), first, next);
    } else {
      reserve_to_fill(groups.emplace_back(), o.triangle_count);
      append(groups.back(), first, next);
    }
  }
  append(groups.front(), next, p.ids.end(PrimitiveKind::kTriangle));
}

std::size_t triangles_in_objects(const Primitives& p) {
  std::size_t sum = 0;
  for (const Object& o : p.geometry.objects)
    sum += o.triangle_count;
  return sum;
}

/// No ray hits a primitive with numbers that are not finite, and it would leave each cell in doubt.
void drop_invalid(const Primitives& p, std::vector<Ids>& groups) {
  if (all_valid(p.geometry))
    return;
  for (Ids& ids : groups)
    std::erase_if(ids, [&](std::uint32_t id) { return !is_valid(p, id); });
}

/// Groups of ids, one per grid: first loose primitives with small objects, then each larger object.
std::vector<Ids> group(const Primitives& p) {
  std::vector<Ids> groups(1);
  reserve_to_fill(groups.front(), p.finite_count() - triangles_in_objects(p));
  for_each_finite_shape([&]<class Shape>() {
    if constexpr (Shape::kKind == PrimitiveKind::kTriangle)
      group_triangles(p, groups);
    else
      append(groups.front(), p.ids.begin(Shape::kKind), p.ids.end(Shape::kKind));
  });
  drop_invalid(p, groups);
  std::erase_if(groups, [](const Ids& g) { return g.empty(); });
  return groups;
}

/// Takes primitives as large as all the rest out of a group, again and again while any is: a ground
/// under a teapot, a stadium around that. The rest is of one scale, as a uniform grid needs.
Extent remove_huge(const Primitives& p, Ids& ids, Extent all, Ids& outside, int threads) {
  for (;; all = extent_of(p, ids, threads)) {
    const double huge = kHuge * all.box.diagonal();
    if (!(all.longest > huge))
      return all;
    const Ids large = longer_than(p, ids, huge, kMostOutside, threads);
    if (large.empty() || outside.size() + large.size() > kMostOutside)
      return all;
    outside.insert(outside.end(), large.begin(), large.end());
    std::erase_if(
        ids, [&](std::uint32_t id) { return std::binary_search(large.begin(), large.end(), id); });
  }
}

/// A handful of round things among many triangles: a loop over them costs less than asking every
/// cell for its share.
bool remove_few_outliers(const Primitives& p, Ids& ids, Ids& outside) {
  const auto is_round = [&](std::uint32_t id) { return !p.ids.has(PrimitiveKind::kTriangle, id); };
  const auto others = static_cast<std::size_t>(std::count_if(ids.begin(), ids.end(), is_round));
  if (others == 0 || others == ids.size() || others > kFewest ||
      outside.size() + others > kMostOutside)
    return false;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(outside), is_round);
  std::erase_if(ids, is_round);
  return true;
}

/// The grid of some primitives in a scene of that diagonal, with a pad for rays that start as far
/// away as most do: in a vast scene that would be more than the cells.
Grid grid_over(
    const Primitives& p, const Ids& ids, const Box& box, double density, double diagonal) {
  const double edge = cell_edge(box, ids.size(), density);
  const double far = std::min(edge / pad_of(kMostPads), kFarEnough * diagonal);
  const double near_distance = std::max(box.diagonal(), far);
  Grid g = layout_grid(p, ids, box, density, pad_of(near_distance) + kDoublesOff * diagonal);
  g.near_distance = near_distance;
  return g;
}

}  // namespace

double pad_of(double near_distance) {
  return near_distance * 256 / 16777216;
}

std::vector<std::uint32_t> valid_ids(const Primitives& p) {
  Ids ids;
  append(ids, p.first_finite(), p.ids.end());
  if (!all_valid(p.geometry))
    std::erase_if(ids, [&](std::uint32_t id) { return !is_valid(p, id); });
  return ids;
}

int threads_of(const BuildOptions& options) {
  return options.threads > 0 ? options.threads : omp_get_num_procs();
}

namespace {

/// Primitives that may get grids, group by group.
class Planner {
 public:
  Planner(const Primitives& p, const BuildOptions& options, std::vector<Ids> groups)
      : p_(p),
        threads_(threads_of(options)),
        density_(options.density > 0 ? options.density : kDensity),
        groups_(std::move(groups)) {
    for (const Ids& ids : groups_) {
      extents_.push_back(extent_of(p, ids, threads_));
      plan_.all.add(extents_.back().box);
    }
  }

  /// Throws std::invalid_argument if the scene is too small.
  void expect_size() const {
    if (plan_.all.empty() || plan_.all.diagonal() == 0 || plan_.all.diagonal() >= kLeastScene)
      return;
    std::ostringstream text;
    text << "the scene: expected a box with a diagonal of at least " << kLeastScene << ", found "
         << plan_.all.diagonal();
    throw std::invalid_argument(text.str());
  }

  /// Plans grids for groups that are worth one. Clusters that are found join the groups.
  void plan_groups() {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      Ids ids = std::move(groups_[i]);
      const Extent extent = remove_outliers(ids, extents_[i]);
      if (ids.size() <= kFewest && plan_.apart.size() + ids.size() <= kMostOutside)
        append(plan_.apart, ids);
      else if (!ids.empty())
        plan_group(std::move(ids), extent.box);
    }
    groups_.clear();
  }

  /// The plan; what no grid was planned for is apart.
  Plan finish() {
    for (const Ids& ids : groups_)
      append(plan_.apart, ids);
    std::sort(plan_.apart.begin(), plan_.apart.end());
    return std::move(plan_);
  }

 private:
  static void append(Ids& to, const Ids& ids) { to.insert(to.end(), ids.begin(), ids.end()); }

  /// Takes out the primitives that one grid does not suit; returns the extent of the rest.
  Extent remove_outliers(Ids& ids, Extent before) {
    Extent extent = remove_huge(p_, ids, before, plan_.apart, threads_);
    if (remove_few_outliers(p_, ids, plan_.apart))
      extent = extent_of(p_, ids, threads_);
    auto clusters = take_clusters(
        p_, ids, extent.box, density_, static_cast<std::size_t>(kMostGrids) - groups_.size());
    if (clusters.empty())
      return extent;
    for (Ids& cluster : clusters) {
      extents_.push_back(extent_of(p_, cluster, threads_));
      groups_.push_back(std::move(cluster));
    }
    return extent_of(p_, ids, threads_);
  }

  void plan_group(Ids ids, const Box& box) {
    Grid grid = grid_over(p_, ids, box, density_, plan_.all.diagonal());
    plan_.parts.push_back({std::move(ids), std::move(grid)});
  }

  const Primitives& p_;
  const int threads_;
  const double density_;
  std::vector<Ids> groups_;
  std::vector<Extent> extents_;  ///< of the groups
  Plan plan_;
};

}  // namespace

Plan plan_grids(const Primitives& p, const BuildOptions& options, BuildProgress& progress) {
  const auto step = [&progress] {
    progress.step();
    progress.throw_if_cancelled();
  };
  progress.expect(kPlanShare, 3);
  std::vector<Ids> groups = group(p);
  step();
  Planner planner(p, options, std::move(groups));
  planner.expect_size();
  step();
  if (options.grid)
    planner.plan_groups();
  return planner.finish();
}

}  // namespace grelha
