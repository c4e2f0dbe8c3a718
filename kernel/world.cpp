#include "kernel/world.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <omp.h>

#include "kernel/crowds.hpp"

namespace grelha {
namespace {

constexpr std::size_t kFewest = 8;        ///< so few primitives are faster looped over than walked through
constexpr std::size_t kMostOutside = 32;  ///< primitives without a grid, each met by every ray
constexpr std::size_t kSmallObject = 256; ///< triangles; smaller objects share the grid of the loose ones
constexpr double kHuge = .5;              ///< of the diagonal of what it lies among: larger primitives get no grid
constexpr double kMostPads = 64;          ///< a cell, of a grid for near rays: more would not make its lists shorter
constexpr double kFewestPads = 8;         ///< a cell, of a grid for far rays: with fewer, lists are long, and no faster
constexpr double kVast = 4;               ///< scenes so many times as wide as near rays reach have both: in others it would gain little
constexpr double kDensity = .7;           ///< M; packets like it coarser than the report's 2 (docs/performance.md)

using Ids = std::vector<std::uint32_t>;

/// A NaN or an infinity: all bits of the exponent set.
bool is_number(float x) { return (std::bit_cast<std::uint32_t>(x) & 0x7F800000u) != 0x7F800000u; }
bool are_numbers(Floats v) {
  std::uint32_t found = 0;
  for (const float x : v) found |= is_number(x) ? 0 : 1;
  return found == 0;
}

/// Whether every primitive has a place. The arrays are asked as they lie, many at a time.
bool all_are_sound(const GeometrySpans& g) {
  for (const auto* v : {&g.triangles.x, &g.triangles.y, &g.triangles.z, &g.spheres.x, &g.spheres.y, &g.spheres.z, &g.spheres.radius,
                        &g.cones.base_x, &g.cones.base_y, &g.cones.base_z, &g.cones.base_radius, &g.cones.apex_x, &g.cones.apex_y,
                        &g.cones.apex_z, &g.cones.apex_radius})
    if (!are_numbers(*v)) return false;
  return true;
}

bool is_sound(const Primitives& p, std::uint32_t id) {
  const GeometrySpans& g = p.geometry;
  if (id < p.triangle_base) {
    const std::uint32_t i = id - p.sphere_base;
    return is_number(g.spheres.x[i]) && is_number(g.spheres.y[i]) && is_number(g.spheres.z[i]) && is_number(g.spheres.radius[i]);
  }
  if (id >= p.cone_base)
    return std::all_of(p.cones.begin(), p.cones.end(), [&](const std::vector<float>& v) { return is_number(v[id - p.cone_base]); });
  const std::uint32_t i = id - p.triangle_base;
  const auto at = [&](std::uint32_t v) { return is_number(g.triangles.x[v]) && is_number(g.triangles.y[v]) && is_number(g.triangles.z[v]); };
  return at(g.triangles.a[i]) && at(g.triangles.b[i]) && at(g.triangles.c[i]);
}

/// One group of ids a grid: first what is loose (with small objects), then each larger object.
std::vector<Ids> group(const Primitives& p) {
  std::vector<Ids> groups(1);
  Ids& loose = groups.front();
  for (std::uint32_t id = p.sphere_base; id < p.triangle_base; ++id) loose.push_back(id);
  std::uint32_t next = 0;
  const auto take = [&](Ids& to, std::uint32_t first, std::uint32_t end) {
    for (std::uint32_t i = first; i < end; ++i) to.push_back(p.triangle_base + i);
  };
  for (const Object& o : p.geometry.objects) {
    take(groups.front(), next, o.first_triangle);
    next = o.first_triangle + o.triangle_count;
    if (o.triangle_count < kSmallObject || groups.size() >= kMostGroups) {
      take(groups.front(), o.first_triangle, next);
    } else {
      groups.emplace_back();
      take(groups.back(), o.first_triangle, next);
    }
  }
  take(groups.front(), next, static_cast<std::uint32_t>(p.geometry.triangles.size()));
  for (std::uint32_t id = p.cone_base; id < p.end; ++id) groups.front().push_back(id);
  // What has no place is met by no ray, and would put every cell in doubt.
  if (!all_are_sound(p.geometry))
    for (Ids& ids : groups) std::erase_if(ids, [&](std::uint32_t id) { return !is_sound(p, id); });
  std::erase_if(groups, [](const Ids& g) { return g.empty(); });
  return groups;
}

/// Takes primitives as large as all the rest out of a group, again and again while any is: a ground under a teapot, a
/// stadium around that. What is left is of one scale, which is what a uniform grid wants.
Extent set_huge_apart(const Primitives& p, Ids& ids, Extent all, Ids& outside, int threads) {
  for (;; all = extent_of(p, ids, threads)) {
    const double huge = kHuge * all.box.diagonal();
    if (!(all.longest > huge)) return all;
    const Ids large = longer_than(p, ids, huge, kMostOutside, threads);
    if (large.empty() || outside.size() + large.size() > kMostOutside) return all;
    outside.insert(outside.end(), large.begin(), large.end());
    std::erase_if(ids, [&](std::uint32_t id) { return std::binary_search(large.begin(), large.end(), id); });
  }
}

/// A handful of round things among many triangles: a loop over them costs less than asking every cell for its share.
bool set_few_apart(const Primitives& p, Ids& ids, Ids& outside) {
  const auto is_triangle = [&](std::uint32_t id) { return id >= p.triangle_base && id < p.cone_base; };
  const auto others = ids.size() - static_cast<std::size_t>(std::count_if(ids.begin(), ids.end(), is_triangle));
  if (others == 0 || others == ids.size() || others > kFewest || outside.size() + others > kMostOutside) return false;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(outside), [&](std::uint32_t id) { return !is_triangle(id); });
  std::erase_if(ids, [&](std::uint32_t id) { return !is_triangle(id); });
  return true;
}

/// What primitives are grown by for rays that start within `reach` of their box on each axis, `reach` no less than its diagonal. Such
/// rays are at most 1 + sqrt 3 reaches from any of them; a float test is off by at most 62 eps of that distance, and a walk by 32 eps of the
/// reach (derived in docs/numerics.md).
double pad_of(double reach) { return reach * 256 / 16777216; }

/// The grid of some primitives in a scene of that diagonal. Where the pad that rays from all over the scene ask for is large beside
/// the cells, there are two: one with such a pad, and one for the rays that start near, which are most.
void add_grids(const Primitives& p, const Ids& ids, const Box& box, double density, double diagonal, int threads, std::vector<Grid>& grids) {
  const double edge = cell_edge(box, ids.size(), density), reach = std::max(box.diagonal(), edge / pad_of(kMostPads));
  if (!(diagonal > kVast * reach)) {
    grids.push_back(build_grid(p, ids, box, density, pad_of(diagonal), threads));
    return;
  }
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const Serves serves : {Serves::kNear, Serves::kFar}) {
    const double pad = pad_of(serves == Serves::kNear ? reach : diagonal);
    Grid& g = grids.emplace_back(build_grid(p, ids, box, density * std::min(1., edge / (kFewestPads * pad)), pad, threads));
    g.serves = serves;
    for (int a = 0; a < 3; ++a) {  // rounded inwards
      g.near_lo[a] = std::nextafter(static_cast<float>(box.lo[a] - reach), infinity);
      g.near_hi[a] = std::nextafter(static_cast<float>(box.hi[a] + reach), -infinity);
    }
  }
}

