#include "kernel/grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grelha {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A cube root from + - * / alone, so that resolutions agree between machines; Newton's steps until they stop falling.
double cube_root(double x) {
  double r = x > 1 ? x : 1;
  for (;;) {
    const double next = r - (r - x / (r * r)) / 3;
    if (!(next < r)) return r;
    r = next;
  }
}

enum class Kind { kSphere, kTriangle, kCone };

Kind kind_of(const Primitives& p, std::uint32_t id) {
  return id < p.triangle_base ? Kind::kSphere : id < p.cone_base ? Kind::kTriangle : Kind::kCone;
}

struct Corners {
  double v[3][3];
};

Corners corners_of(const Primitives& p, std::uint32_t id) {
  const Triangles& t = p.geometry.triangles;
  const std::uint32_t i = id - p.triangle_base, v[3] = {t.a[i], t.b[i], t.c[i]};
  Corners c;
  for (int k = 0; k < 3; ++k) c.v[k][0] = t.x[v[k]], c.v[k][1] = t.y[v[k]], c.v[k][2] = t.z[v[k]];
  return c;
}

/// Whether a cell is nearer than pad to the plane of a triangle, or to a ball: what a box alone cannot tell.
class Touch {
 public:
  Touch(const Primitives& p, std::uint32_t id, const Grid& g, double pad) : kind_(kind_of(p, id)) {
    for (int a = 0; a < 3; ++a) cell_[a] = g.cell[a], lo_[a] = g.lo[a];
    if (kind_ == Kind::kTriangle) {
      const Corners c = corners_of(p, id);
      double e[3], f[3];
      for (int a = 0; a < 3; ++a) e[a] = c.v[1][a] - c.v[0][a], f[a] = c.v[2][a] - c.v[0][a];
      double sum = 0;
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, d = (a + 2) % 3;
        n_[a] = e[b] * f[d] - e[d] * f[b];
        sum += std::abs(n_[a]);
      }
      offset_ = 0;
      reach_ = sum * pad;
      for (int a = 0; a < 3; ++a) {
        offset_ += n_[a] * (c.v[0][a] - lo_[a]);
        reach_ += std::abs(n_[a]) * cell_[a] / 2;
      }
      reach_ += std::abs(offset_) * 1e-12;
    } else if (kind_ == Kind::kSphere) {
      const Spheres& s = p.geometry.spheres;
      const std::uint32_t i = id - p.sphere_base;
      n_[0] = s.x[i] - lo_[0], n_[1] = s.y[i] - lo_[1], n_[2] = s.z[i] - lo_[2];
      const double r = std::abs(static_cast<double>(s.radius[i])) + pad;
      const double inner = std::abs(static_cast<double>(s.radius[i])) - pad;
      reach_ = r * r * (1 + 1e-12);
      inner_ = inner > 0 ? inner * inner * (1 - 1e-12) : -1;
    }
  }

  bool operator()(const int (&at)[3]) const {
    if (kind_ == Kind::kTriangle) {
      double s = -offset_;
      for (int a = 0; a < 3; ++a) s += n_[a] * ((at[a] + .5) * cell_[a]);
      return std::abs(s) <= reach_;
    }
    if (kind_ == Kind::kSphere) {  // the surface crosses the cell: nearest point inside, farthest outside
      double near = 0, far = 0;
      for (int a = 0; a < 3; ++a) {
        const double lo = at[a] * cell_[a] - n_[a], hi = (at[a] + 1) * cell_[a] - n_[a];
        const double least = lo > 0 ? lo : hi < 0 ? -hi : 0, most = std::max(std::abs(lo), std::abs(hi));
        near += least * least, far += most * most;
      }
      return near <= reach_ && far >= inner_;
    }
    return true;
  }

 private:
  Kind kind_;
  double cell_[3], lo_[3], n_[3] = {}, offset_ = 0, reach_ = 0, inner_ = -1;
};

