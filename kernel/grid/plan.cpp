#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <omp.h>

#include "kernel/grid/crowds.hpp"
#include "kernel/grid/grid_layout.hpp"

namespace grelha {
namespace {

/// so few primitives are faster looped over than walked through
constexpr std::size_t kFewest = 8;
constexpr std::size_t kMostOutside = 32;  ///< primitives without a grid, each met by every ray
/// triangles; smaller objects share the grid of the loose ones
constexpr std::size_t kSmallObject = 256;
/// of the diagonal of what it lies among: larger primitives get no grid
constexpr double kHuge = .5;
/// a cell, of a grid for near rays: more would not make its lists shorter
constexpr double kMostPads = 64;
/// a cell, of a grid for far rays: with fewer, lists are long, and no faster
constexpr double kFewestPads = 8;
/// scenes so many times as wide as near rays reach have both: in others it would gain little
constexpr double kVast = 4;
/// M; packets like it coarser than the report's 2 (docs/performance.md)
constexpr double kDensity = .7;

using Ids = std::vector<std::uint32_t>;

/// A NaN or an infinity: all bits of the exponent set.
bool is_number(float x) { return (std::bit_cast<std::uint32_t>(x) & 0x7F800000u) != 0x7F800000u; }
bool are_numbers(Floats v) {
  std::uint32_t found = 0;
  for (const float x : v)
    found |= is_number(x) ? 0 : 1;
  return found == 0;
}

/// Whether every primitive has a place. The arrays are asked as they lie, many at a time.
bool all_are_sound(const GeometrySpans& g) {
  for (const auto* v : {&g.triangles.x,
                        &g.triangles.y,
                        &g.triangles.z,
                        &g.spheres.x,
                        &g.spheres.y,
                        &g.spheres.z,
                        &g.spheres.radius,
                        &g.cones.base_x,
                        &g.cones.base_y,
                        &g.cones.base_z,
                        &g.cones.base_radius,
                        &g.cones.apex_x,
                        &g.cones.apex_y,
                        &g.cones.apex_z,
                        &g.cones.apex_radius})
    if (!are_numbers(*v))
      return false;
  return true;
}

bool is_sound(const Primitives& p, std::uint32_t id) {
  const GeometrySpans& g = p.geometry;
  if (id < p.triangle_base) {
    const std::uint32_t i = id - p.sphere_base;
    return is_number(g.spheres.x[i]) && is_number(g.spheres.y[i]) && is_number(g.spheres.z[i]) &&
           is_number(g.spheres.radius[i]);
  }
  if (id >= p.cone_base)
    return std::all_of(p.cones.begin(), p.cones.end(), [&](const std::vector<float>& v) {
      return is_number(v[id - p.cone_base]);
    });
  const std::uint32_t i = id - p.triangle_base;
  const auto at = [&](std::uint32_t v) {
    return is_number(g.triangles.x[v]) && is_number(g.triangles.y[v]) &&
           is_number(g.triangles.z[v]);
  };
  return at(g.triangles.a[i]) && at(g.triangles.b[i]) && at(g.triangles.c[i]);
}

/// One group of ids a grid: first what is loose (with small objects), then each larger object.
std::vector<Ids> group(const Primitives& p) {
  std::vector<Ids> groups(1);
  Ids& loose = groups.front();
  std::size_t in_objects = 0;
  for (const Object& o : p.geometry.objects)
    in_objects += o.triangle_count;
  loose.reserve(p.end - p.sphere_base - in_objects);
  for (std::uint32_t id = p.sphere_base; id < p.triangle_base; ++id)
    loose.push_back(id);
  std::uint32_t next = 0;
  const auto take = [&](Ids& to, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i)
      to.push_back(p.triangle_base + i);
  };
  for (const Object& o : p.geometry.objects) {
    take(groups.front(), next, o.first_triangle);
    next = o.first_triangle + o.triangle_count;
    if (o.triangle_count < kSmallObject || groups.size() >= kMostGroups) {
      take(groups.front(), o.first_triangle, next);
    } else {
      groups.emplace_back().reserve(o.triangle_count);
      take(groups.back(), o.first_triangle, next);
    }
  }
  take(groups.front(), next, static_cast<std::uint32_t>(p.geometry.triangles.size()));
  for (std::uint32_t id = p.cone_base; id < p.end; ++id)
    groups.front().push_back(id);
  // What has no place is met by no ray, and would put every cell in doubt.
  if (!all_are_sound(p.geometry))
    for (Ids& ids : groups)
      std::erase_if(ids, [&](std::uint32_t id) { return !is_sound(p, id); });
  std::erase_if(groups, [](const Ids& g) { return g.empty(); });
  return groups;
}

/// Takes primitives as large as all the rest out of a group, again and again while any is: a ground
/// under a teapot, a stadium around that. What is left is of one scale, which is what a uniform
/// grid wants.
Extent set_huge_apart(const Primitives& p, Ids& ids, Extent all, Ids& outside, int threads) {
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
bool set_few_apart(const Primitives& p, Ids& ids, Ids& outside) {
  const auto is_triangle = [&](std::uint32_t id) {
    return id >= p.triangle_base && id < p.cone_base;
  };
  const auto others =
      ids.size() - static_cast<std::size_t>(std::count_if(ids.begin(), ids.end(), is_triangle));
  if (others == 0 || others == ids.size() || others > kFewest ||
      outside.size() + others > kMostOutside)
    return false;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(outside), [&](std::uint32_t id) {
    return !is_triangle(id);
  });
  std::erase_if(ids, [&](std::uint32_t id) { return !is_triangle(id); });
  return true;
}

/// What primitives are grown by for rays that start within `reach` of their box on each axis,
/// `reach` no less than its diagonal. Such rays are at most 1 + sqrt 3 reaches from any of them; a
/// float test is off by at most 62 eps of that distance, and a walk by 32 eps of the reach (derived
/// in docs/numerics.md).
double pad_of(double reach) { return reach * 256 / 16777216; }

/// The grid of some primitives in a scene of that diagonal. Where the pad that rays from all over
/// the scene ask for is large beside the cells, there are two: one with such a pad, and one for the
/// rays that start near, which are most.
void add_grids(const Primitives& p,
               const Ids& ids,
               const Box& box,
               double density,
               double diagonal,
               std::vector<Grid>& grids) {
  const double edge = cell_edge(box, ids.size(), density),
               reach = std::max(box.diagonal(), edge / pad_of(kMostPads));
  if (!(diagonal > kVast * reach)) {
    grids.push_back(lay_out_grid(p, ids, box, density, pad_of(diagonal)));
    return;
  }
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const Serves serves : {Serves::kNear, Serves::kFar}) {
    const double pad = pad_of(serves == Serves::kNear ? reach : diagonal);
    Grid& g = grids.emplace_back(
        lay_out_grid(p, ids, box, density * std::min(1., edge / (kFewestPads * pad)), pad));
    g.serves = serves;
    for (int a = 0; a < 3; ++a) {  // rounded inwards
      g.near_lo[a] = std::nextafter(static_cast<float>(box.lo[a] - reach), infinity);
      g.near_hi[a] = std::nextafter(static_cast<float>(box.hi[a] + reach), -infinity);
    }
  }
}

}  // namespace

