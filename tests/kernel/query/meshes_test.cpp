// Several meshes in one World: whose triangles they are, and changes of one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "grelha/distance.hpp"
#include "grelha/inside.hpp"
#include "grelha/mesh_check.hpp"
#include "grelha/meshes.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/random.hpp"
#include "tests/support/same_grids.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// A mesh of its own arrays.
struct Mesh {
  std::vector<Float3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;
  MeshArrays arrays() const { return {PointArray(std::span(vertices)), faces}; }
};

Mesh mesh_of(const Scene& s, Float3 by) {
  Mesh mesh;
  const Triangles& t = s.geometry.triangles;
  for (std::size_t v = 0; v < t.vertex_count(); ++v)
    mesh.vertices.push_back({t.x[v] + by.x, t.y[v] + by.y, t.z[v] + by.z});
  for (std::size_t i = 0; i < t.size(); ++i)
    mesh.faces.push_back({t.a[i], t.b[i], t.c[i]});
  return mesh;
}

/// Balls side by side, a small and an empty mesh among them.
std::vector<Mesh> row_of_balls(int count) {
  std::vector<Mesh> meshes;
  for (int i = 0; i < count; ++i)
    meshes.push_back(mesh_of(ball_mesh(24, 12, .1, static_cast<std::uint64_t>(i)),
                             {2.5f * static_cast<float>(i), 0, 0}));
  meshes.insert(meshes.begin() + 1, Mesh{});
  meshes.push_back(mesh_of(ball_mesh(6, 4), {0, 3, 0}));
  return meshes;
}

OffsetScene joined(const std::vector<Mesh>& meshes) {
  std::vector<MeshArrays> arrays;
  for (const Mesh& mesh : meshes)
    arrays.push_back(mesh.arrays());
  return scene_of(arrays);
}

/// Where the blocks of grids lie in memory.
std::set<const void*> stores(const World& world) {
  std::set<const void*> all;
  for (int i = 0; i < world.impl().view.grid_count; ++i)
    all.insert(world.impl().view.grids[i].lists.of<Triangle>().blocks);
  return all;
}
std::size_t shared(const World& a, const World& b) {
  const std::set<const void*> of_a = stores(a);
  std::size_t count = 0;
  for (const void* store : stores(b))
    count += of_a.count(store);
  return count;
}

/// The same hits, closest points and insides, by ids of `b` less `less` from an id on.
void expect_same_answers(const World& a,
                         const World& b,
                         std::uint32_t from = kNoPrimitive,
                         std::uint32_t less = 0) {
  const auto own = [&](std::uint32_t id) {
    return id != kNoPrimitive && id >= from ? id + less : id;
  };
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const Float3 p = random.point(9), way = random.direction();
    const Hit x = closest(a, {p, way}), y = closest(b, {p, way});
    ASSERT_EQ(x.id, own(y.id));
    ASSERT_EQ(x.t, y.t);
    const ClosestPoint near = closest_point(a, p), other = closest_point(b, p);
    ASSERT_EQ(near.id, own(other.id));
    ASSERT_EQ(near.point, other.point);
    ASSERT_EQ(contains(a, p), contains(b, p));
    ASSERT_EQ(contains(a, p, InsideRule::kWinding), contains(b, p, InsideRule::kWinding));
  }
}

