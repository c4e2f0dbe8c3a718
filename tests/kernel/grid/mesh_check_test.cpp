// What a mesh is, against a map of its edges by coordinates and areas in long double.
#include "grelha/mesh_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "grelha/inside.hpp"
#include "tests/support/hard_meshes.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using Place = std::array<float, 3>;

Place place(const Scene& s, std::uint32_t v) {
  const Float3 p = vertex(s, v);
  return {p.x + 0.f, p.y + 0.f, p.z + 0.f};
}
std::array<Place, 3> corners(const Scene& s, std::size_t i) {
  const Triangles& t = s.geometry.triangles;
  return {place(s, t.a[i]), place(s, t.b[i]), place(s, t.c[i])};
}

/// Counts as the definitions say, with trees of coordinates.
struct Expected {
  std::size_t vertices, edges, open = 0, inconsistent = 0, nonmanifold = 0, duplicate = 0;

  explicit Expected(const Scene& s) {
    struct Uses {
      std::size_t up = 0, all = 0;
    };
    std::map<std::pair<Place, Place>, Uses> uses;
    std::set<Place> places;
    std::set<std::array<Place, 3>> seen;
    for (std::size_t i = 0; i < s.geometry.triangles.size(); ++i) {
      std::array<Place, 3> p = corners(s, i);
      places.insert(p.begin(), p.end());
      for (std::size_t k = 0; k < 3 && p[0] != p[1] && p[1] != p[2] && p[2] != p[0]; ++k) {
        const Place &from = p[k], &to = p[(k + 1) % 3];
        Uses& of = uses[std::minmax(from, to)];
        of.up += from < to;
        ++of.all;
      }
      std::sort(p.begin(), p.end());
      duplicate += !seen.insert(p).second;
    }
    vertices = places.size();
    edges = uses.size();
    for (const auto& [edge, of] : uses) {
      open += of.all % 2;
      inconsistent += of.all % 2 == 0 && 2 * of.up != of.all;
      nonmanifold += of.all > 2;
    }
  }
};

/// Leaves out, turns over and repeats some triangles.
Scene damaged(const Scene& from, std::uint64_t seed, double share) {
  Random random(seed);
  Scene s = empty_scene();
  const Triangles& t = from.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    Float3 p[3] = {vertex(from, t.a[i]), vertex(from, t.b[i]), vertex(from, t.c[i])};
    if (random.chance(share))
      continue;
    if (random.chance(share))
      std::swap(p[0], p[1]);
    if (random.chance(share))
      add_triangle(s, p[1], p[2], p[0]);
    if (random.chance(share))
      p[1] = p[0];
    add_triangle(s, p[0], p[1], p[2]);
  }
  return s;
}

TEST(MeshCheck, CountsWhatTheDefinitionsSay) {
  std::uint64_t seed = 0;
  for (const double share : {0., .002, .05, .4})
    for (const Scene& whole : {ball_mesh(24, 12), torus_mesh(30, 20, .4), heap(3, 300)}) {
      const Scene s = share > 0 ? damaged(whole, ++seed, share) : whole;
      const Expected expected(s);
      const MeshCheck found = check_mesh(s);
      EXPECT_EQ(found.triangles, s.geometry.triangles.size());
      EXPECT_EQ(found.vertices, expected.vertices);
      EXPECT_EQ(found.edges, expected.edges);
      EXPECT_EQ(found.open_edges.count, expected.open);
      EXPECT_EQ(found.inconsistent_edges.count, expected.inconsistent);
      EXPECT_EQ(found.nonmanifold_edges.count, expected.nonmanifold);
      EXPECT_EQ(found.duplicate_triangles.count, expected.duplicate);
    }
}

TEST(MeshCheck, OfClosedMeshes) {
  for (const Scene& s : {ball_mesh(24, 12), torus_mesh(30, 20, .4), ball_mesh(16, 8, .2)}) {
    const MeshCheck found = check_mesh(s);
    EXPECT_TRUE(found.is_closed() && found.is_oriented() && found.is_edge_manifold());
    EXPECT_EQ(found.duplicate_triangles.count + found.degenerate_triangles.count, 0u);
  }
  const Scene empty = empty_scene();
  EXPECT_TRUE(check_mesh(empty).is_closed());
}

TEST(MeshCheck, NamesTheFirst) {
  Scene s = torus_mesh(30, 20, .4);
  s.geometry.spheres.add({9, 0, 0}, 1, 0);  // so the first triangle has id 1
  Triangles& t = s.geometry.triangles;
  std::swap(t.a[70], t.b[70]);
  t.c[500] = t.b[500];
  const MeshCheck found = check_mesh(s);
  EXPECT_EQ(found.inconsistent_edges.count, 3u);
  EXPECT_EQ(found.inconsistent_edges.first.size(), 3u);
  for (const MeshEdge& e : found.inconsistent_edges.first) {
    const std::uint32_t i = e.id - 1;
    const std::uint32_t v[4] = {t.a[i], t.b[i], t.c[i], t.a[i]};
    EXPECT_NE(std::search(v, v + 4, &e.from, &e.from + 2), v + 4);
    EXPECT_LE(i, 70u);
  }
  EXPECT_EQ(found.open_edges.count, 3u);
  EXPECT_EQ(found.degenerate_triangles.first, std::vector<std::uint32_t>{501});
  const World world(s, {});
  EXPECT_EQ(check_mesh(world).open_edges.first[0].id, found.open_edges.first[0].id);
}

