// Where meshes end, and where they turn away from a point.
#include "kernel/marks/mesh_rims.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>

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

/// The same by the book: edges, each with how many triangles of a material have it, and corners,
/// each with the sides that are seen of it.
struct Plainly {
  std::set<Corner> open;
  std::map<Corner, std::set<bool>> sides;
  /// of triangles with a corner inside of a mesh
  std::set<std::pair<Edge, std::uint32_t>> borders;

  Plainly(const Triangles& t, const double (&from)[3]) {
    std::map<std::pair<Edge, std::uint32_t>, int> edges;
    for (std::size_t i = 0; i < t.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{edge_of(t, i, k), t.material[i]}];
        sides[corner(t, i, k)].insert(volume(t, i, from) < 0);
      }
    for (const auto& [edge, count] : edges)
      if (count % 2 != 0)
        open.insert({edge.first.first, edge.first.second});
    for (std::size_t i = 0; i < t.size(); ++i)
      for (std::size_t k = 0; k < 3 && !all_open(t, i); ++k)
        borders.insert({edge_of(t, i, k), t.material[i]});
  }

  static Edge edge_of(const Triangles& t, std::size_t i, std::size_t k) {
    return std::minmax(corner(t, i, k), corner(t, i, k + 1));
  }

  bool has(const Triangles& t, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (open.contains(corner(t, i, k)) || sides.at(corner(t, i, k)).size() > 1)
        return true;
    return false;
  }
  bool all_open(const Triangles& t, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (!open.contains(corner(t, i, k)))
        return false;
    return true;
  }
  bool stands_alone(const Triangles& t, std::size_t i) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (borders.contains({edge_of(t, i, k), t.material[i]}))
        return false;
    return all_open(t, i);
  }
};

/// What is told of a mesh from a point.
struct Told {
  std::vector<bool> has, alone;
  int rims = 0;
  int loners = 0;
};

Told told(const Triangles& t, const double (&from)[3], int threads = 1) {
  const TriangleSpans spans(t);
  MeshRims rims(spans, threads);
  rims.look_from({1, 2, 3});  // to be forgotten
  rims.look_from(from);
  Told out;
  for (std::size_t i = 0; i < t.size(); ++i) {
    out.has.push_back(rims.has(i));
    out.alone.push_back(rims.stands_alone(i));
    out.rims += rims.has(i);
    out.loners += rims.stands_alone(i);
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
/// is: of a ring of 24 by 12 places at most two triangles on either side of each.
TEST(MeshRims, AreTheOutlinesOfClosedMeshes) {
  EXPECT_EQ(told(meshes()[0], kInside).rims, 0);
  const Told afar = told(meshes()[0], kAfar);
  EXPECT_GT(afar.rims, 24);
  EXPECT_LT(afar.rims, 24 * 8);
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
      const Told apart = told(taken_apart(t), from, 3);
      for (std::size_t k = 0; k < t.size(); ++k) {
        EXPECT_EQ(got.has[k], want.has(t, k)) << i << ": " << k;
        EXPECT_EQ(got.alone[k], want.stands_alone(t, k)) << i << ": " << k;
      }
      EXPECT_EQ(apart.has, got.has) << i;
      EXPECT_EQ(apart.alone, got.alone) << i;
    }
}

/// Around a hole, and around a triangle of another material, are those that share a corner with it.
TEST(MeshRims, AreAroundHolesAndOtherMaterials) {
  const Triangles whole = meshes()[0];
  const std::size_t i = 24 * 10 + 7;
  std::set<Corner> at;
  for (std::size_t k = 0; k < 3; ++k)
    at.insert(corner(whole, i, k));
  const auto touches = [&](const Triangles& t, std::size_t other) {
    return at.contains(corner(t, other, 0)) || at.contains(corner(t, other, 1)) ||
           at.contains(corner(t, other, 2));
  };
  Triangles hole = whole;
  drop(hole, i);
  Triangles patch = whole;
  patch.material[i] = 1;
  for (const Triangles& t : {hole, patch}) {
    const Told got = told(t, kInside);
    for (std::size_t k = 0; k < t.size(); ++k)
      EXPECT_EQ(got.has[k], touches(t, k)) << k;
    EXPECT_EQ(got.loners, t.size() == whole.size()) << "the patch alone";
  }
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
  EXPECT_EQ(told(polygon.geometry.triangles, kAfar).rims, 4);
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
  EXPECT_EQ(told(empty_scene().geometry.triangles, kAfar).rims, 0);
}

}  // namespace
}  // namespace grelha::test