/// Calls visit(cell) for every cell the primitive is to stand in, ascending.
template <class Visit>
void each_cell(const Primitives& p, const Grid& g, std::uint32_t id, double pad, const Visit& visit) {
  Box b = p.box(id);
  b.grow(pad);
  int lo[3], hi[3];
  bool several = false;
  for (int a = 0; a < 3; ++a) {
    const int n = static_cast<int>(g.cells[a]);
    lo[a] = cell_of(b.lo[a], g.lo[a], 1 / g.cell[a], n), hi[a] = cell_of(b.hi[a], g.lo[a], 1 / g.cell[a], n);
    several |= hi[a] > lo[a];
  }
  const std::size_t nx = g.cells[0], nxy = nx * g.cells[1];
  if (!several) return visit(lo[0] + nx * static_cast<std::size_t>(lo[1]) + nxy * static_cast<std::size_t>(lo[2]));
  const Touch touch(p, id, g, pad);
  for (int z = lo[2]; z <= hi[2]; ++z)
    for (int y = lo[1]; y <= hi[1]; ++y)
      for (int x = lo[0]; x <= hi[0]; ++x)
        if (touch({x, y, z})) visit(x + nx * static_cast<std::size_t>(y) + nxy * static_cast<std::size_t>(z));
}

void put_triangle(TriangleBlock& block, std::size_t at, const Primitives& p, std::uint32_t id) {
  const Corners c = corners_of(p, id);
  for (int a = 0; a < 3; ++a) {
    block.a[a][at] = static_cast<float>(c.v[0][a]);
    block.b[a][at] = static_cast<float>(c.v[1][a]);
    block.c[a][at] = static_cast<float>(c.v[2][a]);
  }
  block.id[at] = id;
}

TriangleBlock empty_block() {
  TriangleBlock b;
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < kBlock; ++i) b.a[a][i] = b.b[a][i] = b.c[a][i] = kNaN;
  for (std::uint32_t& i : b.id) i = kNoPrimitive;
  return b;
}

/// Running sum in place: counts become first places, with the total behind the last.
std::size_t sum_up(std::vector<std::uint32_t>& counts) {
  std::uint32_t sum = 0;
  for (std::uint32_t& c : counts) {
    const std::uint32_t here = c;
    c = sum;
    sum += here;
  }
  return sum;
}

/// Count, sum, scatter. `cells_of(id, visit)` must visit the same cells in both passes.
template <class CellsOf>
CellStore fill(const Primitives& p, std::span<const std::uint32_t> ids, std::size_t cells, const CellsOf& cells_of) {
  CellStore s;
  std::vector<std::uint32_t>* const first[3] = {&s.sphere_first, &s.triangle_first, &s.cone_first};
  for (const std::uint32_t id : ids) {
    std::vector<std::uint32_t>& counts = *first[static_cast<int>(kind_of(p, id))];
    if (counts.empty()) counts.resize(cells + 1);
    cells_of(id, [&](std::size_t c) { ++counts[c], ++s.references; });
  }
  std::vector<std::uint32_t> fill_at[3];
  if (!s.triangle_first.empty()) {
    for (std::uint32_t& c : s.triangle_first) c = (c + kBlock - 1) / kBlock;
    s.triangles.resize(sum_up(s.triangle_first), empty_block());
    fill_at[1].resize(cells);
  }
  if (!s.sphere_first.empty()) {
    const std::size_t n = sum_up(s.sphere_first) + kBlock;
    for (auto& v : s.spheres) v.resize(n, kNaN);
    s.sphere_id.resize(n, kNoPrimitive);
    fill_at[0].resize(cells);
  }
  if (!s.cone_first.empty()) {
    const std::size_t n = sum_up(s.cone_first) + kBlock;
    for (auto& v : s.cones) v.resize(n, kNaN);
    s.cone_id.resize(n, kNoPrimitive);
    fill_at[2].resize(cells);
  }
  for (const std::uint32_t id : ids) {
    const Kind kind = kind_of(p, id);
    std::vector<std::uint32_t>& at = fill_at[static_cast<int>(kind)];
    cells_of(id, [&](std::size_t c) {
      const std::size_t place = at[c]++;
      if (kind == Kind::kTriangle) {
        put_triangle(s.triangles[s.triangle_first[c] + place / kBlock], place % kBlock, p, id);
      } else if (kind == Kind::kSphere) {
        const Spheres& from = p.geometry.spheres;
        const std::size_t i = id - p.sphere_base, to = s.sphere_first[c] + place;
        s.spheres[0][to] = from.x[i], s.spheres[1][to] = from.y[i], s.spheres[2][to] = from.z[i];
        s.spheres[3][to] = from.radius[i], s.sphere_id[to] = id;
      } else {
        const std::size_t to = s.cone_first[c] + place;
        for (std::size_t k = 0; k < 10; ++k) s.cones[k][to] = p.cones[k][id - p.cone_base];
        s.cone_id[to] = id;
      }
    });
  }
  return s;
}

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

