#include "frontend/commands/first_hits.hpp"

#include <cmath>

#include "kernel/scene/frame.hpp"
#include "grelha/query.hpp"

namespace grelha {
namespace {

/// The rays of one row of pixels, as the kernel's camera_rays() sends them.
struct RowOfRays {
  explicit RowOfRays(const FrameView& f) : frame(f), width(std::size_t(f.width)) {
    for (std::vector<float>* list : {&ox, &oy, &oz, &dx, &dy, &dz, &t_min, &t})
      list->resize(width);
    id.resize(width);
  }

  void aim(int y) {
    const float sy = .5f * float(frame.height) - (float(y) + .5f);
    for (std::size_t x = 0; x < width; ++x) {
      const float sx = (float(x) + .5f) - .5f * float(frame.width);
      float d[3];
      for (int k = 0; k < 3; ++k)
        d[k] = (frame.forward[k] + sx * frame.right[k]) + sy * frame.up[k];
      const float length = std::sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
      ox[x] = frame.eye[0];
      oy[x] = frame.eye[1];
      oz[x] = frame.eye[2];
      dx[x] = d[0] / length;
      dy[x] = d[1] / length;
      dz[x] = d[2] / length;
      t[x] = std::numeric_limits<float>::infinity();
      id[x] = kNoPrimitive;
    }
  }

  Ray ray(std::size_t x) const { return {{ox[x], oy[x], oz[x]}, {dx[x], dy[x], dz[x]}}; }

  RaySpan span() {
    RaySpan rays;
    rays.ox = ox.data();
    rays.oy = oy.data();
    rays.oz = oz.data();
    rays.dx = dx.data();
    rays.dy = dy.data();
    rays.dz = dz.data();
    rays.t_min = t_min.data();
    rays.t = t.data();
    rays.id = id.data();
    rays.count = int(width);
    return rays;
  }

  const FrameView& frame;
  std::size_t width;
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t;
  std::vector<std::uint32_t> id;
};

/// The side that is seen.
Float3 facing(const Float3& normal, const Float3& direction) {
  const float along = (normal.x * direction.x + normal.y * direction.y) + normal.z * direction.z;
  return along > 0 ? Float3{-normal.x, -normal.y, -normal.z} : normal;
}

}  // namespace

Layers first_hits(const World& world, const Camera& camera, const LayerChoice& wanted) {
  const FrameView frame = make_frame(camera);
  RowOfRays row(frame);
  const std::size_t pixels = row.width * std::size_t(camera.height);
  Layers layers;
  if (wanted.depth)
    layers.depth.reserve(pixels);
  if (wanted.normal)
    layers.normal.reserve(3 * pixels);
  if (wanted.id)
    layers.id.reserve(pixels);
  for (int y = 0; y < camera.height; ++y) {
    row.aim(y);
    closest(world, row.span());
    if (wanted.depth)
      layers.depth.insert(layers.depth.end(), row.t.begin(), row.t.end());
    if (wanted.id)
      layers.id.insert(layers.id.end(), row.id.begin(), row.id.end());
    for (std::size_t x = 0; wanted.normal && x < row.width; ++x) {
      const Ray ray = row.ray(x);
      const Hit hit{row.t[x], row.id[x]};
      const Float3 n = hit ? facing(surface(world, ray, hit).shading, ray.dir) : Float3{};
      layers.normal.insert(layers.normal.end(), {n.x, n.y, n.z});
    }
  }
  return layers;
}

}  // namespace grelha
