#include <string>
#include <type_traits>
#include <utility>

#include "c/world.hpp"

using grelha::c::Coordinates;
using grelha::c::Points;

grelha::SceneSpans grelha_world::scene(const Coordinates& coordinates) const {
  grelha::SceneSpans scene;
  if (is_of_triangles()) {
    grelha::TriangleSpans& t = scene.geometry.triangles;
    t.x = coordinates.x;
    t.y = coordinates.y;
    t.z = coordinates.z;
    t.a = a;
    t.b = b;
    t.c = c;
  } else {
    grelha::SphereSpans& s = scene.geometry.spheres;
    s.x = coordinates.x;
    s.y = coordinates.y;
    s.z = coordinates.z;
    s.radius = radius;
  }
  return scene;
}

namespace grelha::c {
namespace {

constexpr std::size_t kMostPrimitives = 0xFFFFFFFEu;
constexpr std::size_t kMostVertices = std::size_t{1} << 32;

void expect_at_most(std::size_t count, std::size_t most, const char* name) {
  if (count > most)
    throw TooMany(name + (": expected at most " + std::to_string(most)) + ", found " +
                  std::to_string(count));
}

/// Stores what make() makes, null if it throws.
template <class Make>
grelha_status make_world(grelha_world** world, const Make& make) noexcept {
  if (world)
    *world = nullptr;
  return guarded([&] {
    expect_there(world, "world");
    *world = make().release();
  });
}

void build(grelha_world& world, int threads) {
  world.built = std::make_unique<World>(world.scene(world.at),
                                        BuildOptions{.threads = expect_threads(threads)});
}

void copy_indices(const std::uint32_t* indices,
                  std::size_t triangles,
                  std::size_t vertices,
                  grelha_world& world) {
  std::vector<std::uint32_t>* const corners[3] = {&world.a, &world.b, &world.c};
  for (std::vector<std::uint32_t>* const corner : corners)
    corner->resize(triangles);
  for (std::size_t i = 0; i < triangles; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = indices[3 * i + k];
      if (vertex >= vertices)
        refuse("indices",
               "numbers below " + std::to_string(vertices),
               std::to_string(vertex) + " in triangle " + std::to_string(i));
      (*corners[k])[i] = vertex;
    }
}

/// Visits each vertex that a triangle names, and checks it. Others may be anything.
template <class Number, class Visit>
void each_used(const Points<Number>& points, const grelha_world& world, const Visit& visit) {
  std::vector<char> seen(points.count());
  for (const std::vector<std::uint32_t>* const corner : {&world.a, &world.b, &world.c})
    for (const std::uint32_t vertex : *corner) {
      if (std::exchange(seen[vertex], 1))
        continue;
      points.expect_usable(vertex);
      visit(vertex);
    }
}
/// The same of spheres.
template <class Number, class Visit>
void each_center(const Points<Number>& points, const Visit& visit) {
  for (std::size_t i = 0; i < points.count(); ++i) {
    points.expect_usable(i);
    visit(i);
  }
}

/// Floats stay as the caller has them, and so do rays and points.
template <class Number>
std::array<double, 3> offset_for(const PointBounds& bounds) {
  return std::is_same_v<Number, double> ? bounds.offset() : std::array<double, 3>{};
}

template <class Number>
std::unique_ptr<grelha_world> world_of_triangles(const Points<Number>& vertices,
                                                 const std::uint32_t* indices,
                                                 std::size_t count,
                                                 int threads) {
  expect_at_most(count, kMostPrimitives, "triangle_count");
  expect_at_most(vertices.count(), kMostVertices, "vertex_count");
  if (count > 0)
    expect_there(indices, "indices");
  auto world = std::make_unique<grelha_world>();
  copy_indices(indices, count, vertices.count(), *world);
  PointBounds bounds;
  each_used(vertices, *world, [&](std::size_t i) { vertices.add_to(bounds, i); });
  world->offset = offset_for<Number>(bounds);
  world->at = coordinates_of(vertices, world->offset);
  build(*world, threads);
  return world;
}

template <class Number>
std::unique_ptr<grelha_world> world_of_spheres(const Points<Number>& centers,
                                               const Number* radii,
                                               int threads) {
  expect_at_most(centers.count(), kMostPrimitives, "count");
  if (centers.count() > 0)
    expect_there(radii, "radii");
  auto world = std::make_unique<grelha_world>();
  PointBounds bounds;
  world->radius.reserve(centers.count());
  each_center(centers, [&](std::size_t i) {
    const float radius = static_cast<float>(radii[i]);
    if (!(radius > 0 && double{radii[i]} <= kLargest))
      refuse("radii",
             "numbers above 0 and within 1e18",
             std::to_string(radii[i]) + " in element " + std::to_string(i));
    world->radius.push_back(radius);
    centers.add_to(bounds, i);
  });
  world->offset = offset_for<Number>(bounds);
  world->at = coordinates_of(centers, world->offset);
  build(*world, threads);
  return world;
}

/// Replaces the coordinates once the new grids are there: an error leaves the world as it was.
template <class Number>
void move(grelha_world* world,
          const Points<Number>& points,
          const std::array<double, 3>& offset,
          int threads) {
  if (points.count() != world->at.x.size())
    refuse("count",
           "as many points as before, " + std::to_string(world->at.x.size()),
           std::to_string(points.count()));
  const auto nothing_more = [](std::size_t) {};
  if (world->is_of_triangles())
    each_used(points, *world, nothing_more);
  else
    each_center(points, nothing_more);
  Coordinates moved = coordinates_of(points, offset);
  world->built->update(world->scene(moved), {.threads = expect_threads(threads)});
  std::swap(world->at, moved);
}

}  // namespace
}  // namespace grelha::c

