// Where meshes end, and where they turn away from a point.
#include "kernel/marks/mesh_rims.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <set>
#include <vector>

#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using Corner = std::array<float, 3>;
using Edge = std::pair<Corner, Corner>;

Corner corner(const Triangles& t, std::size_t i, std::size_t k) {
  const std::uint32_t v = (k % 3 == 0 ? t.a : k % 3 == 1 ? t.b : t.c)[i];
  return {t.x[v] + 0.f, t.y[v] + 0.f, t.z[v] + 0.f};
}

/// Six times the volume over a triangle, from a point.
double volume(const Triangles& t, std::size_t i, const double (&from)[3]) {
  double p[3][3];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t a = 0; a < 3; ++a)
      p[k][a] = double{corner(t, i, k)[a]} - from[a];
  double sum = 0;
  for (std::size_t a = 0; a < 3; ++a)
    sum +=
        p[0][a] * (p[1][(a + 1) % 3] * p[2][(a + 2) % 3] - p[1][(a + 2) % 3] * p[2][(a + 1) % 3]);
  return sum;
}

/// The same by the book: edges, each with how many triangles of a material have it and the sides
/// that are seen of them.
struct Plainly {
  using EdgeOfMaterial = std::pair<Edge, std::uint32_t>;
  std::map<EdgeOfMaterial, std::vector<bool>> sides;
  std::set<Corner> open;
  std::set<EdgeOfMaterial> borders;  ///< of triangles with a corner inside of a mesh

  Plainly(const Triangles& t, const double (&from)[3]) {
    for (std::size_t i = 0; i < t.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        sides[edge_of(t, i, k)].push_back(volume(t, i, from) < 0);
    for (const auto& [edge, of] : sides)
      if (of.size() == 1)
        open.insert({edge.first.first, edge.first.second});
    for (std::size_t i = 0; i < t.size(); ++i)
      for (std::size_t k = 0; k < 3 && !all_open(t, i); ++k)
        borders.insert(edge_of(t, i, k));
  }

  static EdgeOfMaterial edge_of(const Triangles& t, std::size_t i, std::size_t k) {
    return {std::minmax(corner(t, i, k), corner(t, i, k + 1)), t.material[i]};
  }

  unsigned ends(const Triangles& t, std::size_t i) const {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits |= unsigned{sides.at(edge_of(t, i, k)).size() == 1} << k;
    return bits;
  }
  unsigned rims(const Triangles& t, std::size_t i) const {
    unsigned bits = ends(t, i);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<bool>& of = sides.at(edge_of(t, i, k));
      bits |= unsigned{std::set<bool>(of.begin(), of.end()).size() > 1} << k;
    }
    return bits;
  }
  bool all_open(const Triangles& t, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (!open.contains(corner(t, i, k)))
        return false;
    return true;
  }
  bool stands_alone(const Triangles& t, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (borders.contains(edge_of(t, i, k)))
        return false;
    return all_open(t, i);
  }
};

/// What is told of a mesh from a point.
struct Told {
  std::vector<unsigned> rims, ends;
  std::vector<bool> alone;
  int rim_edges = 0;
  int loners = 0;
};

/// The point is the last of so many.
Told told(const Triangles& t,
          const double (&from)[3],
          int threads = 1,
          std::size_t viewpoints = MeshRims::kMostViewpoints) {
  const TriangleSpans spans(t);
  MeshRims rims(spans, threads);
  std::vector<SeenFrom> points(viewpoints, SeenFrom{{1, 2, 3}});
  rims.look_from(points);  // to be forgotten
  std::copy(from, from + 3, points.back().at);
  rims.look_from(points);
  Told out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    out.rims.push_back(rims.rims(i, viewpoints - 1));
    out.ends.push_back(rims.ends(i));
    out.alone.push_back(rims.stands_alone(i));
    out.rim_edges += std::popcount(out.rims.back());
    out.loners += out.alone.back();
  }
  return out;
}

/// The same triangles, each with corners of its own, some zeros with the other sign.
Triangles taken_apart(const Triangles& t) {
  Scene s = empty_scene();
  Random random(3);
  const auto flipped = [&](float x) { return x == 0 ? random.zero() : x; };
  for (std::size_t i = 0; i < t.size(); ++i) {
    Float3 at[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner c = corner(t, i, k);
      at[k] = {flipped(c[0]), flipped(c[1]), flipped(c[2])};
    }
    add_triangle(s, at[0], at[1], at[2], t.material[i]);
  }
  return s.geometry.triangles;
}

void drop(Triangles& t, std::size_t i) {
  for (auto* v : {&t.a, &t.b, &t.c, &t.material})
    v->erase(v->begin() + static_cast<std::ptrdiff_t>(i));
}

/// A ball, bumps, and a torus, on whose corners there are zeros.
std::vector<Triangles> meshes() {
  return {ball_mesh(24, 12).geometry.triangles,
          ball_mesh(16, 16, .15).geometry.triangles,
          torus_mesh(40, 20, .3).geometry.triangles};
}

constexpr double kInside[3] = {.01, .02, .03};
constexpr double kAfar[3] = {3, 2, 1};

/// In a ball all triangles face its middle, and nothing else is told of it. From afar its outline
/// is: of a ring of 24 by 12 places, seen aslant, one edge or two at each place, each of two
/// triangles.
TEST(MeshRims, AreTheOutlinesOfClosedMeshes) {
  EXPECT_EQ(told(meshes()[0], kInside).rim_edges, 0);
  const Told afar = told(meshes()[0], kAfar);
  EXPECT_GE(afar.rim_edges, 2 * 24);
  EXPECT_LE(afar.rim_edges, 2 * 2 * 24);
  EXPECT_EQ(afar.loners, 0);
}