double Box::diagonal() const {
  if (empty()) return 0;
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += (hi[a] - lo[a]) * (hi[a] - lo[a]);
  return std::sqrt(sum);
}

PreparedCones prepare_cones(const Cones& c) {
  PreparedCones out;
  for (auto& v : out) v.resize(c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double base[3] = {c.base_x[i], c.base_y[i], c.base_z[i]}, apex[3] = {c.apex_x[i], c.apex_y[i], c.apex_z[i]};
    double height = 0;
    for (int a = 0; a < 3; ++a) height += (apex[a] - base[a]) * (apex[a] - base[a]);
    height = std::sqrt(height);
    const double r0 = std::abs(static_cast<double>(c.base_radius[i])), r1 = std::abs(static_cast<double>(c.apex_radius[i]));
    for (std::size_t a = 0; a < 3; ++a) {
      out[a][i] = static_cast<float>(base[a]);
      out[3 + a][i] = static_cast<float>((apex[a] - base[a]) / height);
    }
    out[6][i] = static_cast<float>(height), out[7][i] = static_cast<float>(r0);
    out[8][i] = static_cast<float>((r1 - r0) / height);
    out[9][i] = c.base_radius[i] + c.apex_radius[i] < 0 ? -1.f : 1.f;
  }
  return out;
}

Primitives::Primitives(const Geometry& g)
    : geometry(g), cones(prepare_cones(g.cones)),
      sphere_base(static_cast<std::uint32_t>(g.planes.size())),
      triangle_base(sphere_base + static_cast<std::uint32_t>(g.spheres.size())),
      cone_base(triangle_base + static_cast<std::uint32_t>(g.triangles.size())),
      end(cone_base + static_cast<std::uint32_t>(g.cones.size())) {}

Box Primitives::box(std::uint32_t id) const {
  Box b;
  switch (kind_of(*this, id)) {
    case Kind::kSphere: {
      const std::uint32_t i = id - sphere_base;
      const Spheres& s = geometry.spheres;
      b.add(s.x[i], s.y[i], s.z[i]);
      b.grow(std::abs(static_cast<double>(s.radius[i])));
      break;
    }
    case Kind::kTriangle:
      for (const auto& v : corners_of(*this, id).v) b.add(v[0], v[1], v[2]);
      break;
    case Kind::kCone: {  // the discs at both ends: a disc of radius r across a unit axis d reaches r sqrt(1 - d_a^2)
      const Cones& c = geometry.cones;
      const std::uint32_t i = id - cone_base;
      const double ends[2][4] = {{c.base_x[i], c.base_y[i], c.base_z[i], c.base_radius[i]},
                                 {c.apex_x[i], c.apex_y[i], c.apex_z[i], c.apex_radius[i]}};
      const double h = cones[6][i];
      for (const auto& e : ends) {
        double reach[3];
        for (int a = 0; a < 3; ++a) {
          const double d = cones[static_cast<std::size_t>(3 + a)][i];
          reach[a] = std::abs(e[3]) * std::sqrt(std::max(0., 1 - d * d) + 1e-6);
        }
        b.add(e[0] - reach[0], e[1] - reach[1], e[2] - reach[2]);
        b.add(e[0] + reach[0], e[1] + reach[1], e[2] + reach[2]);
      }
      b.grow(h * 1e-6);
      break;
    }
  }
  return b;
}

