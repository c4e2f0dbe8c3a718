#pragma once
// Triangles: their data, blocks of eight, the cells that they overlap, the ray test, and surfaces.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "grelha/scene_spans.hpp"
#include "kernel/shapes/arrays.hpp"
#include "kernel/shapes/box.hpp"
#include "kernel/shapes/hit.hpp"
#include "kernel/shapes/triangle_crossing.hpp"
#include "kernel/base/vec3.hpp"
#include "kernel/shapes/surface_position.hpp"

namespace grelha {

/// Eight triangles side by side; unused positions hold NaN corners, which no ray can hit.
struct alignas(64) TriangleBlock {
  float a[3][kBlock], b[3][kBlock], c[3][kBlock];
  std::uint32_t id[kBlock];
};

/// A row of boxes, for up to eight blocks that follow each other: each holds the part of a block's
/// triangles within its cell, and is grown. A ray that hits a triangle there passes through the
/// box. The box of an unused position ends before it begins, so no ray passes through it. Position
/// p is box p % kBlock of row p / kBlock; grid_steps.hpp says which block has which.
struct alignas(64) BlockBoxes {
  float side[6][kBlock];  ///< least x, y, z, greatest x, y, z
};

/// A cell grown by pad against a triangle: the plane, and each edge seen along the axes across
/// which the triangle spans several cells. Together with boxes that overlap, these are all the
/// separating axes, so the triangle overlaps the remaining cells.
class TriangleOverlap {
 public:
  TriangleOverlap(const float (&corner)[3][3], const CellFrame& g, const CellRange& range) {
    for (int a = 0; a < 3; ++a) {
      cell_[a] = g.cell[a];
      half_[a] = g.cell[a] / 2 + g.pad;
      for (int k = 0; k < 3; ++k)
        corner_[k][a] = corner[k][a] - g.lo[a];
      for (int k = 0; k < 3; ++k)
        side_[k][a] = static_cast<double>(corner[(k + 1) % 3][a]) - corner[k][a];
    }
    set_plane();
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int d = (a + 2) % 3;
      // of one row of cells the box says it all
      if (range.lo[b] != range.hi[b] && range.lo[d] != range.hi[d])
        add_edges(a, b, d);
    }
  }
  bool operator()(const int (&at)[3]) const {
    const double c[3] = {(at[0] + .5) * cell_[0], (at[1] + .5) * cell_[1], (at[2] + .5) * cell_[2]};
    if (!(std::abs(n_[0] * c[0] + n_[1] * c[1] + n_[2] * c[2] - offset_) <= half_width_))
      return false;
    for (int i = 0; i < count_; ++i)
      if (edges_[i].mb * c[edges_[i].b] + edges_[i].md * c[edges_[i].d] < edges_[i].least)
        return false;
    return true;
  }

 private:
  /// A component of the normal in double: error <= kNormalError * sum of its two products, for two
  /// sides, a product and the difference. For needles it can exceed the result. Other
  /// roundings come to less than a thousandth of the pad, which all cells are grown by.
  static constexpr double kNormalError = 0x1p-51;

  struct Edge {
    int b, d;  ///< axes it is seen in
    double mb, md, least;
  };

  void set_plane() {
    double offset = 0;
    double half_width = 0;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int d = (a + 2) % 3;
      const double p = side_[0][d] * side_[2][b];
      const double q = side_[0][b] * side_[2][d];
      n_[a] = p - q;
      offset += n_[a] * corner_[0][a];
      const double from_corner =
          std::max(std::abs(side_[0][a]), std::abs(side_[2][a])) + 2 * half_[a];
      error_[a] = (std::abs(p) + std::abs(q)) * kNormalError;
      half_width += std::abs(n_[a]) * half_[a] + error_[a] * from_corner;
    }
    offset_ = offset;
    half_width_ = half_width;
  }

  /// The edges seen along axis a, inward across each. Rounding can turn them only where the
  /// triangle is seen edge-on: then all of it lies within that of each.
  void add_edges(int a, int b, int d) {
    const double sign = n_[a] < 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) {
      const double mb = -sign * side_[k][d];
      const double md = sign * side_[k][b];
      const double at = mb * corner_[k][b] + md * corner_[k][d];
      const double half_width = std::abs(mb) * half_[b] + std::abs(md) * half_[d];
      edges_[count_++] = {b, d, mb, md, at - half_width - error_[a]};
    }
  }

  double cell_[3], half_[3];
  double corner_[3][3], side_[3][3];
  double n_[3], error_[3], offset_, half_width_;
  int count_ = 0;
  Edge edges_[9];
};