TEST(Meshes, KnowTheirTriangles) {
  const std::vector<Mesh> meshes = row_of_balls(3);
  const OffsetScene scene = joined(meshes);
  ASSERT_EQ(mesh_count(scene), meshes.size());
  std::uint32_t id = 0;
  for (std::uint32_t m = 0; m < meshes.size(); ++m)
    for (std::uint32_t face = 0; face < meshes[m].faces.size(); ++face)
      ASSERT_EQ(mesh_face(scene, id++), (MeshFace{m, face}));
  EXPECT_EQ(mesh_face(scene, id), MeshFace{});
  EXPECT_EQ(mesh_face(scene, kNoPrimitive), MeshFace{});
  OffsetScene one;
  one.geometry.spheres.add({}, 1, 0);
  add_triangle(one, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(mesh_count(one), 1u);
  EXPECT_EQ(mesh_face(one, 0), MeshFace{});
  EXPECT_EQ(mesh_face(one, 1), (MeshFace{0, 0}));
}

/// Of twenty meshes sixteen have grids of their own, the one that moves among them.
TEST(Meshes, ThatMoveGetGridsOfTheirOwn) {
  std::vector<Mesh> meshes = row_of_balls(20);
  OffsetScene scene = joined(meshes);
  OwningWorld world(scene, {});
  for (int step = 0; step < 6; ++step) {
    for (Float3& v : meshes[19].vertices)
      v.y += .01f;
    const Object moved = move_mesh(scene, 19, PointArray(std::span(meshes[19].vertices)));
    const OwningWorld next(scene, {}, world, {&moved, 1});
    EXPECT_EQ(next.world().grids().size(), 17u);
    EXPECT_EQ(shared(world.world(), next.world()), step == 0 ? 15u : 16u) << step;
    world.replace(scene, {}, {&moved, 1});
    if (step % 5 == 0)
      expect_same_answers(world.world(), World(scene, {}));
  }
}

/// Where the box around all grows a little, grids are shared as well.
TEST(Meshes, OfABoxThatGrowsStayBuilt) {
  std::vector<Mesh> meshes = row_of_balls(4);
  const OwningWorld world(joined(meshes), {});
  for (Float3& v : meshes[4].vertices)
    v.x += .01f;
  const OffsetScene after = joined(meshes);
  const Object& moved = after.geometry.objects[4];
  const OwningWorld next(after, {}, world, {&moved, 1});
  EXPECT_EQ(shared(world.world(), next.world()), 4u);
  EXPECT_TRUE(same_grids(next.world(), World(after, {})));
}

TEST(Meshes, ThatAreHiddenAreNotThere) {
  std::vector<Mesh> meshes = row_of_balls(4);
  OffsetScene scene = joined(meshes);
  const OwningWorld all(scene, {});
  for (const std::size_t hidden : {std::size_t{0}, std::size_t{2}, meshes.size() - 1}) {
    std::vector<Mesh> rest = meshes;
    const auto faces = static_cast<std::uint32_t>(rest[hidden].faces.size());
    rest[hidden] = {};
    const std::uint32_t from = scene.geometry.objects[hidden].first_triangle;
    show_mesh(scene, hidden, false);
    const OwningWorld without(scene, {}, all, {});
    EXPECT_EQ(shared(all.world(), without.world()), 4u);
    EXPECT_TRUE(same_grids(without.world(), World(scene, {})));
    const OffsetScene left = joined(rest);
    expect_same_answers(without.world(), World(left, {}), from, faces);
    EXPECT_EQ(check_mesh(without.world()).triangles, scene.geometry.triangles.size() - faces);
    show_mesh(scene, hidden, true);
    const OwningWorld again(scene, {}, without, {});
    EXPECT_EQ(shared(again.world(), without.world()), 4u);
    EXPECT_EQ(shared(again.world(), all.world()), 5u);
    EXPECT_TRUE(same_grids(again.world(), all.world()));
  }
}

/// Hills and dales that change places have the same box, and a grid of the same cells.
TEST(Meshes, ThatMoveWhileTheyAreHiddenAreBuiltAnew) {
  constexpr std::uint32_t kSide = 21;
  std::vector<Mesh> meshes(2);
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const auto x = static_cast<float>(i % kSide) + 30 * static_cast<float>(m);
      meshes[m].vertices.push_back({x, static_cast<float>(i / kSide), i % 2 == 0 ? 0.f : 1.f});
      if (i % kSide == kSide - 1 || i / kSide == kSide - 1)
        continue;
      meshes[m].faces.push_back({i, i + 1, i + kSide + 1});
      meshes[m].faces.push_back({i, i + kSide + 1, i + kSide});
    }
  OffsetScene scene = joined(meshes);
  OwningWorld world(scene, {});
  show_mesh(scene, 0, false);
  world.replace(scene, {}, {});
  for (Float3& v : meshes[0].vertices)
    v.z = 1 - v.z;
  const Object moved = move_mesh(scene, 0, PointArray(std::span(meshes[0].vertices)));
  world.replace(scene, {}, {&moved, 1});
  show_mesh(scene, 0, true);
  world.replace(scene, {}, {});
  const World fresh(scene, {});
  for (int i = 0; i < 400; ++i) {
    const Ray ray{{.05f * static_cast<float>(i), 7.3f, 5}, {0, 0, -1}};
    EXPECT_EQ(closest(world.world(), ray).t, closest(fresh, ray).t);
  }
}