grelha_status grelha_new_triangles(const float* vertices,
                                   ptrdiff_t vertex_stride,
                                   size_t vertex_count,
                                   const uint32_t* indices,
                                   size_t triangle_count,
                                   int threads,
                                   grelha_world** world) {
  return grelha::c::make_world(world, [&] {
    const Points<float> points(vertices, vertex_stride, vertex_count, "vertices");
    return grelha::c::world_of_triangles(points, indices, triangle_count, threads);
  });
}

grelha_status grelha_new_triangles_double(const double* vertices,
                                          ptrdiff_t vertex_stride,
                                          size_t vertex_count,
                                          const uint32_t* indices,
                                          size_t triangle_count,
                                          int threads,
                                          grelha_world** world) {
  return grelha::c::make_world(world, [&] {
    const Points<double> points(vertices, vertex_stride, vertex_count, "vertices");
    return grelha::c::world_of_triangles(points, indices, triangle_count, threads);
  });
}

grelha_status grelha_new_spheres(const float* centers,
                                 ptrdiff_t center_stride,
                                 const float* radii,
                                 size_t count,
                                 int threads,
                                 grelha_world** world) {
  return grelha::c::make_world(world, [&] {
    const Points<float> points(centers, center_stride, count, "centers");
    return grelha::c::world_of_spheres(points, radii, threads);
  });
}

grelha_status grelha_new_spheres_double(const double* centers,
                                        ptrdiff_t center_stride,
                                        const double* radii,
                                        size_t count,
                                        int threads,
                                        grelha_world** world) {
  return grelha::c::make_world(world, [&] {
    const Points<double> points(centers, center_stride, count, "centers");
    return grelha::c::world_of_spheres(points, radii, threads);
  });
}

grelha_status grelha_offset(const grelha_world* world, double offset[3]) {
  return grelha::c::guarded([&] {
    grelha::c::expect_there(world, "world");
    grelha::c::expect_there(offset, "offset");
    std::copy(world->offset.begin(), world->offset.end(), offset);
  });
}

grelha_status grelha_update(
    grelha_world* world, const float* points, ptrdiff_t stride, size_t count, int threads) {
  return grelha::c::guarded([&] {
    grelha::c::expect_there(world, "world");
    grelha::c::move(world, Points<float>(points, stride, count, "points"), {}, threads);
  });
}

grelha_status grelha_update_double(
    grelha_world* world, const double* points, ptrdiff_t stride, size_t count, int threads) {
  return grelha::c::guarded([&] {
    grelha::c::expect_there(world, "world");
    grelha::c::move(world, Points<double>(points, stride, count, "points"), world->offset, threads);
  });
}

grelha_status grelha_set_masks(grelha_world* world, const uint8_t* masks, size_t count) {
  using namespace grelha::c;
  return guarded([&] {
    expect_there(world, "world");
    const std::size_t all = world->is_of_triangles() ? world->a.size() : world->radius.size();
    if (count != 0 && count != all)
      refuse("count", "0 or " + std::to_string(all), std::to_string(count));
    if (count != 0)
      expect_there(masks, "masks");
    world->masks.assign(masks, masks + count);
  });
}

void grelha_free(grelha_world* world) {
  delete world;
}
