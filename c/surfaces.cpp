#include <algorithm>
#include <span>
#include <vector>

#include "c/world.hpp"

namespace grelha::c {
namespace {

constexpr std::size_t kCopied = std::size_t{1} << 14;

void store(std::span<const SurfacePoint> found, grelha_surface* to) {
  for (const SurfacePoint& s : found)
    *to++ = {.point = {s.point.x, s.point.y, s.point.z},
             .normal = {s.normal.x, s.normal.y, s.normal.z},
             .offset = s.offset};
}

SurfacePoint point_of(const grelha_surface& s) {
  SurfacePoint point{};
  point.point = {s.point[0], s.point[1], s.point[2]};
  point.normal = {s.normal[0], s.normal[1], s.normal[2]};
  point.offset = s.offset;
  return point;
}

}  // namespace
}  // namespace grelha::c

grelha_status grelha_surfaces(const grelha_world* world,
                              const grelha_rays* rays,
                              const grelha_hits* hits,
                              grelha_surface* surfaces,
                              int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    const grelha::Rays stream = rays_of(rays);
    expect_there(hits, "hits");
    if (stream.count > 0) {
      expect_floats(hits->t, "t");
      expect_there(hits->id, "id");
      expect_there(surfaces, "surfaces");
    }
    each_part(stream.count, kCopied, [&](Part part) {
      std::vector<grelha::Ray> own;
      std::vector<grelha::Hit> met;
      for (std::size_t i = part.first; i < part.end; ++i) {
        own.push_back(stream[i]);
        met.push_back({hits->t[i], hits->id[i]});
      }
      std::vector<grelha::SurfacePoint> found(own.size());
      grelha::surfaces(asked, own, met, found, options_of(world, threads, part));
      store(found, surfaces + part.first);
    });
  });
}

grelha_status grelha_surfaces_at(const grelha_world* world,
                                 const uint32_t* ids,
                                 const float* u,
                                 const float* v,
                                 size_t count,
                                 grelha_surface* surfaces,
                                 int threads) {
  using namespace grelha::c;
  return guarded([&] {
    const grelha::World& asked = world_of(world);
    if (count > 0) {
      expect_there(ids, "ids");
      expect_there(u, "u");
      expect_there(v, "v");
      expect_there(surfaces, "surfaces");
    }
    each_part(count, kCopied, [&](Part part) {
      const std::size_t first = part.first, some = part.end - part.first;
      std::vector<grelha::SurfacePoint> found(some);
      grelha::surfaces_at(asked,
                          {ids + first, some},
                          {u + first, some},
                          {v + first, some},
                          found,
                          options_of(world, threads, part));
      store(found, surfaces + first);
    });
  });
}

grelha_status grelha_start(const grelha_surface* surfaces,
                           size_t count,
                           const float* dir,
                           ptrdiff_t dir_stride,
                           float* origins) {
  using namespace grelha::c;
  return guarded([&] {
    if (count == 0)
      return;
    expect_there(surfaces, "surfaces");
    expect_floats(dir, "dir");
    expect_there(origins, "origins");
    const std::ptrdiff_t stride = floats_of(dir_stride, count, "dir_stride");
    for (std::size_t i = 0; i < count; ++i) {
      const float* const d = dir + static_cast<std::ptrdiff_t>(i) * stride;
      const grelha::Float3 from = point_of(surfaces[i]).start({d[0], d[1], d[2]});
      const float xyz[] = {from.x, from.y, from.z};
      std::ranges::copy(xyz, origins + 3 * i);
    }
  });
}