/// A kind of primitive, as the building of grids sees it; shapes.hpp says what each must have.
struct Triangle {
  static constexpr PrimitiveKind kKind = PrimitiveKind::kTriangle;
  static constexpr bool kFinite = true;
  static constexpr bool kPositionFromRay = true;  ///< a surface is found without t
  static constexpr bool kInBlocks = true;         ///< a list's entry is a block

  /// A triangle as tests read it.
  template <class T>
  struct Fields {
    T corner[3][3];  ///< x, y, z of each
  };
  template <class Visit, class... F>
  static constexpr void for_each_field(const Visit& visit, F&... of) {
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a)
        visit(of.corner[k][a]...);
  }

  /// By index, over shared vertices.
  struct Arrays {
    const float* vertex[3] = {};          ///< x, y, z of each
    const float* normal[3] = {};          ///< the same, or null
    const float* color[3] = {};           ///< red, green, blue of each, or null
    const std::uint32_t* corner[3] = {};  ///< which vertices a triangle has
    const std::uint32_t* material = nullptr;
    std::uint32_t count = 0;

    Fields<float> triangle(std::uint32_t i) const {
      Fields<float> t;
      for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a)
          t.corner[k][a] = vertex[a][corner[k][i]];
      return t;
    }
  };
  /// Cell after cell: cell i owns blocks first[i] up to first[i + 1] - 1, or, if blocks have boxes,
  /// those at positions first[i] up to first[i + 1] - 1 of grid_steps.hpp. If no cell holds any,
  /// first == nullptr.
  struct CellList {
    const std::uint32_t* first = nullptr;
    const TriangleBlock* blocks = nullptr;
    const BlockBoxes* boxes = nullptr;           ///< of all blocks, or null
    const std::uint32_t* first_block = nullptr;  ///< the first of each row of boxes, and the end

    /// The block at a position, if blocks have boxes.
    std::uint32_t block_at(std::uint32_t index) const {
      return first_block[index / kBlock] + index % kBlock;
    }
    /// A cell's blocks: the first, and the one behind the last.
    std::pair<std::uint32_t, std::uint32_t> blocks_of(std::size_t cell) const {
      if (!boxes)
        return {first[cell], first[cell + 1]};
      return {block_at(first[cell]), block_at(first[cell + 1])};
    }
  };

  /// The caller's arrays of coordinates.
  template <class Visit>
  static void for_each_array(const TriangleSpans& spans, const Visit& visit) {
    for (const Floats* v : {&spans.x, &spans.y, &spans.z})
      visit(*v);
  }
  static const TriangleSpans& spans_of(const GeometrySpans& g) { return g.triangles; }
  /// True if all arrays of triangles have the same length, and so do all arrays of vertices.
  static bool is_even(const TriangleSpans& spans);
  static std::size_t bytes(const TriangleSpans& spans) {
    return spans.size() * 4 * sizeof(std::uint32_t) +
           (spans.vertex_count() + spans.nx.size() + spans.red.size()) * 3 * sizeof(float);
  }

  /// The caller's triangles.
  struct Source {
    static constexpr std::size_t kSetupBytes = 0;  ///< a triangle
    TriangleSpans spans;
    explicit Source(const GeometrySpans& g) : spans(g.triangles) {}
    std::size_t size() const { return spans.size(); }
    Arrays arrays() const;
    Fields<float> operator[](std::size_t i) const {
      Fields<float> t;
      const std::uint32_t vertex[3] = {spans.a[i], spans.b[i], spans.c[i]};
      for (int k = 0; k < 3; ++k) {
        t.corner[k][0] = spans.x[vertex[k]];
        t.corner[k][1] = spans.y[vertex[k]];
        t.corner[k][2] = spans.z[vertex[k]];
      }
      return t;
    }
  };

  static Box box(const Source& source, std::size_t i) {
    const Fields<float> t = source[i];
    Box b;
    for (int a = 0; a < 3; ++a) {
      b.lo[a] = std::min(std::min(t.corner[0][a], t.corner[1][a]), t.corner[2][a]);
      b.hi[a] = std::max(std::max(t.corner[0][a], t.corner[1][a]), t.corner[2][a]);
    }
    return b;
  }

  class Overlap : public TriangleOverlap {
   public:
    Overlap(const Fields<float>& t, const CellFrame& g, const CellRange& range)
        : TriangleOverlap(t.corner, g, range) {}
  };
};

}  // namespace grelha