int threads_of(const BuildOptions& options) {
  return options.threads > 0 ? options.threads : omp_get_num_procs();
}

Plan plan_grids(const Primitives& p, const BuildOptions& options, BuildProgress& progress) {
  const int threads = threads_of(options);
  Plan plan;
  progress.expect(kPlanShare, 3);
  std::vector<Ids> groups = group(p);
  progress.step();
  progress.throw_if_stopped();
  std::vector<Extent> extents;
  for (const Ids& ids : groups) {
    extents.push_back(extent_of(p, ids, threads));
    plan.all.add(extents.back().box);
  }
  progress.step();
  progress.throw_if_stopped();
  const double diagonal = plan.all.diagonal(),
               density = options.density > 0 ? options.density : kDensity;

  Ids& apart = plan.apart;
  for (std::size_t i = 0; options.grid && i < groups.size(); ++i) {
    Ids ids = std::move(groups[i]);
    Extent extent = set_huge_apart(p, ids, extents[i], apart, threads);
    if (set_few_apart(p, ids, apart))
      extent = extent_of(p, ids, threads);
    if (auto crowds = take_crowds(p, ids, extent.box, density, kMostGroups - groups.size());
        !crowds.empty()) {
      extent = extent_of(p, ids, threads);
      for (Ids& crowd : crowds) {
        extents.push_back(extent_of(p, crowd, threads));
        groups.push_back(std::move(crowd));
      }
    }
    if (ids.size() <= kFewest && apart.size() + ids.size() <= kMostOutside) {
      apart.insert(apart.end(), ids.begin(), ids.end());
    } else if (!ids.empty()) {
      std::vector<Grid> grids;
      add_grids(p, ids, extent.box, density, diagonal, grids);
      plan.parts.push_back({std::move(ids), std::move(grids)});
    }
  }
  if (!options.grid)
    for (const Ids& ids : groups)
      apart.insert(apart.end(), ids.begin(), ids.end());
  std::sort(apart.begin(), apart.end());
  return plan;
}

}  // namespace grelha