/// Whole meshes, those with holes and those of two materials, from any point, with corners shared
/// or not, by any number of threads.
TEST(MeshRims, AreWhereEdgesAndSidesSaySo) {
  Random random(1);
  for (const Triangles& mesh : meshes())
    for (int i = 0; i < 20; ++i) {
      Triangles t = mesh;
      for (int k = 0; k < i % 4; ++k)
        drop(t, random.below(static_cast<std::uint32_t>(t.size())));
      for (int k = 0; k < i % 3; ++k)
        t.material[random.below(static_cast<std::uint32_t>(t.size()))] = 1;
      const Float3 p = random.point(3);
      const double from[3] = {double{p.x}, double{p.y}, double{p.z}};
      const Plainly want(t, from);
      const Told got = told(t, from);
      const Told apart = told(taken_apart(t), from, 3, 1);
      for (std::size_t k = 0; k < t.size(); ++k) {
        EXPECT_EQ(got.rims[k], want.rims(t, k)) << i << ": " << k;
        EXPECT_EQ(got.ends[k], want.ends(t, k)) << i << ": " << k;
        EXPECT_EQ(got.alone[k], want.stands_alone(t, k)) << i << ": " << k;
      }
      EXPECT_EQ(apart.rims, got.rims) << i;
      EXPECT_EQ(apart.ends, got.ends) << i;
      EXPECT_EQ(apart.alone, got.alone) << i;
    }
}

/// Around a hole, and around a triangle of another material, are those that share an edge with it.
TEST(MeshRims, AreAroundHolesAndOtherMaterials) {
  const Triangles whole = meshes()[0];
  const std::size_t i = 24 * 10 + 7;
  Triangles hole = whole;
  drop(hole, i);
  Triangles patch = whole;
  patch.material[i] = 1;
  EXPECT_EQ(told(hole, kInside).rim_edges, 3);
  EXPECT_EQ(told(hole, kInside).loners, 0);
  EXPECT_EQ(told(patch, kInside).rim_edges, 6);
  EXPECT_EQ(told(patch, kInside).loners, 1) << "the patch alone";
}

/// Triangles with two corners at one place fill up meshes, and are no part of them.
TEST(MeshRims, AreNotWhereTrianglesHaveNoWidth) {
  Triangles t = meshes()[0];
  const std::uint32_t of[3] = {t.a[100], t.b[100], t.c[100]};
  for (std::size_t k = 0; k < 3; ++k) {
    t.a.push_back(of[k]);
    t.b.push_back(of[(k + 1) % 3]);
    t.c.push_back(of[(k + 1) % 3]);
    t.material.push_back(0);
  }
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(told(t, kInside).rim_edges, 0) << turn;
    EXPECT_EQ(told(t, kInside).loners, 0) << turn;
    std::swap(t.b, t.c);
  }
}

/// Where a fin stands on a sheet three triangles have an edge: the mesh does not end there. Of each
/// the side is told from that of the next, and of the last from that of the first.
TEST(MeshRims, AreNotWhereThreeMeet) {
  Scene s = empty_scene();
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  add_triangle(s, {0, 0, 0}, {0, -1, 0}, {1, 0, 0});
  const Triangles& t = s.geometry.triangles;
  EXPECT_EQ(told(t, {.2, -3, 5}).ends, (std::vector<unsigned>{6, 6, 3}));
  EXPECT_EQ(told(t, {.2, -3, 5}).rims, (std::vector<unsigned>{6, 6, 3}));
  EXPECT_EQ(told(t, {.2, 3, 5}).rims, (std::vector<unsigned>{7, 7, 3}));
}

TEST(MeshRims, TellWhatStandsAlone) {
  EXPECT_EQ(told(one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).geometry.triangles, kAfar).loners,
            1);
  Scene polygon = empty_scene();
  const auto place = [](int k) {
    return Float3{std::cos(static_cast<float>(k)), std::sin(static_cast<float>(k)), 0};
  };
  for (int k = 1; k < 5; ++k)
    add_triangle(polygon, place(0), place(k), place(k + 1));
  EXPECT_EQ(told(polygon.geometry.triangles, kAfar).loners, 4);
  EXPECT_EQ(told(polygon.geometry.triangles, kAfar).rim_edges, 6);
}

/// A square of 3 x 3 squares, cut so that one triangle is its corner; a spike of two triangles at a
/// side of it; a strip at another, as wide as one square.
TEST(MeshRims, HaveTheirCornersAndSpikesForParts) {
  Scene s = empty_scene();
  const auto square = [&](float x, float y) {
    add_triangle(s, {x, y, 0}, {x + 1, y, 0}, {x, y + 1, 0});
    add_triangle(s, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0});
  };
  for (int i = 0; i < 9; ++i)
    square(static_cast<float>(i % 3), static_cast<float>(i / 3));
  EXPECT_EQ(told(s.geometry.triangles, kAfar).loners, 0);
  add_triangle(s, {1, 3, 0}, {2, 3, 0}, {1, 4, 0});
  EXPECT_EQ(told(s.geometry.triangles, kAfar).loners, 0);
  add_triangle(s, {2, 3, 0}, {1, 4, 0}, {1, 9, 0});
  EXPECT_EQ(told(s.geometry.triangles, kAfar).loners, 1);
  for (int i = 3; i < 8; ++i)
    square(static_cast<float>(i), 1);
  EXPECT_EQ(told(s.geometry.triangles, kAfar).loners, 1 + 5 * 2 - 1);
}

/// Of no triangle nothing is told, and nothing breaks.
TEST(MeshRims, AreNotWhereNothingIs) {
  EXPECT_EQ(told(empty_scene().geometry.triangles, kAfar).rim_edges, 0);
}

}  // namespace
}  // namespace grelha::test