/// The first are those of the lowest ids, however many there are.
TEST(MeshCheck, KeepsTheLowest) {
  Scene s = torus_mesh(30, 20, .4);
  Scene twice = with_copies(s);
  const MeshCheck found = check_mesh(twice);
  const auto n = static_cast<std::uint32_t>(s.geometry.triangles.size());
  EXPECT_EQ(found.duplicate_triangles.count, n);
  for (std::uint32_t i = 0; i < Findings<MeshEdge>::kMost; ++i)
    EXPECT_EQ(found.duplicate_triangles.first[i], n + i);
  EXPECT_TRUE(found.is_closed() && found.is_oriented());
  EXPECT_EQ(found.nonmanifold_edges.count, found.edges);
}

/// Corners are whole numbers times a power of two, so that integers tell.
TEST(MeshCheck, TellsTrianglesWithoutAreaExactly) {
  Random random(5);
  Scene s = empty_scene();
  std::vector<std::uint32_t> flat;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    std::int64_t p[3][3];  // corners on a line, the last one beside it perhaps
    for (int a = 0; a < 3; ++a) {
      p[0][a] = random.below(1000);
      const std::int64_t step = random.below(1 << 17);
      p[1][a] = p[0][a] + 17 * step;
      p[2][a] = p[0][a] + 29 * step + (random.chance(.2) ? 1 : 0);
    }
    const auto edge = [&](int k, int a) { return p[k][a % 3] - p[0][a % 3]; };
    bool is_flat = true;
    for (int a = 0; a < 3; ++a)
      is_flat &= edge(1, a + 1) * edge(2, a + 2) == edge(1, a + 2) * edge(2, a + 1);
    if (is_flat)
      flat.push_back(i);
    const double scale = std::ldexp(1., static_cast<int>(random.below(60)) - 30);
    const auto corner = [&](int k) {
      return scaled(
          {static_cast<float>(p[k][0]), static_cast<float>(p[k][1]), static_cast<float>(p[k][2])},
          scale);
    };
    add_triangle(s, corner(0), corner(1), corner(2));
  }
  const MeshCheck found = check_mesh(s);
  EXPECT_GT(flat.size(), 1000u);
  EXPECT_LT(flat.size(), 2000u);
  EXPECT_EQ(found.degenerate_triangles.count, flat.size());
  flat.resize(Findings<MeshEdge>::kMost);
  EXPECT_EQ(found.degenerate_triangles.first, flat);
}

/// A corner so little beside the line of the others that doubles lose it.
TEST(MeshCheck, TellsAreasThatDoublesLose) {
  Scene s = empty_scene();
  for (const float beside : {0.f, 0x1p-60f, 0.f, -0x1p-100f})
    add_triangle(s, {beside, 0, 0}, {17, 34, 51}, {29, 58, 87});
  const MeshCheck found = check_mesh(s);
  EXPECT_EQ(found.degenerate_triangles.first, (std::vector<std::uint32_t>{0, 2}));
}

TEST(MeshCheck, RefusesVerticesThatAreNotThere) {
  Scene s = ball_mesh(8, 4);
  s.geometry.triangles.c[3] = 1000;
  EXPECT_THROW(check_mesh(s), std::invalid_argument);
}

TEST(MeshCheck, RefusesArraysOfUnequalLengths) {
  const Scene whole = ball_mesh(8, 4);
  const auto refuses = [&](auto shorten) {
    Scene s = whole;
    shorten(s.geometry.triangles);
    EXPECT_THROW(check_mesh(s), std::invalid_argument);
  };
  refuses([](Triangles& t) { t.b.pop_back(); });
  refuses([](Triangles& t) { t.c.pop_back(); });
  refuses([](Triangles& t) { t.y.pop_back(); });
  refuses([](Triangles& t) { t.z.pop_back(); });
  refuses([](Triangles& t) { t.nx.assign(3, 0); });
}

/// A mesh stays closed, as for queries.
TEST(MeshCheck, LeavesOutTrianglesThatAreNotFinite) {
  Scene s = ball_mesh(8, 4);
  const MeshCheck whole = check_mesh(s);
  const auto n = static_cast<std::uint32_t>(s.geometry.triangles.size());
  add_triangle(s, {kNaN, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(s, {0, 0, 0}, {1, 0, 0}, {0, -kInf, 0});
  s.geometry.triangles.a.back() = s.geometry.triangles.a.front();
  const MeshCheck found = check_mesh(s);
  EXPECT_TRUE(found.is_closed());
  EXPECT_EQ(found.triangles, whole.triangles);
  EXPECT_EQ(found.vertices, whole.vertices);
  EXPECT_EQ(found.degenerate_triangles.count, 0u);
  EXPECT_EQ(found.nonfinite_triangles.count, 2u);
  EXPECT_EQ(found.nonfinite_triangles.first, (std::vector<std::uint32_t>{n, n + 1}));
  EXPECT_TRUE(contains(World(s, {}), {0, 0, 0}));
}

TEST(MeshCheck, TakesZerosOfBothSignsForOne) {
  Scene s = empty_scene();
  const Float3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::uint32_t face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto signed_zeros = [](Float3 p, float zero) {
    return Float3{p.x == 0 ? zero : p.x, p.y == 0 ? zero : p.y, p.z == 0 ? zero : p.z};
  };
  float zero = 0;
  for (const auto& v : face) {
    zero = -zero;
    add_triangle(s,
                 signed_zeros(corner[v[0]], zero),
                 signed_zeros(corner[v[1]], zero),
                 signed_zeros(corner[v[2]], zero));
  }
  const MeshCheck found = check_mesh(s);
  EXPECT_TRUE(found.is_closed());
  EXPECT_EQ(found.vertices, 4u);
}

}  // namespace
}  // namespace grelha::test