/// A hidden mesh with a hole leaves the others closed.
TEST(Meshes, ThatAreHiddenNeedNotBeClosed) {
  std::vector<Mesh> meshes = row_of_balls(2);
  meshes[0].faces.pop_back();
  OffsetScene scene = joined(meshes);
  EXPECT_THROW(contains(World(scene, {}), {0, 0, 0}), NotClosed);
  show_mesh(scene, 0, false);
  const World world(scene, {});
  EXPECT_TRUE(check_mesh(scene).is_closed());
  EXPECT_FALSE(contains(world, {0, 0, 0}));
  EXPECT_TRUE(contains(world, {2.5f, 0, 0}));
  EXPECT_NEAR(winding_number(world, {0, 0, 0}), 0, .01);
  show_mesh(scene, 2, false);
  show_mesh(scene, 3, false);
  const World nothing(scene, {});
  EXPECT_FALSE(closest(nothing, {{0, 0, 9}, {0, 0, -1}}));
  EXPECT_EQ(closest_point(nothing, {0, 0, 0}).id, kNoPrimitive);
  EXPECT_EQ(winding_number(nothing, {0, 0, 0}), 0);
}

TEST(Meshes, ThatAreAddedLeaveGridsOfOthers) {
  std::vector<Mesh> meshes = row_of_balls(3);
  OwningWorld world(joined(meshes), {});
  const World* const before = &world.world();
  const std::set<const void*> old = stores(*before);
  std::vector<std::uint8_t> masks(world.scene().geometry.triangles.size(), 1);
  world.set_masks(masks);
  OffsetScene scene = world.scene();
  meshes.push_back(mesh_of(ball_mesh(24, 12, .1, 9), {2.5f, 2.5f, 0}));
  const Object added = add_mesh(scene, meshes.back().arrays());
  world.replace(scene, {}, {&added, 1});
  std::size_t kept = 0;
  for (const void* store : stores(world.world()))
    kept += old.count(store);
  EXPECT_EQ(kept, 4u);
  const OffsetScene all = joined(meshes);
  EXPECT_TRUE(same_grids(world.world(), World(all, {})));
  EXPECT_EQ(mesh_face(world.scene(), added.first_triangle), (MeshFace{5, 0}));
  EXPECT_EQ(world.masks().size(), masks.size() + added.triangle_count);
  EXPECT_EQ(world.masks().back(), 255);
  OffsetScene one =
      scene_of(PointArray(std::span(meshes[0].vertices)),
               triangles_of<std::uint32_t>(meshes[0].faces, meshes[0].vertices.size()));
  add_mesh(one, meshes[2].arrays());
  EXPECT_EQ(mesh_count(one), 2u);
  const OffsetScene two = joined({meshes[0], meshes[2]});
  EXPECT_TRUE(same_grids(World(one, {}), World(two, {})));
}

