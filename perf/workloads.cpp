#include "perf/workloads.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "kernel/scene/frame.hpp"
#include "kernel/grid/world_impl.hpp"
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

void trace(const World& world,
           const Variant& variant,
           const TraceSettings& settings,
           const RayBuffer& r,
           std::size_t first,
           std::size_t count,
           Answers& a,
           TraceCounts& counts) {
  a.t.assign(r.t_max.begin() + std::ptrdiff_t(first),
             r.t_max.begin() + std::ptrdiff_t(first + count));
  a.id.resize(count);
  variant.loops.closest(world.impl().view,
                        {&r.ox[first],
                         &r.oy[first],
                         &r.oz[first],
                         &r.dx[first],
                         &r.dy[first],
                         &r.dz[first],
                         &r.t_min[first],
                         a.t.data(),
                         a.id.data(),
                         static_cast<int>(count)},
                        settings,
                        counts);
}

}  // namespace grelha::perf