CellLists CellStore::lists() const {
  CellLists l;
  if (!triangle_first.empty()) l.triangle_first = triangle_first.data(), l.triangles = triangles.data();
  if (!sphere_first.empty()) {
    l.sphere_first = sphere_first.data();
    l.sx = spheres[0].data(), l.sy = spheres[1].data(), l.sz = spheres[2].data(), l.sr = spheres[3].data();
    l.sphere_id = sphere_id.data();
  }
  if (!cone_first.empty()) {
    l.cone_first = cone_first.data(), l.cone_id = cone_id.data();
    for (std::size_t k = 0; k < 10; ++k) l.cone[k] = cones[k].data();
  }
  return l;
}

std::size_t CellStore::bytes() const {
  std::size_t sum = bytes_of(triangle_first) + bytes_of(sphere_first) + bytes_of(cone_first) + bytes_of(triangles) +
                    bytes_of(sphere_id) + bytes_of(cone_id);
  for (const auto& v : spheres) sum += bytes_of(v);
  for (const auto& v : cones) sum += bytes_of(v);
  return sum;
}

GridView Grid::view() const {
  GridView v;
  v.lists = store.lists();
  v.distance = distance.data();
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    v.n[a] = static_cast<int>(cells[i]);
    v.lo[a] = lo[a], v.cell[a] = cell[a], v.inv_cell[a] = 1 / cell[a];
    v.lo_f[a] = static_cast<float>(lo[a]);
    v.hi_f[a] = static_cast<float>(lo[a] + cell[a] * cells[i]);
    v.hi_f[a] += std::abs(v.hi_f[a]) * 1.2e-7f;
    v.cell_f[a] = static_cast<float>(cell[a]), v.inv_cell_f[a] = static_cast<float>(1 / cell[a]);
  }
  return v;
}

GridStats Grid::stats() const {
  return {cells, occupied, store.references, store.bytes() + bytes_of(distance)};
}

Grid build_grid(const Primitives& p, std::span<const std::uint32_t> ids, double density, double pad) {
  Box b;
  for (const std::uint32_t id : ids) b.add(p.box(id));
  b.grow(2 * pad);  // once for the cells' contents, once for the entry of rays
  Grid g;
  double extent[3], largest = 0;
  for (int a = 0; a < 3; ++a) {
    // Down to a float, so that walks in float subtract the corner without an error of its own.
    float lo = static_cast<float>(b.lo[a]);
    if (lo > b.lo[a]) lo = std::nextafter(lo, -std::numeric_limits<float>::infinity());
    g.lo[a] = lo;
    extent[a] = b.hi[a] - g.lo[a];
    largest = std::max(largest, extent[a]);
  }
  if (!(largest > 0)) largest = 1e-30;  // every primitive at one point of the origin: any cell does
  for (double& e : extent) e = std::max(e, largest / 1000);
  const double per_length = density / cube_root(extent[0] * extent[1] * extent[2] / static_cast<double>(ids.size()));
  std::size_t cells = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    // Cells no smaller than 2 pad: one outlier a million scenes away makes a pad that would put everything in every cell.
    const double n = std::min(extent[a] * per_length + 1, extent[a] / (2 * pad));
    g.cells[a] = static_cast<std::uint32_t>(std::clamp(n, 1., 1024.));
    g.cell[a] = extent[a] / g.cells[a];
    cells *= g.cells[a];
  }
  g.store = fill(p, ids, cells, [&](std::uint32_t id, const auto& visit) { each_cell(p, g, id, pad, visit); });
  std::vector<std::uint8_t> occupied(cells);
  for (const auto* first : {&g.store.triangle_first, &g.store.sphere_first, &g.store.cone_first})
    for (std::size_t c = 0; c + 1 < first->size(); ++c) occupied[c] |= (*first)[c + 1] > (*first)[c];
  for (const std::uint8_t o : occupied) g.occupied += o;
  g.distance = chebyshev_distance(occupied, g.cells);
  return g;
}