TEST(Meshes, InDoubleHaveOneOffset) {
  const std::vector<double> far = {1e7, 0, 0, 1e7 + 1, 0, 0, 1e7, 1, 0};
  const std::vector<float> near = {10000004, 0, 0, 10000005, 0, 0, 10000004, 1, 0};
  const std::vector<std::array<std::uint32_t, 3>> face = {{0, 1, 2}};
  const MeshArrays meshes[] = {{PointArray(far.data(), 24, 3, "far"), face},
                               {PointArray(near.data(), 12, 3, "near"), face}};
  OffsetScene scene = scene_of(meshes);
  EXPECT_NEAR(scene.offset[0], 1e7, 8);
  EXPECT_EQ(scene.geometry.triangles.x[3] - scene.geometry.triangles.x[0], 4);
  const std::vector<double> moved = {1e7 + 6, 0, 0, 1e7 + 7, 0, 0, 1e7 + 6, 1, 0};
  move_mesh(scene, 1, PointArray(moved.data(), 24, 3, "moved"));
  EXPECT_EQ(scene.geometry.triangles.x[3] - scene.geometry.triangles.x[0], 6);
  const std::vector<float> local = {8, 0, 0, 9, 0, 0, 8, 1, 0};
  move_mesh(scene, 1, PointArray(local.data(), 12, 3, "local"));
  EXPECT_EQ(scene.geometry.triangles.x[3], 8);
}

/// Squares of a survey: the sums are no floats.
std::vector<double> square(double x, double y) {
  return {x - .37, y - .37, 0, x + .37, y - .37, 0, x + .37, y + .37, 0, x - .37, y + .37, 0};
}
PointArray points_of(const std::vector<double>& square) {
  return {square.data(), 24, square.size() / 3, "vertices"};
}

/// Whoever comes or goes, the offset is one that floats resolve the scene from, and vertices are
/// rounded once.
TEST(Meshes, InDoubleAreRoundedAsInANewWorld) {
  constexpr double kX = 431234.123, kY = 4583210.321;
  const std::vector<std::array<std::uint32_t, 3>> faces = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<double> near[] = {square(0, .1), square(1, 0)},
                            far[] = {square(kX, kY), square(kX + 1, kY + .1)};
  const auto together = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return scene_of(std::vector<MeshArrays>{{points_of(a), faces}, {points_of(b), faces}});
  };
  const auto expect_same = [](const OffsetScene& a, const OffsetScene& b) {
    EXPECT_EQ(a.offset, b.offset);
    EXPECT_EQ(a.geometry.triangles.x, b.geometry.triangles.x);
    EXPECT_EQ(a.geometry.triangles.y, b.geometry.triangles.y);
  };
  const OffsetScene end = together(far[0], far[1]);
  OffsetScene moved = together(near[0], near[1]);
  OwningWorld world(moved, {});
  for (std::size_t i = 0; i < 2; ++i) {
    const Object all = move_mesh(moved, i, points_of(far[i]));
    EXPECT_EQ(all.triangle_count, i == 0 ? 2u : 4u) << "with a new offset all have moved";
    world.replace(moved, {}, {&all, 1});
    EXPECT_TRUE(same_grids(world.world(), World(moved, {})));
  }
  expect_same(moved, end);
  OffsetScene added = scene_of(std::span<const MeshArrays>{});
  for (const std::vector<double>& one : far)
    add_mesh(added, {points_of(one), faces});
  expect_same(added, end);
  std::vector<double> both = far[0];
  both.insert(both.end(), far[1].begin(), far[1].end());
  OwningWorld updated(together(near[0], near[1]), {});
  updated.move(points_of(both), {});
  expect_same(updated.scene(), end);
  const std::vector<double> back[] = {square(9e6, 1), square(9e6 + 1, 1)};
  OffsetScene again = updated.scene();
  for (std::size_t i = 0; i < 2; ++i)
    move_mesh(again, i, points_of(back[i]));
  expect_same(again, together(back[0], back[1]));
}

/// Whether two Worlds give the same bits.
void expect_same_hits(const World& a, const World& b, Random& random, std::uint64_t run) {
  for (int i = 0; i < 40; ++i) {
    const Float3 p = random.point(6), way = random.direction();
    const Hit x = closest(a, {p, way}), y = closest(b, {p, way});
    ASSERT_EQ(x.id, y.id) << "run " << run;
    ASSERT_EQ(x.t, y.t) << "run " << run;
    const ClosestPoint near = closest_point(a, p), other = closest_point(b, p);
    ASSERT_EQ(near.id, other.id) << "run " << run;
    ASSERT_EQ(near.point, other.point) << "run " << run;
  }
}

