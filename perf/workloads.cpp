#include "perf/workloads.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "frontend/input/read_scene.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/world/world_impl.hpp"
#include "scenes/generators.hpp"

#include <unistd.h>

namespace grelha::perf {

void RayBuffer::add(const float (&org)[3], const float (&dir)[3], float t_end) {
  ox.push_back(org[0]);
  oy.push_back(org[1]);
  oz.push_back(org[2]);
  dx.push_back(dir[0]);
  dy.push_back(dir[1]);
  dz.push_back(dir[2]);
  t_min.push_back(0);
  t_max.push_back(t_end);
}

SceneFile make_scene(const std::string& name, int size) {
  const scenes::Generator* const g = scenes::find_generator(name);
  if (!g)
    throw std::invalid_argument("no generator " + name);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("grelha-perf-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / (name + ".nff");
  scenes::SceneOptions options;
  options.size = size;
  if (g->write_mesh) {
    options.mesh_file = name + ".ply";
    std::ofstream mesh(folder / options.mesh_file);
    g->write_mesh(mesh, size);
  }
  {
    std::ofstream out(file);
    g->write(out, options);
  }
  SceneFile scene = read_scene(file.string(), [](const std::string&) {});
  std::filesystem::remove_all(folder);
  return scene;
}

SceneFile scene_named(const std::string& name) {
  const auto space = name.find(' ');
  if (space != std::string::npos)
    return make_scene(name.substr(0, space), std::atoi(name.c_str() + space));
  return read_scene(name, [](const std::string&) {});
}

RayBuffer camera_rays(const Camera& camera) {
  const FrameView f = make_frame(camera);
  RayBuffer rays;
  for (int y0 = 0; y0 < f.height; y0 += kTile)
    for (int x0 = 0; x0 < f.width; x0 += kTile)
      for (int k = 0; k < kTile * kTile; ++k) {
        const int x = x0 + tile_x(k), y = y0 + tile_y(k);
        if (x >= f.width || y >= f.height)
          continue;
        const float sx = (static_cast<float>(x) + .5f) - .5f * static_cast<float>(f.width);
        const float sy = .5f * static_cast<float>(f.height) - (static_cast<float>(y) + .5f);
        float d[3], dd = 0;
        for (int a = 0; a < 3; ++a) {
          d[a] = (f.forward[a] + sx * f.right[a]) + sy * f.up[a];
          dd += d[a] * d[a];
        }
        for (float& c : d)
          c /= __builtin_sqrtf(dd);
        rays.add(f.eye, d, __builtin_inff());
      }
  return rays;
}

Rays RayBuffer::view(std::size_t first, std::size_t count) const {
  return {.org = {ox.data() + first, oy.data() + first, oz.data() + first},
          .dir = {dx.data() + first, dy.data() + first, dz.data() + first},
          .t_min = t_min.data() + first,
          .t_max = t_max.data() + first,
          .count = count};
}

void Answers::resize(std::size_t count, bool any) {
  t.resize(any ? 0 : count);
  id.resize(any ? 0 : count);
  blocked.resize(any ? count : 0);
}

bool Answers::same(std::size_t i, const Answers& others, std::size_t k) const {
  if (t.empty())
    return blocked[i] == others.blocked[k];
  return std::memcmp(&t[i], &others.t[k], sizeof t[i]) == 0 && id[i] == others.id[k];
}

void call_each(const World& world, const RayBuffer& r, bool any, Answers& a) {
  a.resize(r.size(), any);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const Ray ray{{r.ox[i], r.oy[i], r.oz[i]}, {r.dx[i], r.dy[i], r.dz[i]}, r.t_min[i], r.t_max[i]};
    if (any) {
      a.blocked[i] = occluded(world, ray);
      continue;
    }
    const Hit hit = closest(world, ray);
    a.t[i] = hit.t;
    a.id[i] = hit.id;
  }
}

void ask_in_streams(const World& world,
                    const RayBuffer& rays,
                    bool any,
                    std::size_t each,
                    const QueryOptions& options,
                    Answers& a) {
  a.resize(rays.size(), any);
  for (std::size_t i = 0; i < rays.size(); i += each) {
    const Rays some = rays.view(i, std::min(each, rays.size() - i));
    if (any)
      occluded(world, some, a.blocked.data() + i, options);
    else
      closest(world, some, {a.t.data() + i, a.id.data() + i}, options);
  }
}

void trace(const World& world,
           const Variant& variant,
           const TraceOptions& settings,
           const Rays& rays,
           bool any,
           Answers& a,
           TraceCounts& counts) {
  const SceneView& scene = world.impl().view;
  a.resize(rays.count, any);
  if (any) {
    variant.loops.occluded(scene, rays, a.blocked.data(), settings, counts);
    return;
  }
  variant.loops.closest(scene, rays, {a.t.data(), a.id.data()}, settings, counts);
}

}  // namespace grelha::perf