/// Whether an index reaches `end`.
bool beyond(Indices indices, std::size_t end) {
  std::uint32_t most = 0;
  for (const std::uint32_t i : indices) most = std::max(most, i);
  return !indices.empty() && most >= end;
}

/// Whether arrays of one kind have one length.
bool uneven(std::size_t count, std::initializer_list<std::size_t> sizes) {
  return std::any_of(sizes.begin(), sizes.end(), [count](std::size_t size) { return size != count; });
}

void check_lengths(const GeometrySpans& g) {
  const SphereSpans& s = g.spheres;
  const TriangleSpans& t = g.triangles;
  const ConeSpans& c = g.cones;
  const PlaneSpans& p = g.planes;
  if (uneven(s.size(), {s.x.size(), s.y.size(), s.z.size(), s.material.size()}) ||
      uneven(t.size(), {t.b.size(), t.c.size(), t.material.size()}) || uneven(t.vertex_count(), {t.y.size(), t.z.size()}) ||
      uneven(t.nx.empty() ? 0 : t.vertex_count(), {t.nx.size(), t.ny.size(), t.nz.size()}) ||
      uneven(c.size(), {c.base_x.size(), c.base_y.size(), c.base_z.size(), c.base_radius.size(), c.apex_x.size(), c.apex_y.size(),
                        c.apex_z.size(), c.apex_radius.size()}) ||
      uneven(p.size(), {p.x.size(), p.y.size(), p.z.size(), p.nx.size(), p.ny.size(), p.nz.size()}))
    throw std::invalid_argument("arrays of one kind of primitive have unequal lengths");
}