/// Meshes that come, move, hide and go at random, and the same in a list of ours.
class RandomChanges {
 public:
  explicit RandomChanges(std::uint64_t run) : random_(run), world_(joined({}), {}) {}

  void change() {
    const std::size_t count = meshes_.size();
    const std::size_t some = random_.below(static_cast<std::uint32_t>(count) + 1);
    if (some == count || (count < 3 && random_.below(2) == 0))
      add();
    else if (const std::uint32_t kind = random_.below(5); kind == 0)
      remove(some);
    else if (kind < 3)
      move(some);
    else
      show(some, kind == 3);
  }
  void expect_same(std::uint64_t run) {
    OffsetScene scene = joined(meshes_);
    for (std::size_t i = 0; i < meshes_.size(); ++i)
      show_mesh(scene, i, visible_[i]);
    expect_same_hits(world_.world(), World(scene, {}), random_, run);
    ASSERT_EQ(mesh_count(world_.scene()), meshes_.size());
    ASSERT_EQ(world_.scene().geometry.triangles.size(), scene.geometry.triangles.size());
  }

 private:
  Float3 place() { return random_.point(4); }
  void add() {
    const bool is_large = random_.below(2) == 0;  // enough for a grid of its own
    const int sides = is_large ? 16 : 5, seed = static_cast<int>(random_.below(9));
    meshes_.push_back(mesh_of(ball_mesh(sides, 10, .1, static_cast<std::uint64_t>(seed)), place()));
    visible_.push_back(true);
    add_mesh(world_, meshes_.back().arrays(), {});
  }
  void remove(std::size_t mesh) {
    const auto at = static_cast<std::ptrdiff_t>(mesh);
    meshes_.erase(meshes_.begin() + at);
    visible_.erase(visible_.begin() + at);
    remove_mesh(world_, mesh, {});
  }
  void move(std::size_t mesh) {
    std::vector<MeshMove> moves;
    for (std::size_t i = mesh; i < meshes_.size() && i < mesh + 2; ++i) {
      const Float3 by = .25f * place();
      for (Float3& v : meshes_[i].vertices)
        v = v + by;
      moves.push_back({i, PointArray(std::span(meshes_[i].vertices))});
    }
    move_meshes(world_, moves, {});
  }
  void show(std::size_t mesh, bool visible) {
    visible_[mesh] = visible;
    show_mesh(world_, mesh, visible, {});
  }

  Random random_;
  std::vector<Mesh> meshes_;
  std::vector<bool> visible_;
  OwningWorld world_;
};

TEST(Meshes, ThatChangeAtRandomAreThoseOfANewWorld) {
  for (std::uint64_t run = 0; run < 1000 && !HasFailure(); ++run) {
    RandomChanges changes(run);
    for (int step = 0; step < 12; ++step) {
      changes.change();
      changes.expect_same(run);
    }
  }
}

/// Whatever a build that is stopped began, the World and its scene are as before.
TEST(Meshes, StayWhereABuildIsStopped) {
  const std::vector<Mesh> meshes = row_of_balls(3);
  const BuildOptions stopped{.progress = [](double) { return false; }};
  OwningWorld world(joined(meshes), {});
  const OffsetScene before = world.scene();
  const std::vector<Float3> flat(meshes[2].vertices.size(), Float3{1, 2, 3});
  const MeshMove move{2, PointArray(std::span(flat))};
  for (int again = 0; again < 2; ++again) {
    EXPECT_THROW(move_meshes(world, {&move, 1}, stopped), Stopped);
    EXPECT_THROW(show_mesh(world, 0, false, stopped), Stopped);
    EXPECT_THROW(remove_mesh(world, 0, stopped), Stopped);
    EXPECT_THROW(add_mesh(world, meshes[0].arrays(), stopped), Stopped);
    EXPECT_EQ(world.scene().geometry.triangles.x, before.geometry.triangles.x);
    EXPECT_EQ(world.scene().geometry.triangles.a, before.geometry.triangles.a);
    EXPECT_EQ(world.scene().first_vertices, before.first_vertices);
    EXPECT_TRUE(mesh_range(world.scene(), 0).triangles.visible);
    expect_same_answers(world.world(), World(before, {}));
    const MeshMove same{0, PointArray(std::span(meshes[0].vertices))};
    move_meshes(world, {&same, 1}, {});
  }
}