namespace grelha {

/// The span of t of the crossing beyond t_min of a ray and a triangle, in t - shift, as doubles and
/// then exact numbers tell it.
CrossingSpan triangle_span(const ExactRay& ray, const float (&corner)[3][3], double shift);

}  // namespace grelha

namespace grelha::GRELHA_ISA {

/// A ray's own frame for triangle tests: axis `k` is where |dir| is largest (x before y before z on
/// equality), and the shear that lays dir along it. Function of the direction alone, so every
/// triangle sees the same frame.
template <class Real>
struct Shear {
  Real x, y, z;      ///< dir[kx] / dir[kz], dir[ky] / dir[kz], 1 / dir[kz]
  Real frame_error;  ///< what differences of coordinates are off by before they are rounded
};

/// The axis along which a direction is largest, on which the frame stands; the other two follow
/// cyclically.
inline int largest_axis(float dx, float dy, float dz) {
  const float ax = magnitude(dx), ay = magnitude(dy), az = magnitude(dz);
  if (ax >= ay && ax >= az)
    return 0;
  return ay >= az ? 1 : 2;
}

/// The axes that follow each one, cyclically.
inline constexpr int kNextAxis[3] = {1, 2, 0};
inline constexpr int kPreviousAxis[3] = {2, 0, 1};

/// A vector in the axes of rays that stand on different ones, lane by lane.
template <class Real>
inline Vec3<Real> permute_axes(const Real& axis, const Vec3<Real>& v) {
  const Mask<Real> x = axis == Real(0), y = axis == Real(1);
  return {select(x, v.y, select(y, v.z, v.x)),
          select(x, v.z, select(y, v.x, v.y)),
          select(x, v.x, select(y, v.y, v.z))};
}

// Error bounds of floats or doubles, in u, half an ulp of 1; docs/proofs.md derives each,
// triangle_test.cpp pins them. S: the largest sheared coordinate of a corner, Z: the largest depth
// of one. "Spread" is S (S + Z) over the sum of the edge functions, times the range of the corners'
// t.

/// Edge function: error <= kEdgeError * S (S + Z). It is 24 u: a sheared corner is off by u (4
/// (S + Z) + S).
inline constexpr double kEdgeError = 32;
/// t: error <= kDepthError * spread + kDepthRounding * t. It is 72 u by the edges, a quarter of
/// whose sum may be wrong, and 36 u by the mean.
inline constexpr double kDepthError = 256;
inline constexpr double kDepthRounding = 16;
/// Added to the range: more than underflow takes from the corners' t and their weighted sum.
template <class Real>
inline constexpr double kRangeUnderflow =
    std::is_same_v<Scalar<Real>, float> ? 0x1p-126 : 0x1p-1000;

/// Edge functions of triangles and rays, and their error bounds.
template <class Real>
struct EdgeFunctions {
  Vec3<Real> oa, ob, oc;  ///< from the rays' origins to the corners
  Real u, v, w;           ///< of the edges opposite to a, b and c
  Real least, most;       ///< of these
  Real wide;              ///< added to depths, for the error of coordinates
  Real area;              ///< S (S + Z), and a little

