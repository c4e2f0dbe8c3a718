#include "kernel/world/world_impl.hpp"

#include <algorithm>
#include <stdexcept>

#include "kernel/base/thread_pool.hpp"
#include "kernel/shapes/primitives.hpp"
#include "kernel/grid/grid_steps.hpp"
#include "kernel/grid/plan.hpp"
#include "kernel/base/raw_vector.hpp"
#include "kernel/world/visible.hpp"

namespace grelha {
namespace {

/// True if an index is `end` or greater.
bool beyond(Indices indices, std::size_t end) {
  std::uint32_t most = 0;
  for (const std::uint32_t i : indices)
    most = std::max(most, i);
  return !indices.empty() && most >= end;
}

void check(const BuildOptions& o) {
  if (!(o.density >= 0) || o.density == std::numeric_limits<float>::infinity())
    throw std::invalid_argument("density must be a positive number, or 0");
  if (o.threads < 0)
    throw std::invalid_argument("threads must not be negative");
}

/// Throws std::invalid_argument if triangles of a range name what is not there.
void check_indices(const SceneSpans& scene, std::size_t first, std::size_t count) {
  const TriangleSpans& t = scene.geometry.triangles;
  if (beyond(t.material.subspan(first, count), scene.materials.size()))
    throw std::invalid_argument("a primitive names a material that is not there");
  for (const Indices& corner : {t.a, t.b, t.c})
    if (beyond(corner.subspan(first, count), t.vertex_count()))
      throw std::invalid_argument("a triangle names a vertex that is not there");
}

void check_all_indices(const SceneSpans& scene) {
  for_each_shape([&]<class Shape>() {
    if (beyond(Shape::spans_of(scene.geometry).material, scene.materials.size()))
      throw std::invalid_argument("a primitive names a material that is not there");
  });
  check_indices(scene, 0, scene.geometry.triangles.size());
}

/// Looks at what moved since a scene `before` alone, unless there are fewer things to name.
void check(const SceneSpans& scene, const SceneSpans* before, std::span<const Object> moved) {
  const GeometrySpans& g = scene.geometry;
  std::size_t total = 0;
  for_each_shape([&]<class Shape>() {
    const auto& spans = Shape::spans_of(g);
    if (!Shape::is_even(spans))
      throw std::invalid_argument("arrays of one kind of primitive have unequal lengths");
    total += spans.size();
  });
  if (total >= kNoPrimitive)
    throw std::invalid_argument("more primitives than ids: at most 4294967294");
  expect_objects(g);
  for (const Object& o : moved)
    if (std::uint64_t{o.first_triangle} + o.triangle_count > g.triangles.size())
      throw std::invalid_argument("what moved names a triangle that is not there");
  if (!before || before->materials.size() > scene.materials.size() ||
      before->geometry.triangles.vertex_count() > g.triangles.vertex_count()) {
    check_all_indices(scene);
    return;
  }
  for (const Object& o : moved)
    check_indices(scene, o.first_triangle, o.triangle_count);
  const std::size_t old = std::min(before->geometry.triangles.size(), g.triangles.size());
  check_indices(scene, old, g.triangles.size() - old);
}

using SharedIds = std::shared_ptr<const std::vector<std::uint32_t>>;

/// The scene with indices of materials, `zeros` where the caller gave none, checked: what moved
/// since `before`, if that is not null.
SceneSpans completed(SceneSpans scene,
                     SharedIds& zeros,
                     const SceneSpans* before = nullptr,
                     std::span<const Object> moved = {}) {
  static constexpr Material kGrey{.diffuse = {.8f, .8f, .8f}};
  GeometrySpans& g = scene.geometry;
  std::size_t most = 0;
  for_each_shape([&]<class Shape>() {
    if (Shape::spans_of(g).material.empty())
      most = std::max(most, Shape::spans_of(g).size());
  });
  if (!zeros || zeros->size() < most)  // twice as many for what is added to a world
    zeros = std::make_shared<std::vector<std::uint32_t>>(before ? 2 * most : most);
  for_each_shape([&]<class Shape>() {
    auto& spans =
        const_cast<std::remove_cvref_t<decltype(Shape::spans_of(g))>&>(Shape::spans_of(g));
    if (spans.material.empty())
      spans.material = std::span(*zeros).first(spans.size());
  });
  if (scene.materials.empty())
    scene.materials = std::span(&kGrey, 1);
  check(scene, before, moved);
  return scene;
}

}  // namespace

World::Impl::Impl(const SceneSpans& s,
                  const BuildOptions& options,
                  const Impl* before,
                  std::span<const Object> moved)
    : default_material_ids(before ? before->default_material_ids : nullptr),
      scene(completed(s, default_material_ids, before ? &before->scene : nullptr, moved)),
      primitives(scene.geometry),
      materials(scene),
      lights(scene.lights, scene.background) {
  const SpinWaitScope awake;
  BuildProgress progress(options.progress);
  Plan plan = plan_grids(
      primitives, options, progress, before ? before->memory_of_unmoved(moved) : PlanMemory());
  planned = std::move(plan.memory);
  if (options.most_bytes > 0 && !surely_fits(primitives, options.most_bytes))
    if (const BuildMemory need = memory_of(scene, primitives, plan); need.peak > options.most_bytes)
      throw TooLarge(need);
  fill(plan, threads_of(options), progress, before, ids_of(moved));
  outside = build_list(primitives, plan.ungridded);
  progress.finish();
  progress.throw_if_cancelled();
  view_primitives();
  view_grids(plan.all);
  set_materials();
  lights.show(materials, shading);
}

std::size_t World::Impl::bytes() const {
  std::size_t sum = outside.bytes() + copies.size() * sizeof(Copy);
  for (const auto* const some : {&grids, &hidden})
    for (const auto& g : *some)
      sum += g->grid.stats().bytes;
  for_each_shape(
      [&]<class Shape>() { sum += Shape::Source::kSetupBytes * primitives.of<Shape>().size(); });
  return sum;
}

void World::Impl::view_primitives() {
  view.geometry.ids = primitives.ids;
  for_each_shape([&]<class Shape>() {
    typename Shape::Arrays& arrays = view.geometry.of<Shape>();
    arrays = primitives.of<Shape>().arrays();
  });
  view.outside = outside.lists();
  if (const Triangle::CellList& list = view.outside.of<Triangle>(); list.first)
    for (std::uint32_t b = 0; b < list.first[1] && b < kBlock; ++b)
      set_bounds(list.blocks[b], view.outside_boxes, b);
  view_copies();
}

void World::Impl::view_copies() {
  const auto add = [&](const std::vector<Copy>& some) {
    copies.insert(copies.end(), some.begin(), some.end());
  };
  add(find_last_copies(scene.geometry.planes));
  view.geometry.of<Plane>().count -= static_cast<std::uint32_t>(copies.size());
  add(outside.copies);
  for (const auto& g : grids)
    add(g->grid.store.copies);
  std::sort(copies.begin(), copies.end());
  view.copies = {copies.data(), static_cast<std::uint32_t>(copies.size())};
}

void World::Impl::view_grids(const Box& all) {
  for (const auto& g : grids)
    grid_views.push_back(g->grid.view());
  view.grids = grid_views.data();
  view.grid_count = static_cast<int>(grid_views.size());
  view.finite = !all.empty();
  if (!view.finite)
    return;
  for (int a = 0; a < 3; ++a) {
    view.box_lo[a] = static_cast<float>(all.lo[a]);
    view.box_hi[a] = static_cast<float>(all.hi[a]);
  }
}

void World::Impl::set_materials() {
  shading.materials = materials.view();
  shading.smooth = !scene.geometry.triangles.nx.empty();
  shading.colored = !scene.geometry.triangles.red.empty();
  shading.gains = materials.gains;
  shading.reflects = materials.reflects;
  shading.refracts = materials.refracts;
  shading.fresnel = materials.fresnel;
  shading.emits = materials.emits;
  shading.highlights = materials.highlights;
  shading.glossy = materials.glossy;
}

std::vector<IdRange> World::Impl::ids_of(std::span<const Object> objects) const {
  const std::uint32_t first = primitives.ids.begin(PrimitiveKind::kTriangle);
  std::vector<IdRange> ranges;
  for (const Object& o : objects)
    ranges.push_back({first + o.first_triangle, first + o.first_triangle + o.triangle_count});
  return ranges;
}

/// What planning anew may keep where some triangles moved.
PlanMemory World::Impl::memory_of_unmoved(std::span<const Object> moved) const {
  PlanMemory kept = planned;
  kept.own.insert(kept.own.begin(), moved.begin(), moved.end());
  kept.changed = ids_of(moved);
  std::erase_if(kept.groups,
                [&](const PlannedGroup& group) { return overlap(group.ids, kept.changed); });
  return kept;
}

/// A grid of the same layout over primitives of the same ids, or null.
World::Impl::SharedGrid World::Impl::find_same(const BuiltGrid& wanted) const {
  if (!wanted.ids.empty())
    for (const auto* const some : {&grids, &hidden})
      for (const SharedGrid& built : *some)
        if (built->ids == wanted.ids && built->grid.has_layout_of(wanted.grid))
          return built;
  return nullptr;
}

/// Keeps grids of hidden objects, so that they can be shown again.
void World::Impl::keep_hidden(const Impl& before, std::span<const IdRange> moved) {
  std::vector<Object> objects(scene.geometry.objects.begin(), scene.geometry.objects.end());
  std::erase_if(objects, [](const Object& o) { return o.visible; });
  for (const IdRange& out : ids_of(objects))
    for (const auto* const some : {&before.grids, &before.hidden})
      for (const SharedGrid& built : *some)
        if (built->ids.size() == 1 && built->ids[0].first >= out.first &&
            built->ids[0].end <= out.end && !overlap(built->ids, moved))
          hidden.push_back(built);
}

/// The plan's grids, each part's ids gone when they are done with.
void World::Impl::fill(Plan& plan,
                       int threads,
                       BuildProgress& progress,
                       const Impl* before,
                       std::span<const IdRange> moved) {
  if (before)
    keep_hidden(*before, moved);
  double work = 0;
  for (const GridPlan& part : plan.parts)
    work += static_cast<double>(part.ids.size());
  for (GridPlan& part : plan.parts) {
    progress.throw_if_cancelled();
    BuiltGrid built{std::move(part.grid), part.ids.short_ranges()};
    SharedGrid shared;
    if (before && !overlap(built.ids, moved))
      shared = before->find_same(built);
    if (!shared) {
      const std::vector<std::uint32_t> ids = part.ids.take_list();
      const double share = (1 - kPlanShare) * static_cast<double>(ids.size()) / work;
      fill_grid(primitives, ids, built.grid, threads, progress, share);
      shared = std::make_shared<const BuiltGrid>(std::move(built));
    }
    grids.push_back(std::move(shared));
  }
}

BuildMemory World::estimate(const SceneSpans& scene, const BuildOptions& options) {
  SharedIds zeros;
  const SceneSpans whole = completed(scene, zeros);
  check(options);
  const Primitives primitives(whole.geometry);
  BuildProgress nobody;
  return memory_of(whole, primitives, plan_grids(primitives, options, nobody));
}

World::World(const SceneSpans& scene, const BuildOptions& options)
    : impl_((check(options), std::make_unique<Impl>(scene, options))) {}
World::World(const SceneSpans& scene,
             const BuildOptions& options,
             const World& before,
             std::span<const Object> moved)
    : impl_((check(options), std::make_unique<Impl>(scene, options, before.impl_.get(), moved))) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::update(const SceneSpans& scene, const BuildOptions& options) {
  *this = World(scene, options);
}

void World::update(const SceneSpans& scene,
                   const BuildOptions& options,
                   std::span<const Object> moved) {
  *this = World(scene, options, *this, moved);
}

std::vector<GridStats> World::grids() const {
  std::vector<GridStats> out;
  for (const auto& g : impl_->grids)
    out.push_back(g->grid.stats());
  return out;
}

std::size_t World::geometry_bytes() const {
  std::size_t sum = 0;
  for_each_shape(
      [&]<class Shape>() { sum += Shape::bytes(Shape::spans_of(impl_->scene.geometry)); });
  return sum;
}

std::size_t World::grid_bytes() const {
  return impl_->bytes();
}

}  // namespace grelha