void check(const SceneSpans& scene) {
  const GeometrySpans& g = scene.geometry;
  check_lengths(g);
  const std::size_t total = g.spheres.size() + g.triangles.size() + g.cones.size() + g.planes.size();
  if (total >= kNoPrimitive) throw std::invalid_argument("more primitives than ids: at most 4294967294");
  const auto materials = scene.materials.size();
  for (const auto* m : {&g.spheres.material, &g.triangles.material, &g.cones.material, &g.planes.material})
    if (beyond(*m, materials)) throw std::invalid_argument("a primitive names a material that is not there");
  const auto vertices = g.triangles.vertex_count();
  for (const auto* v : {&g.triangles.a, &g.triangles.b, &g.triangles.c})
    if (beyond(*v, vertices)) throw std::invalid_argument("a triangle names a vertex that is not there");
  std::uint64_t next = 0;
  for (const Object& o : g.objects) {
    if (o.first_triangle < next) throw std::invalid_argument("objects must be disjoint and ascend");
    next = std::uint64_t{o.first_triangle} + o.triangle_count;
  }
  if (next > g.triangles.size()) throw std::invalid_argument("an object names a triangle that is not there");
}

template <class V>
std::size_t bytes_of(const V& v) {
  return v.size() * sizeof v[0];
}

}  // namespace

MaterialTable::MaterialTable(std::span<const Material> materials) {
  for (auto& f : fields) f.resize(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    const bool clear = m.transmission > 0;
    const float values[kMaterialFields] = {m.diffuse.x,  m.diffuse.y,  m.diffuse.z,  m.specular.x, m.specular.y, m.specular.z,
                                           m.mirror.x,   m.mirror.y,   m.mirror.z,   m.emission.x, m.emission.y, m.emission.z,
                                           m.transmission, m.shine,    clear ? m.ior : 1.f, clear && m.fresnel ? 1.f : 0.f,
                                           m.roughness};
    for (std::size_t k = 0; k < kMaterialFields; ++k) fields[k][i] = values[k];
    reflects |= clear || m.mirror != Float3{};
    refracts |= clear;
    fresnel |= clear && m.fresnel;
    emits |= m.emission != Float3{};
    highlights |= m.specular != Float3{};
    gloss |= m.roughness > 0 && (clear || m.mirror != Float3{});
  }
}

MaterialView MaterialTable::view() const {
  MaterialView v;
  for (std::size_t k = 0; k < kMaterialFields; ++k) v.field[k] = fields[k].data();
  return v;
}