/// The others are not looked at again.
TEST(Meshes, ThatMoveAreCheckedWithWhatIsNew) {
  const OffsetScene scene = joined(row_of_balls(3));
  const World world(scene, {});
  const Object last = scene.geometry.objects[3];
  const auto refuses = [&](const Scene& after, const Object& moved) {
    EXPECT_THROW(World(after, {}, world, {&moved, 1}), std::invalid_argument);
  };
  Scene bad = scene;
  bad.geometry.triangles.b[last.first_triangle] = 1u << 20;
  refuses(bad, last);
  Scene more = scene;
  for (std::vector<std::uint32_t>* const corner :
       {&more.geometry.triangles.a, &more.geometry.triangles.b, &more.geometry.triangles.c})
    corner->push_back(1u << 20);
  refuses(more, last);
  Scene less = scene;
  less.geometry.triangles.x.resize(9);
  less.geometry.triangles.y.resize(9);
  less.geometry.triangles.z.resize(9);
  refuses(less, {});
  refuses(scene, {last.first_triangle, 1u << 20});
}

/// Where one of two goes, the offset is that of a new World.
TEST(Meshes, InDoubleThatAreRemovedLeaveTheOffsetOfTheRest) {
  const std::vector<std::array<std::uint32_t, 3>> faces = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<double> near = square(.1, .2), far = square(4e6 + .1, .3);
  OwningWorld world(
      scene_of(std::vector<MeshArrays>{{points_of(near), faces}, {points_of(far), faces}}), {});
  remove_mesh(world, 0, {});
  const OffsetScene rest = scene_of(std::vector<MeshArrays>{{points_of(far), faces}});
  EXPECT_EQ(world.scene().offset, rest.offset);
  EXPECT_EQ(world.scene().geometry.triangles.x, rest.geometry.triangles.x);
  EXPECT_TRUE(same_grids(world.world(), World(rest, {})));
}

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& bad) {
    return bad.what();
  }
  return "";
}

TEST(Meshes, AreRefusedByName) {
  std::vector<Mesh> meshes = row_of_balls(2);
  OffsetScene scene = joined(meshes);
  const OffsetScene before = scene;
  meshes[2].vertices[7].y = NAN;
  EXPECT_EQ(refusal([&] { joined(meshes); }).find("mesh 2: points: expected finite"), 0u);
  EXPECT_THROW(move_mesh(scene, 2, PointArray(std::span(meshes[2].vertices))), BadNumber);
  EXPECT_THROW(add_mesh(scene, meshes[2].arrays()), BadNumber);
  meshes[0].faces[3][1] = 1u << 30;
  EXPECT_EQ(refusal([&] { joined(meshes); }).find("mesh 0: indices: expected"), 0u);
  meshes[3].vertices.pop_back();
  EXPECT_NE(refusal([&] {
              move_mesh(scene, 3, PointArray(std::span(meshes[3].vertices)));
            }).find("as many vertices as before"),
            std::string::npos);
  EXPECT_NE(refusal([&] { show_mesh(scene, 4, false); }).find("less than 4, found 4"),
            std::string::npos);
  EXPECT_EQ(scene.geometry.triangles.x, before.geometry.triangles.x);
  EXPECT_EQ(scene.first_vertices, before.first_vertices);
  scene.geometry.spheres.add({}, 1, 0);
  EXPECT_THROW(add_mesh(scene, row_of_balls(1)[0].arrays()), std::invalid_argument);
}

}  // namespace
}  // namespace grelha::test