  [[gnu::always_inline]] EdgeFunctions(const RayAndTriangle<Real>& from, const Shear<Real>& shear)
      : oa(from.corner.a - from.org), ob(from.corner.b - from.org), oc(from.corner.c - from.org) {
    const Real ax = oa.x - shear.x * oa.z, ay = oa.y - shear.y * oa.z;
    const Real bx = ob.x - shear.x * ob.z, by = ob.y - shear.y * ob.z;
    const Real cx = oc.x - shear.x * oc.z, cy = oc.y - shear.y * oc.z;
    u = cx * by - cy * bx;
    v = ax * cy - ay * cx;
    w = bx * ay - by * ax;
    const Real size =
        max_abs(max_abs(max_abs(ax, ay), max_abs(bx, by)), max_abs(cx, cy)) + shear.frame_error;
    const Real depth = max_abs(max_abs(oa.z, ob.z), oc.z);
    wide = Real(static_cast<Scalar<Real>>(.25 / kUnit<Real>)) * shear.frame_error;
    area = size * ((size + depth) + wide) + Real(static_cast<Scalar<Real>>(kUnderflow<Real>));
    least = min(min(u, v), w);
    most = max(max(u, v), w);
  }
  /// Lanes whose ray does not surely pass beside the triangle.
  [[gnu::always_inline]] Mask<Real> may_cross() const {
    return min(most, Real(0) - least) <= units<Real>(kEdgeError) * area;
  }
};

/// Bounds the crossings of rays and triangles, from either side, edges and corners included.
///
/// Source    Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013; the
///           filter after Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
///           Geometric Predicates", 1997.
template <class Real>
[[gnu::always_inline]] inline HitInterval<Real> bound_triangle(const RayAndTriangle<Real>& from,
                                                               const Shear<Real>& shear,
                                                               const Real& t_min,
                                                               const Real& best) {
  const EdgeFunctions<Real> edge(from, shear);
  HitInterval<Real> found{edge.may_cross(), {}, t_min, t_min};
  if (none(found.some)) {
    found.sure = found.some;
    return found;
  }
  const auto& [oa, ob, oc, u, v, w, least, most, wide, area] = edge;
  const Real inverse = Real(1) / ((u + v) + w);
  const Real ta = shear.z * oa.z, tb = shear.z * ob.z, tc = shear.z * oc.z;
  const Real t = ((u * inverse) * ta + (v * inverse) * tb) + (w * inverse) * tc;
  const Real range = (max(max(ta, tb), tc) - min(min(ta, tb), tc)) +
                     Real(static_cast<Scalar<Real>>(kRangeUnderflow<Real>));
  const Real spread = (area * magnitude(inverse)) * range;
  const Real size = magnitude(t) + wide * magnitude(shear.z);
  const Real slack = units<Real>(kDepthError) * spread + units<Real>(kDepthRounding) * size;
  found.lo = t - slack;
  found.hi = t + slack;
  const Mask<Real> inside = max(least, Real(0) - most) > units<Real>(kEdgeError) * area;
  found.some = and_not(found.some, mask_or(found.hi <= t_min, found.lo > best));
  found.sure =
      mask_and(found.some, mask_and(inside, found.lo > t_min));  // a NaN anywhere is not sure
  return found;
}

/// One ray and one triangle in double.
inline RayAndTriangle<double> turned(const ExactRay& r, const float (&corner)[3][3]) {
  const int k = largest_axis(
      static_cast<float>(r.dir[0]), static_cast<float>(r.dir[1]), static_cast<float>(r.dir[2]));
  const auto turn = [k](const auto& v) {
    return Vec3<double>{v[kNextAxis[k]], v[kPreviousAxis[k]], v[k]};
  };
  return {turn(r.org), turn(r.dir), {turn(corner[0]), turn(corner[1]), turn(corner[2])}};
}
inline Shear<double> shear_of(const RayAndTriangle<double>& from) {
  return {from.dir.x / from.dir.z, from.dir.y / from.dir.z, 1 / from.dir.z, 0};
}
/// The same of one ray and one triangle, in double.
inline HitInterval<double> bound_triangle(const ExactRay& r, const float (&corner)[3][3]) {
  const RayAndTriangle<double> from = turned(r, corner);
  return bound_triangle<double>(from, shear_of(from), r.t_min, __builtin_inf());
}

/// Weights of the corners where a ray crosses a triangle, each within 2^-30, none negative. Returns
/// false where doubles do not tell.
inline bool double_weights(const ExactRay& r, const float (&corner)[3][3], double (&weight)[3]) {
  const RayAndTriangle<double> from = turned(r, corner);
  const EdgeFunctions<double> edge(from, shear_of(from));
  const double sum = (edge.u + edge.v) + edge.w;
  if (!(units<double>(4 * kEdgeError) * edge.area < 0x1p-30 * magnitude(sum)))
    return false;
  weight[0] = max(edge.u / sum, 0.);
  weight[1] = max(edge.v / sum, 0.);
  weight[2] = max(edge.w / sum, 0.);
  return true;
}

/// Decides selected lanes that a float test cannot, in double, and then in exact numbers. `source`
/// is copied; 16 bytes are best.
template <class Real, class Source>
[[gnu::noinline]] void refine_triangles(Source source,
                                        Mask<Real> selected,
                                        Real t_min,
                                        HitInterval<Real>& found) {
  if (source.frame_error() == 0) {  // of the triangle that a ray starts on
    const Mask<Real> past = mask_and(selected, past_plane(source(), t_min));
    selected = and_not(selected, past);
    found.some = and_not(found.some, past);
  }
  replace_selected(bits(selected), found, [&](int k) {
    if (source.is_filtered(k))
      return CrossingSpan{};
    float corner[3][3];
    source.take_vertices(k, corner);
    return triangle_span(source.given(k), corner, source.shift(k));
  });
}

/// Finds where rays cross triangles.
///
/// Takes     source() gives rays and triangles. It is called again where floats cannot decide, so
///           that registers need not hold until then what few tests read.
/// Returns   lanes whose ray crosses its triangle at a t beyond t_min, which is from lo to hi.
///           Those whose t is surely beyond `best` are left out. The sign of every decision is that
///           of real arithmetic: triangles that share an edge or a corner agree about it.
template <class Real, class Source>
[[gnu::always_inline]] inline HitInterval<Real> intersect_triangle(const Source& source,
                                                                   const Shear<Real>& shear,
                                                                   const Real& t_min,
                                                                   const Real& best) {
  HitInterval<Real> found = bound_triangle<Real>(source(), shear, t_min, best);
  const Mask<Real> unsure = and_not(found.some, found.sure);
  if (any(unsure)) [[unlikely]]
    refine_triangles<Real, Source>(source, unsure, t_min, found);
  return found;
}

/// Triangle i of a block.
inline Triangle::Fields<float> triangle_of(const TriangleBlock& block, int i) {
  return {{{block.a[0][i], block.a[1][i], block.a[2][i]},
           {block.b[0][i], block.b[1][i], block.b[2][i]},
           {block.c[0][i], block.c[1][i], block.c[2][i]}}};
}

/// Lanes of triangles i, i + 1, ... of a block that overlap a frustum.
template <class Frustum>
[[gnu::noinline]] inline unsigned overlapping(const Frustum& f, const TriangleBlock& block, int i) {
  const Block au = load<Block>(block.a[f.u] + i);
  const Block av = load<Block>(block.a[f.v] + i);
  const Block ak = load<Block>(block.a[f.k] + i);
  const Block bu = load<Block>(block.b[f.u] + i);
  const Block bv = load<Block>(block.b[f.v] + i);
  const Block bk = load<Block>(block.b[f.k] + i);
  const Block cu = load<Block>(block.c[f.u] + i);
  const Block cv = load<Block>(block.c[f.v] + i);
  const Block ck = load<Block>(block.c[f.k] + i);
  const unsigned left = f.inside_mask([&](int j) {  // the corner farthest inside
    const Block s(f.a[j]);
    const Block r(f.b[j]);
    const Block fa = s * (j < 2 ? au : av) + r * ak;
    const Block fb = s * (j < 2 ? bu : bv) + r * bk;
    const Block fc = s * (j < 2 ? cu : cv) + r * ck;
    return max(max(fa, fb), fc) + Block(f.c[j]);
  });
  const Block s(f.to_slice);
  const Mask<Block> ahead = max(max(s * ak, s * bk), s * ck) + Block(f.zero_slice) >= Block(f.near);
  return left & bits(mask_and(ahead, au == au));  // padding is NaN
}

/// Groups of rays in a frustum that may hit a triangle.
template <class Frustum>
inline std::uint64_t groups_near(const Frustum& f, const Triangle::Fields<float>& triangle) {
  const float(&a)[3] = triangle.corner[0];
  const float(&b)[3] = triangle.corner[1];
  const float(&c)[3] = triangle.corner[2];
  const float end =
      max(max(f.to_slice * a[f.k], f.to_slice * b[f.k]), f.to_slice * c[f.k]) + f.zero_slice;
  return f.groups_ahead(end) & f.groups_inside([&](int j, int first) {
    const int u = f.side(j);
    const VFloat s = load<VFloat>(f.group_b[j] + first);
    const VFloat fa = VFloat(f.a[j] * a[u]) + s * VFloat(a[f.k]);
    const VFloat fb = VFloat(f.a[j] * b[u]) + s * VFloat(b[f.k]);
    const VFloat fc = VFloat(f.a[j] * c[u]) + s * VFloat(c[f.k]);
    return max(max(fa, fb), fc) + load<VFloat>(f.group_c[j] + first);
  });
}

/// The part of a triangle's surface that is computed in double, and rounded once.
template <class Real>
struct TrianglePosition {
  Vec3<Real> point, normal, weights;
};

/// Replaces the weights of lanes in which doubles cancel by exact ones.
template <class Real>
[[gnu::noinline, gnu::cold]] void refine_weights(const Vec3<Real>& org,
                                                 const Vec3<Real>& dir,
                                                 const TriangleVertices<Real>& c,
                                                 unsigned lanes,
                                                 Vec3<Real>& weight) {
  constexpr int kNumbers = 18;
  const Vec3<Real>* const all[] = {&org, &dir, &c.a, &c.b, &c.c, &weight};
  double number[kNumbers][kWidth<Real>];
  for (int i = 0; i < kNumbers; i += 3) {
    store(number[i], all[i / 3]->x);
    store(number[i + 1], all[i / 3]->y);
    store(number[i + 2], all[i / 3]->z);
  }
  each_bit(lanes, [&](int k) {
    const auto at = [&](int i) { return number[i][k]; };
    const ExactRay ray{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, 0, 0};
    float corner[3][3];
    for (int i = 0; i < 9; ++i)
      corner[i / 3][i % 3] = static_cast<float>(at(6 + i));
    double found[3];
    crossing_weights(ray, corner, found);
    const double sum = (found[0] + found[1]) + found[2];
    for (int i = 0; sum < 2 && i < 3; ++i)
      number[15 + i][k] = found[i] / sum;
  });
  weight = {load<Real>(number[15]), load<Real>(number[16]), load<Real>(number[17])};
}

/// Corners as they are, not permuted; `axis` is that of largest_axis().
template <class Real>
inline TrianglePosition<Real> triangle_position(const Real& axis,
                                                const Vec3<Real>& org,
                                                const Vec3<Real>& dir,
                                                const TriangleVertices<Real>& c) {
  const auto turned = [&](const Vec3<Real>& p) { return permute_axes<Real>(axis, p); };
  auto [w, sure] =
      weights_at<Real>(turned(org), turned(dir), {turned(c.a), turned(c.b), turned(c.c)});
  constexpr unsigned kAll = (1u << kWidth<Real>)-1;
  if (const unsigned unsure = ~bits(sure) & kAll; unsure != 0) [[unlikely]]
    refine_weights(org, dir, c, unsure, w);
  const Vec3<Real> e1 = c.b - c.a;
  const Vec3<Real> e2 = c.c - c.a;
  return {
      c.a + (w.y * e1 + w.z * e2),
      normalize(cross(e1, e2)),
      w,
  };
}

template <class Real, int i = 0>
inline void triangle_positions(const Real& axis,
                               const Vec3<Real>& org,
                               const Vec3<Real>& dir,
                               const TriangleVertices<Real>& c,
                               PositionParts<Real>& to) {
  const TrianglePosition<Wide<Real>> p = triangle_position<Wide<Real>>(
      to_double<i>(axis), to_double<i>(org), to_double<i>(dir), to_double<i>(c));
  int k = 0;
  for (const Vec3<Wide<Real>>* v : {&p.point, &p.normal, &p.weights})
    for (const Wide<Real>* x : {&v->x, &v->y, &v->z})
      to.part[k++][i] = *x;
  if constexpr (i + 1 < kWideParts<Real>)
    triangle_positions<Real, i + 1>(axis, org, dir, c, to);
}

/// Square of the length of mixed unit normals below which they cancel: rounding decides where such
/// a mix points to.
inline constexpr float kLeastMix = 1e-12f;

/// The axes that prepare() gave the rays.
template <class Real>
inline Real shear_axes(const Vec3<Real>& dir) {
  const Real x = magnitude(dir.x);
  const Real y = magnitude(dir.y);
  const Real z = magnitude(dir.z);
  return select(mask_and(x >= y, x >= z), Real(0), select(y >= z, Real(1), Real(2)));
}

/// The normals of three vertices, mixed by weights, on the side of `flat`; where a vertex has none,
/// or they cancel, `flat`.
template <class Real>
inline Vec3<Real> mixed_normal(const Triangle::Arrays& triangles,
                               const Words<Real> (&vertex)[3],
                               const Vec3<Real>& weights,
                               const Vec3<Real>& flat) {
  const Real o(0), one(1);
  Mask<Real> sound = one > o;
  const auto normal = [&](const Words<Real>& i) {
    const Vec3<Real> m = three_at(triangles.normal, i);
    const Real mm = dot(m, m);
    sound = mask_and(sound, mm > o);
    return (one / square_root(mm)) * m;
  };
  const Vec3<Real> a = normal(vertex[0]);
  const Vec3<Real> b = normal(vertex[1]);
  const Vec3<Real> c = normal(vertex[2]);
  const Vec3<Real> mix = weights.x * a + (weights.y * b + weights.z * c);
  const Real mm = dot(mix, mix);
  const Vec3<Real> m = (one / square_root(mm)) * mix;
  const Vec3<Real> same_side = select(dot(m, flat) < o, Vec3<Real>{o, o, o} - m, m);
  return select(mask_and(sound, mm > Real(kLeastMix)), same_side, flat);
}

/// The colours of three vertices, mixed by weights.
template <class Real>
inline Vec3<Real> mixed_color(const Triangle::Arrays& triangles,
                              const Words<Real> (&vertex)[3],
                              const Vec3<Real>& weights) {
  return weights.x * three_at(triangles.color, vertex[0]) +
         (weights.y * three_at(triangles.color, vertex[1]) +
          weights.z * three_at(triangles.color, vertex[2]));
}

/// Surfaces of triangles i at the rays' hits.
template <class Real>
inline Surface<Real> surface_on(const Triangle::Arrays& triangles,
                                const Words<Real>& i,
                                const SurfaceHit<Real>& met) {
  const Words<Real> v[3] = {words_at(triangles.corner[0], i),
                            words_at(triangles.corner[1], i),
                            words_at(triangles.corner[2], i)};
  const TriangleVertices<Real> c = {three_at(triangles.vertex, v[0]),
                                    three_at(triangles.vertex, v[1]),
                                    three_at(triangles.vertex, v[2])};
  PositionParts<Real> parts;
  triangle_positions<Real>(shear_axes(met.dir), met.org, met.dir, c, parts);
  const Vec3<Real> point = parts.vector(0);
  const Vec3<Real> n = parts.vector(3);
  const Vec3<Real> weights = parts.vector(6);
  const Real max_coordinate = max(max(largest(c.a), largest(c.b)), largest(c.c));
  Surface<Real> s{
      .point = point,
      .normal = n,
      .shading = n,
      .offset = Real(4 * kEps) * largest(point) + Real(kWideEps) * max_coordinate,
      .material = words_at(triangles.material, i),
  };
  if (met.smooth)
    s.shading = mixed_normal<Real>(triangles, v, weights, n);
  if (met.color)
    *met.color = mixed_color<Real>(triangles, v, weights);
  return s;
}

}  // namespace grelha::GRELHA_ISA