World::Impl::Impl(const SceneSpans& s, const BuildOptions& options) : scene((check(s), s)), primitives(s.geometry), materials(s.materials) {
  const GeometrySpans& g = s.geometry;
  const int threads = options.threads > 0 ? options.threads : omp_get_num_procs();
  std::vector<Ids> groups = group(primitives);
  std::vector<Extent> extents;
  Box all;
  for (const Ids& ids : groups) {
    extents.push_back(extent_of(primitives, ids, threads));
    all.add(extents.back().box);
  }
  const double diagonal = all.diagonal(), density = options.density > 0 ? options.density : kDensity;

  Ids apart;
  if (options.grid) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      Ids ids = std::move(groups[i]);
      Extent extent = set_huge_apart(primitives, ids, extents[i], apart, threads);
      if (set_few_apart(primitives, ids, apart)) extent = extent_of(primitives, ids, threads);
      if (auto crowds = take_crowds(primitives, ids, extent.box, density, kMostGroups - groups.size()); !crowds.empty()) {
        extent = extent_of(primitives, ids, threads);
        for (Ids& crowd : crowds) {
          extents.push_back(extent_of(primitives, crowd, threads));
          groups.push_back(std::move(crowd));
        }
      }
      if (ids.size() <= kFewest && apart.size() + ids.size() <= kMostOutside) {
        apart.insert(apart.end(), ids.begin(), ids.end());
      } else if (!ids.empty()) {
        add_grids(primitives, ids, extent.box, density, diagonal, threads, grids);
      }
    }
  } else {
    for (const Ids& ids : groups) apart.insert(apart.end(), ids.begin(), ids.end());
  }
  std::sort(apart.begin(), apart.end());
  outside = build_list(primitives, apart);
  for (const Grid& grid : grids) grid_views.push_back(grid.view());

  GeometryView& v = view.geometry;
  const TriangleSpans& t = g.triangles;
  v.tx = t.x.data(), v.ty = t.y.data(), v.tz = t.z.data();
  if (!t.nx.empty()) v.tnx = t.nx.data(), v.tny = t.ny.data(), v.tnz = t.nz.data();
  v.ta = t.a.data(), v.tb = t.b.data(), v.tc = t.c.data();
  v.sx = g.spheres.x.data(), v.sy = g.spheres.y.data(), v.sz = g.spheres.z.data(), v.sr = g.spheres.radius.data();
  for (std::size_t k = 0; k < 10; ++k) v.cone[k] = primitives.cones[k].data();
  v.px = g.planes.x.data(), v.py = g.planes.y.data(), v.pz = g.planes.z.data();
  v.pnx = g.planes.nx.data(), v.pny = g.planes.ny.data(), v.pnz = g.planes.nz.data();
  v.plane_material = g.planes.material.data(), v.sphere_material = g.spheres.material.data();
  v.triangle_material = t.material.data(), v.cone_material = g.cones.material.data();
  v.plane_count = primitives.sphere_base;
  v.sphere_count = primitives.triangle_base - primitives.sphere_base;
  v.triangle_count = primitives.cone_base - primitives.triangle_base;
  v.cone_count = primitives.end - primitives.cone_base;
  view.outside = outside.lists();
  view.grids = grid_views.data(), view.grid_count = static_cast<int>(grid_views.size());
  view.sphere_base = primitives.sphere_base, view.triangle_base = primitives.triangle_base;
  view.cone_base = primitives.cone_base, view.primitive_end = primitives.end;
  view.finite = !all.empty();
  if (view.finite) {
    for (int a = 0; a < 3; ++a) view.box_lo[a] = static_cast<float>(all.lo[a]), view.box_hi[a] = static_cast<float>(all.hi[a]);
    view.reach = static_cast<float>(diagonal);
  }

  for (const Light& l : s.lights) {
    for (const Float3& part : {l.position, l.color, l.edge1, l.edge2}) lights.insert(lights.end(), {part.x, part.y, part.z});
    shading.area |= l.is_area();
  }
  shading.materials = materials.view();
  shading.lights = lights.data(), shading.light_count = static_cast<int>(s.lights.size());
  shading.background[0] = s.background.x, shading.background[1] = s.background.y, shading.background[2] = s.background.z;
  shading.smooth = !t.nx.empty();
  shading.reflects = materials.reflects, shading.refracts = materials.refracts, shading.fresnel = materials.fresnel;
  shading.emits = materials.emits, shading.highlights = materials.highlights, shading.gloss = materials.gloss;
}

World::World(const SceneSpans& scene, const BuildOptions& options) {
  if (!(options.density >= 0) || options.density == std::numeric_limits<float>::infinity())
    throw std::invalid_argument("density must be a positive number, or 0");
  if (options.threads < 0) throw std::invalid_argument("threads must not be negative");
  impl_ = std::make_unique<Impl>(scene, options);
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

std::vector<GridStats> World::grids() const {
  std::vector<GridStats> out;
  for (const Grid& g : impl_->grids) out.push_back(g.stats());
  return out;
}

std::size_t World::geometry_bytes() const {
  const GeometrySpans& g = impl_->scene.geometry;
  const TriangleSpans& t = g.triangles;
  std::size_t sum = bytes_of(t.a) * 3 + bytes_of(t.material) + bytes_of(t.x) * 3 + bytes_of(t.nx) * 3;
  sum += bytes_of(g.spheres.radius) * 5 + bytes_of(g.cones.material) * 9 + bytes_of(g.planes.material) * 7;
  return sum;
}

std::size_t World::grid_bytes() const {
  std::size_t sum = impl_->outside.bytes();
  for (const Grid& g : impl_->grids) sum += g.stats().bytes;
  for (const auto& v : impl_->primitives.cones) sum += bytes_of(v);
  return sum;
}

}  // namespace grelha
