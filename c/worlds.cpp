#include <algorithm>

#include "c/world.hpp"

namespace grelha::c {
namespace {

OffsetScene scene_of_triangles(const PointArray& vertices,
                               const std::uint32_t* indices,
                               std::size_t count) {
  expect_at_most(count, kMostPrimitives, "triangle_count");
  expect_at_most(vertices.count, kMostVertices, "vertex_count");
  if (count > 0)
    expect_there(indices, "indices");
  const auto* const faces = reinterpret_cast<const std::array<std::uint32_t, 3>*>(indices);
  return scene_of(vertices, triangles_of<std::uint32_t>({faces, count}, vertices.count));
}

template <class Number>
OffsetScene scene_of_spheres(const PointArray& centers, const Number* radii) {
  expect_at_most(centers.count, kMostPrimitives, "count");
  if (centers.count > 0)
    expect_there(radii, "radii");
  return scene_of(centers, spheres_of<Number>({radii, centers.count}));
}

/// Moves the points of a world.
template <class Number>
grelha_status update(grelha_world* world,
                     const Number* points,
                     std::ptrdiff_t stride,
                     std::size_t count,
                     int threads) noexcept {
  return guarded([&] {
    expect_there(world, "world");
    world->move({points, stride, count, "points"}, build_options(threads));
  });
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
  return grelha::c::make_world(world, threads, [&] {
    return grelha::c::scene_of_triangles(
        {vertices, vertex_stride, vertex_count, "vertices"}, indices, triangle_count);
  });
}

grelha_status grelha_new_triangles_double(const double* vertices,
                                          ptrdiff_t vertex_stride,
                                          size_t vertex_count,
                                          const uint32_t* indices,
                                          size_t triangle_count,
                                          int threads,
                                          grelha_world** world) {
  return grelha::c::make_world(world, threads, [&] {
    return grelha::c::scene_of_triangles(
        {vertices, vertex_stride, vertex_count, "vertices"}, indices, triangle_count);
  });
}

grelha_status grelha_new_spheres(const float* centers,
                                 ptrdiff_t center_stride,
                                 const float* radii,
                                 size_t count,
                                 int threads,
                                 grelha_world** world) {
  return grelha::c::make_world(world, threads, [&] {
    return grelha::c::scene_of_spheres({centers, center_stride, count, "centers"}, radii);
  });
}

grelha_status grelha_new_spheres_double(const double* centers,
                                        ptrdiff_t center_stride,
                                        const double* radii,
                                        size_t count,
                                        int threads,
                                        grelha_world** world) {
  return grelha::c::make_world(world, threads, [&] {
    return grelha::c::scene_of_spheres({centers, center_stride, count, "centers"}, radii);
  });
}

grelha_status grelha_offset(const grelha_world* world, double offset[3]) {
  return grelha::c::guarded([&] {
    grelha::c::expect_there(world, "world");
    grelha::c::expect_there(offset, "offset");
    std::ranges::copy(world->scene().offset, offset);
  });
}

grelha_status grelha_update(
    grelha_world* world, const float* points, ptrdiff_t stride, size_t count, int threads) {
  return grelha::c::update(world, points, stride, count, threads);
}

grelha_status grelha_update_double(
    grelha_world* world, const double* points, ptrdiff_t stride, size_t count, int threads) {
  return grelha::c::update(world, points, stride, count, threads);
}

grelha_status grelha_set_masks(grelha_world* world, const uint8_t* masks, size_t count) {
  return grelha::c::guarded([&] {
    grelha::c::expect_there(world, "world");
    if (count != 0)
      grelha::c::expect_there(masks, "masks");
    world->set_masks({masks, count});
  });
}

void grelha_free(grelha_world* world) {
  delete world;
}
