#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <omp.h>

#include "kernel/base/pages.hpp"

namespace grelha {
namespace {

/// so few primitives are faster looped over than walked through
constexpr std::size_t kFewest = 8;
constexpr std::size_t kMostOutside = 32;  ///< primitives without a grid, each tested by every ray
/// triangles; smaller objects share the grid of the loose ones
constexpr std::size_t kSmallObject = 256;
/// Primitives longer than kHuge * diagonal of their group's box get no grid.
constexpr double kHuge = .5;
/// Pads a cell: more would not make its lists shorter.
constexpr double kMostPads = 64;
/// Scenes' diagonals: rays seldom start further away.
constexpr double kFarEnough = 4;
/// Rays moved to a grid in double: error <= kDoublesOff * scene's diagonal, 100 roundings.
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
  const std::size_t before = to.size();
  to.resize(before + (end - first));
  std::iota(to.begin() + static_cast<std::ptrdiff_t>(before), to.end(), first);
}

/// Numbers of the objects that get grids of their own, as many as may: visible ones that are not
/// small, those that overlap favoured ranges first.
std::vector<std::size_t> own_grid_objects(std::span<const Object> objects,
                                          std::span<const Object> favoured) {
  std::vector<std::size_t> own;
  std::vector<char> taken(objects.size());
  const auto take = [&](std::size_t i) {
    if (own.size() + 1 < static_cast<std::size_t>(kMostGrids) && objects[i].visible &&
        objects[i].triangle_count >= kSmallObject && !std::exchange(taken[i], 1))
      own.push_back(i);
  };
  const auto end_of = [](const Object& o) {
    return std::uint64_t{o.first_triangle} + o.triangle_count;
  };
  for (const Object& range : favoured) {
    auto at = std::ranges::upper_bound(objects, range.first_triangle, {}, end_of);
    for (; at != objects.end() && at->first_triangle < end_of(range); ++at)
      take(static_cast<std::size_t>(at - objects.begin()));
  }
  for (std::size_t i = 0; i < objects.size(); ++i)
    take(i);
  return own;
}

/// Groups of ids, one per grid: first what shares one, then objects with one each.
struct Groups {
  std::vector<IdGroup> ids{1};
  IdGroup hidden;           ///< of objects that no query finds
  std::vector<Object> own;  ///< the objects, the favoured first
  bool all_finite = true;
};

/// Triangles that are loose, or of small objects, join the first group; larger objects get one
/// each.
void group_triangles(const Primitives& p, std::span<const Object> favoured, Groups& groups) {
  const std::span<const Object> objects = p.geometry.objects;
  std::vector<char> has_own_grid(objects.size());
  for (const std::size_t i : own_grid_objects(objects, favoured)) {
    has_own_grid[i] = 1;
    groups.own.push_back(objects[i]);
  }
  const std::uint32_t first_id = p.ids.begin(PrimitiveKind::kTriangle);
  std::uint32_t next = first_id;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& o = objects[i];
    const std::uint32_t first = first_id + o.first_triangle;
    groups.ids.front().add({next, first});
    next = first + o.triangle_count;
    if (has_own_grid[i])
      groups.ids.emplace_back();
    IdGroup& to = !o.visible        ? groups.hidden
                  : has_own_grid[i] ? groups.ids.back()
                                    : groups.ids.front();
    to.add({first, next});
  }
  groups.ids.front().add({next, p.ids.end(PrimitiveKind::kTriangle)});
}

/// Looks at what changed alone, if all was finite before.
bool still_valid(const Primitives& p, const PlanMemory& before) {
  if (!before.all_finite)
    return false;
  for (const IdRange& range : before.changed)
    for (std::uint32_t id = range.first; id < range.end; ++id)
      if (!is_valid(p, id))
        return false;
  return true;
}

/// No ray hits a primitive with numbers that are not finite, and it would leave each cell in doubt.
void drop_invalid(const Primitives& p, Groups& groups) {
  const auto drop = [&](IdGroup& ids) {
    const std::size_t before = ids.size();
    ids.list = ids.take_list();
    std::erase_if(ids.list, [&](std::uint32_t id) { return !is_valid(p, id); });
    groups.all_finite &= ids.list.size() == before;
  };
  std::ranges::for_each(groups.ids, drop);
  drop(groups.hidden);
}

