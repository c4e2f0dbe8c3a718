#include "perf/ab/copies.hpp"

#include <algorithm>
#include <stdexcept>

#include <dlfcn.h>

namespace grelha::perf {
namespace {

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function)
    throw std::runtime_error(dlerror());
}

template <std::size_t kFields, class T>
void refer(const std::vector<T>* const (&from)[kFields], const T* (&to)[kFields]) {
  std::transform(from, from + kFields, to, [](const auto* array) { return array->data(); });
}

}  // namespace

KernelCopy::KernelCopy(const std::string& path) {
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw std::runtime_error(dlerror());
  find(library, "ab_world", world_);
  find(library, "ab_free", free_);
  find(library, "ab_run", run_);
}

CopyWorld::CopyWorld(const KernelCopy& copy, const Geometry& g) : copy_(copy) {
  PlainScene s;
  const auto& [spheres, triangles, cones, planes, objects] = g;
  s.spheres = spheres.size();
  refer({&spheres.x, &spheres.y, &spheres.z, &spheres.radius}, s.sphere);
  s.vertices = triangles.vertex_count();
  refer({&triangles.x, &triangles.y, &triangles.z}, s.vertex);
  s.triangles = triangles.size();
  refer({&triangles.a, &triangles.b, &triangles.c}, s.corner);
  s.cones = cones.size();
  refer({&cones.base_x,
         &cones.base_y,
         &cones.base_z,
         &cones.base_radius,
         &cones.apex_x,
         &cones.apex_y,
         &cones.apex_z,
         &cones.apex_radius},
        s.cone);
  s.planes = planes.size();
  refer({&planes.x, &planes.y, &planes.z, &planes.nx, &planes.ny, &planes.nz}, s.plane);
  std::vector<std::uint32_t> first, count;  // the copy keeps what they say
  for (const Object& o : objects) {
    first.push_back(o.first_triangle);
    count.push_back(o.triangle_count);
  }
  s.objects = objects.size();
  refer({&first, &count}, s.object);
  world_ = copy.world_(&s);
}

void CopyWorld::run(Way way, const RayBuffer& r, Answers& a) const {
  const PlainRays rays{.org = {r.ox.data(), r.oy.data(), r.oz.data()},
                       .dir = {r.dx.data(), r.dy.data(), r.dz.data()},
                       .t_min = r.t_min.data(),
                       .t_max = r.t_max.data(),
                       .count = r.size()};
  const PlainAnswers answers{.t = a.t.data(),
                             .id = a.id.data(),
                             .blocked = a.blocked.empty() ? nullptr : a.blocked.data()};
  copy_.run_(world_, way, &rays, &answers);
}

}  // namespace grelha::perf