CellStore build_list(const Primitives& p, std::span<const std::uint32_t> ids) {
  return fill(p, ids, 1, [](std::uint32_t, const auto& visit) { visit(std::size_t{0}); });
}

std::vector<std::uint8_t> chebyshev_distance(const std::vector<std::uint8_t>& occupied, const std::array<std::uint32_t, 3>& cells) {
  const std::ptrdiff_t nx = cells[0], ny = cells[1], nz = cells[2];
  // A border of one cell all round, as far away as can be, spares the sweeps their bounds.
  const std::ptrdiff_t sy = nx + 2, sz = sy * (ny + 2);
  std::vector<std::uint8_t> d(static_cast<std::size_t>(sz * (nz + 2)), 255);
  const auto at = [&](std::ptrdiff_t x, std::ptrdiff_t y, std::ptrdiff_t z) { return x + 1 + sy * (y + 1) + sz * (z + 1); };
  for (std::ptrdiff_t z = 0; z < nz; ++z)
    for (std::ptrdiff_t y = 0; y < ny; ++y)
      for (std::ptrdiff_t x = 0; x < nx; ++x)
        if (occupied[static_cast<std::size_t>(x + nx * (y + ny * z))]) d[static_cast<std::size_t>(at(x, y, z))] = 0;
  std::array<std::ptrdiff_t, 13> before{};  // the neighbours a forward sweep has already passed
  std::size_t k = 0;
  for (std::ptrdiff_t z = -1; z <= 1; ++z)
    for (std::ptrdiff_t y = -1; y <= 1; ++y)
      for (std::ptrdiff_t x = -1; x <= 1; ++x)
        if (const std::ptrdiff_t o = x + sy * y + sz * z; z < 0 || (z == 0 && (y < 0 || (y == 0 && x < 0)))) before[k++] = o;
  const auto relax = [&](std::ptrdiff_t c, std::ptrdiff_t sign) {
    std::uint8_t& here = d[static_cast<std::size_t>(c)];
    if (here == 0) return;
    std::uint8_t least = 254;
    for (const std::ptrdiff_t o : before) least = std::min(least, d[static_cast<std::size_t>(c + sign * o)]);
    here = std::min<std::uint8_t>(here, static_cast<std::uint8_t>(least + 1));
  };
  for (std::ptrdiff_t z = 0; z < nz; ++z)
    for (std::ptrdiff_t y = 0; y < ny; ++y)
      for (std::ptrdiff_t x = 0; x < nx; ++x) relax(at(x, y, z), 1);
  for (std::ptrdiff_t z = nz; z-- > 0;)
    for (std::ptrdiff_t y = ny; y-- > 0;)
      for (std::ptrdiff_t x = nx; x-- > 0;) relax(at(x, y, z), -1);
  std::vector<std::uint8_t> out(occupied.size());
  for (std::ptrdiff_t z = 0; z < nz; ++z)
    for (std::ptrdiff_t y = 0; y < ny; ++y)
      for (std::ptrdiff_t x = 0; x < nx; ++x) out[static_cast<std::size_t>(x + nx * (y + ny * z))] = d[static_cast<std::size_t>(at(x, y, z))];
  return out;
}

}  // namespace grelha