Groups group(const Primitives& p, const PlanMemory& before) {
  Groups groups;
  for_each_finite_shape([&]<class Shape>() {
    if constexpr (Shape::kKind == PrimitiveKind::kTriangle)
      group_triangles(p, before.own, groups);
    else
      groups.ids.front().add({p.ids.begin(Shape::kKind), p.ids.end(Shape::kKind)});
  });
  if (!still_valid(p, before) && !all_valid(p.geometry))
    drop_invalid(p, groups);
  std::erase_if(groups.ids, [](const IdGroup& g) { return g.empty(); });
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

/// At least `length`, by less than a quarter more, and mostly the same if it changes a little: then
/// grids of what did not move stay as they are.
double rounded_up(double length) {
  if (length == 0)
    return 0;
  const double step = std::ldexp(.25, std::ilogb(length));
  return step * std::ceil(length / step);
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

std::size_t IdGroup::size() const {
  std::size_t sum = list.size();
  for (const IdRange& range : ranges)
    sum += range.end - range.first;
  return sum;
}

void IdGroup::add(IdRange ids) {
  if (ids.first == ids.end)
    return;
  if (!ranges.empty() && ranges.back().end == ids.first)
    ranges.back().end = ids.end;
  else
    ranges.push_back(ids);
}

std::vector<std::uint32_t> IdGroup::take_list() {
  reserve_to_fill(list, size());
  for (const IdRange& range : std::exchange(ranges, {}))
    append(list, range.first, range.end);
  return std::move(list);
}

std::vector<IdRange> IdGroup::short_ranges() const {
  if (!list.empty())
    return ranges_of(list);
  return ranges.size() > kMostRanges ? std::vector<IdRange>() : ranges;
}

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
  Planner(const Primitives& p, const BuildOptions& options, Groups groups, const PlanMemory& before)
      : p_(p),
        threads_(threads_of(options)),
        density_(options.density > 0 ? options.density : kDensity),
        groups_(std::move(groups.ids)) {
    memory_.own = std::move(groups.own);
    memory_.all_finite = groups.all_finite;
    lists_all_ = options.most_bytes > 0;  // to estimate the memory
    for (IdGroup& ids : groups_) {
      extents_.push_back(measure(ids, before));
      plan_.all.add(extents_.back().box);
    }
    if (!groups.hidden.empty())  // so that hiding changes no grid
      plan_.all.add(measure(groups.hidden, before).box);
    memory_.group_count = groups_.size();
    memory_.density = density_;
    memory_.diagonal = rounded_up(plan_.all.diagonal());
    if (!leaves_clusters(before) || memory_.density != before.density ||
        memory_.diagonal != before.diagonal)
      for (PlannedGroup& group : memory_.groups)
        group.grid.reset();
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
      if (i < memory_.group_count && memory_.groups[i].grid) {
        if (lists_all_)
          groups_[i].list = groups_[i].take_list();
        plan_.parts.push_back({std::move(groups_[i]), *memory_.groups[i].grid});
        continue;
      }
      Ids ids = groups_[i].take_list();
      const std::size_t all = ids.size();
      const Extent extent = remove_outliers(ids, extents_[i]);
      if (ids.size() <= kFewest && plan_.ungridded.size() + ids.size() <= kMostOutside)
        append(plan_.ungridded, ids);
      else if (!ids.empty()) {
        const bool is_whole = ids.size() == all;
        plan_group(std::move(ids), extent.box);
        if (is_whole && i < memory_.group_count)
          memory_.groups[i].grid = plan_.parts.back().grid;
      }
    }
    if (groups_.size() > memory_.group_count)  // clusters take grids from what is planned later
      memory_.group_count = 0;
    groups_.clear();
  }

  /// The plan; what no grid was planned for is apart.
  Plan finish() {
    for (IdGroup& ids : groups_)
      append(plan_.ungridded, ids.take_list());
    std::sort(plan_.ungridded.begin(), plan_.ungridded.end());
    plan_.memory = std::move(memory_);
    return std::move(plan_);
  }

 private:
  static void append(Ids& to, const Ids& ids) { to.insert(to.end(), ids.begin(), ids.end()); }

  /// Whether groups that were whole before would be so with as many groups as now: then none had
  /// clusters, unless there was no grid left for any.
  bool leaves_clusters(const PlanMemory& before) const {
    const std::size_t most = std::max(memory_.group_count, before.group_count);
    return memory_.group_count == before.group_count ||
           (before.group_count > 0 && most < static_cast<std::size_t>(kMostGrids));
  }

  /// The extent of a group, which did not change where the plan before has it.
  Extent measure(IdGroup& ids, const PlanMemory& before) {
    PlannedGroup group{ids.short_ranges(), {}, {}};
    const auto same = [&](const PlannedGroup& o) { return o.ids == group.ids; };
    const auto at = std::ranges::find_if(before.groups, same);
    if (at != before.groups.end() && !group.ids.empty())
      group = *at;
    else {
      ids.list = ids.take_list();
      group.extent = extent_of(p_, ids.list, threads_);
    }
    memory_.groups.push_back(std::move(group));
    return memory_.groups.back().extent;
  }

  /// Takes out the primitives that one grid does not suit; returns the extent of the rest.
  Extent remove_outliers(Ids& ids, Extent before) {
    Extent extent = remove_huge(p_, ids, before, plan_.ungridded, threads_);
    if (remove_few_outliers(p_, ids, plan_.ungridded))
      extent = extent_of(p_, ids, threads_);
    auto clusters = take_clusters(
        p_, ids, extent.box, density_, static_cast<std::size_t>(kMostGrids) - groups_.size());
    if (clusters.empty())
      return extent;
    for (Ids& cluster : clusters) {
      extents_.push_back(extent_of(p_, cluster, threads_));
      groups_.push_back({std::move(cluster), {}});
    }
    return extent_of(p_, ids, threads_);
  }

  void plan_group(Ids ids, const Box& box) {
    Grid grid = grid_over(p_, ids, box, density_, memory_.diagonal);
    plan_.parts.push_back({{std::move(ids), {}}, std::move(grid)});
  }

  const Primitives& p_;
  const int threads_;
  const double density_;
  std::vector<IdGroup> groups_;
  std::vector<Extent> extents_;  ///< of the groups
  bool lists_all_ = false;
  PlanMemory memory_;
  Plan plan_;
};

}  // namespace

Plan plan_grids(const Primitives& p,
                const BuildOptions& options,
                BuildProgress& progress,
                const PlanMemory& before) {
  const auto step = [&progress] {
    progress.step();
    progress.throw_if_cancelled();
  };
  progress.expect(kPlanShare, 3);
  Groups groups = group(p, before);
  step();
  Planner planner(p, options, std::move(groups), before);
  planner.expect_size();
  step();
  if (options.grid)
    planner.plan_groups();
  return planner.finish();
}

}  // namespace grelha
