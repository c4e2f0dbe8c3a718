#include "kernel/grid/world_impl.hpp"

#include <algorithm>
#include <stdexcept>

#include "kernel/shapes/copies.hpp"
#include "kernel/grid/grid_fill.hpp"
#include "kernel/grid/memory_estimate.hpp"
#include "kernel/grid/plan.hpp"
#include "kernel/scene/raw_vector.hpp"

namespace grelha {
namespace {

/// Whether an index reaches `end`.
bool beyond(Indices indices, std::size_t end) {
  std::uint32_t most = 0;
  for (const std::uint32_t i : indices)
    most = std::max(most, i);
  return !indices.empty() && most >= end;
}

/// Whether arrays of one kind have one length.
bool uneven(std::size_t count, std::initializer_list<std::size_t> sizes) {
  return std::any_of(
      sizes.begin(), sizes.end(), [count](std::size_t size) { return size != count; });
}

void check_lengths(const GeometrySpans& g) {
  const SphereSpans& s = g.spheres;
  const TriangleSpans& t = g.triangles;
  const ConeSpans& c = g.cones;
  const PlaneSpans& p = g.planes;
  if (uneven(s.size(), {s.x.size(), s.y.size(), s.z.size(), s.material.size()}) ||
      uneven(t.size(), {t.b.size(), t.c.size(), t.material.size()}) ||
      uneven(t.vertex_count(), {t.y.size(), t.z.size()}) ||
      uneven(t.nx.empty() ? 0 : t.vertex_count(), {t.nx.size(), t.ny.size(), t.nz.size()}) ||
      uneven(c.size(),
             {c.base_x.size(),
              c.base_y.size(),
              c.base_z.size(),
              c.base_radius.size(),
              c.apex_x.size(),
              c.apex_y.size(),
              c.apex_z.size(),
              c.apex_radius.size()}) ||
      uneven(p.size(), {p.x.size(), p.y.size(), p.z.size(), p.nx.size(), p.ny.size(), p.nz.size()}))
    throw std::invalid_argument("arrays of one kind of primitive have unequal lengths");
}

void check(const BuildOptions& o) {
  if (!(o.density >= 0) || o.density == std::numeric_limits<float>::infinity())
    throw std::invalid_argument("density must be a positive number, or 0");
  if (o.threads < 0)
    throw std::invalid_argument("threads must not be negative");
}

void check(const SceneSpans& scene) {
  const GeometrySpans& g = scene.geometry;
  check_lengths(g);
  const std::size_t total =
      g.spheres.size() + g.triangles.size() + g.cones.size() + g.planes.size();
  if (total >= kNoPrimitive)
    throw std::invalid_argument("more primitives than ids: at most 4294967294");
  const auto materials = scene.materials.size();
  for (const auto* m :
       {&g.spheres.material, &g.triangles.material, &g.cones.material, &g.planes.material})
    if (beyond(*m, materials))
      throw std::invalid_argument("a primitive names a material that is not there");
  const auto vertices = g.triangles.vertex_count();
  for (const auto* v : {&g.triangles.a, &g.triangles.b, &g.triangles.c})
    if (beyond(*v, vertices))
      throw std::invalid_argument("a triangle names a vertex that is not there");
  std::uint64_t next = 0;
  for (const Object& o : g.objects) {
    if (o.first_triangle < next)
      throw std::invalid_argument("objects must be disjoint and ascend");
    next = std::uint64_t{o.first_triangle} + o.triangle_count;
  }
  if (next > g.triangles.size())
    throw std::invalid_argument("an object names a triangle that is not there");
}

}  // namespace

World::Impl::Impl(const SceneSpans& s, const BuildOptions& options)
    : scene((check(s), s)), primitives(s.geometry), materials(s) {
  const GeometrySpans& g = s.geometry;
  BuildProgress progress(options.progress);
  Plan plan = plan_grids(primitives, options, progress);
  if (options.most_bytes > 0 && !surely_fits(primitives, options.most_bytes))
    if (const BuildMemory need = memory_of(s, primitives, plan); need.peak > options.most_bytes)
      throw TooLarge(need);
  fill(plan, threads_of(options), progress);
  outside = build_list(primitives, plan.apart);
  progress.finish();
  progress.throw_if_stopped();
  for (const Grid& grid : grids)
    grid_views.push_back(grid.view());

  GeometryView& v = view.geometry;
  const TriangleSpans& t = g.triangles;
  v.tx = t.x.data();
  v.ty = t.y.data();
  v.tz = t.z.data();
  if (!t.nx.empty()) {
    v.tnx = t.nx.data();
    v.tny = t.ny.data();
    v.tnz = t.nz.data();
  }
  v.ta = t.a.data();
  v.tb = t.b.data();
  v.tc = t.c.data();
  v.sx = g.spheres.x.data();
  v.sy = g.spheres.y.data();
  v.sz = g.spheres.z.data();
  v.sr = g.spheres.radius.data();
  for (std::size_t k = 0; k < 10; ++k)
    v.cone[k] = primitives.cones[k].data();
  v.px = g.planes.x.data();
  v.py = g.planes.y.data();
  v.pz = g.planes.z.data();
  v.pnx = g.planes.nx.data();
  v.pny = g.planes.ny.data();
  v.pnz = g.planes.nz.data();
  v.plane_material = g.planes.material.data();
  v.sphere_material = g.spheres.material.data();
  v.triangle_material = t.material.data();
  v.cone_material = g.cones.material.data();
  v.plane_count = planes_without_copies(g.planes);
  v.sphere_count = primitives.triangle_base - primitives.sphere_base;
  v.triangle_count = primitives.cone_base - primitives.triangle_base;
  v.cone_count = primitives.end - primitives.cone_base;
  view.outside = outside.lists();
  view.grids = grid_views.data();
  view.grid_count = static_cast<int>(grid_views.size());
  view.sphere_base = primitives.sphere_base;
  view.triangle_base = primitives.triangle_base;
  view.cone_base = primitives.cone_base;
  view.primitive_end = primitives.end;
  view.finite = !plan.all.empty();
  if (view.finite) {
    for (int a = 0; a < 3; ++a) {
      view.box_lo[a] = static_cast<float>(plan.all.lo[a]);
      view.box_hi[a] = static_cast<float>(plan.all.hi[a]);
    }
    view.reach = static_cast<float>(plan.all.diagonal());
  }

  for (const Light& l : s.lights) {
    for (const Float3& part : {l.position, l.color, l.edge1, l.edge2})
      lights.insert(lights.end(), {part.x, part.y, part.z});
    shading.area |= l.is_area();
  }
  float light = 0;
  for (const Light& l : s.lights)
    light += largest_channel(l.color);
  shading.brightest =
      std::max(largest_channel(s.background), materials.emitted + materials.lit * light);
  shading.gains = materials.gains;
  shading.materials = materials.view();
  shading.lights = lights.data();
  shading.light_count = static_cast<int>(s.lights.size());
  shading.background[0] = s.background.x;
  shading.background[1] = s.background.y;
  shading.background[2] = s.background.z;
  shading.smooth = !t.nx.empty();
  shading.reflects = materials.reflects;
  shading.refracts = materials.refracts;
  shading.fresnel = materials.fresnel;
  shading.emits = materials.emits;
  shading.highlights = materials.highlights;
  shading.gloss = materials.gloss;
}

/// The plan's grids, each part's ids gone when they are done with.
void World::Impl::fill(Plan& plan, int threads, BuildProgress& progress) {
  double work = 0;
  for (const PlannedGrids& part : plan.parts)
    work += static_cast<double>(part.ids.size() * part.grids.size());
  for (PlannedGrids& part : plan.parts) {
    const std::vector<std::uint32_t> ids = std::move(part.ids);
    for (Grid& g : part.grids) {
      progress.throw_if_stopped();
      grids.push_back(std::move(g));
      fill_grid(primitives,
                ids,
                grids.back(),
                threads,
                progress,
                (1 - kPlanShare) * static_cast<double>(ids.size()) / work);
    }
  }
}

BuildMemory World::estimate(const SceneSpans& scene, const BuildOptions& options) {
  check(scene);
  check(options);
  const Primitives primitives(scene.geometry);
  BuildProgress nobody;
  return memory_of(scene, primitives, plan_grids(primitives, options, nobody));
}

World::World(const SceneSpans& scene, const BuildOptions& options)
    : impl_((check(options), std::make_unique<Impl>(scene, options))) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

std::vector<GridStats> World::grids() const {
  std::vector<GridStats> out;
  for (const Grid& g : impl_->grids)
    out.push_back(g.stats());
  return out;
}

std::size_t World::geometry_bytes() const {
  const GeometrySpans& g = impl_->scene.geometry;
  const TriangleSpans& t = g.triangles;
  std::size_t sum =
      bytes_of(t.a) * 3 + bytes_of(t.material) + bytes_of(t.x) * 3 + bytes_of(t.nx) * 3;
  sum += bytes_of(g.spheres.radius) * 5 + bytes_of(g.cones.material) * 9 +
         bytes_of(g.planes.material) * 7;
  return sum;
}

std::size_t World::grid_bytes() const {
  std::size_t sum = impl_->outside.bytes();
  for (const Grid& g : impl_->grids)
    sum += g.stats().bytes;
  for (const auto& v : impl_->primitives.cones)
    sum += bytes_of(v);
  return sum;
}

}  // namespace grelha
