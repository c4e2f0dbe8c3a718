#include "kernel/query/along_ray.hpp"

namespace grelha {

PreparedRay::PreparedRay(const SceneView& scene, const Ray& ray) {
  scalar::Vec3<float> dir{ray.dir.x, ray.dir.y, ray.dir.z};
  float t_min = ray.t_min;
  float t_max = ray.t_max;
  unit = scalar::length_unit(dir);
  if (unit != 1) {
    dir = {dir.x / unit, dir.y / unit, dir.z / unit};
    scalar::count_in(unit, t_min, t_max);
  }
  valid = prepare(single, {ray.org.x, ray.org.y, ray.org.z}, dir, t_min, t_max, true);
  single.geometry = &scene.geometry;
}

}  // namespace grelha
