#include "frontend/commands/cut_light.hpp"

#include <algorithm>
#include <cstdio>

#include "grelha/render.hpp"
#include "grelha/scene_spans.hpp"

namespace grelha {
namespace {

double most_of(const Float3& v) {
  return std::max({double(v.x), double(v.y), double(v.z)});
}

/// Returns an upper bound of one term of a sample: a light that a surface reflects, a glow or the
/// background, seen through as many mirrors as a path may have.
double max_radiance(const Scene& scene, const RenderOptions& options) {
  double light = 0;
  for (const Light& one : scene.lights) {
    const bool is_area = one.edge1 != Float3{} || one.edge2 != Float3{};
    light = std::max(light, most_of(one.color) / (is_area ? options.sampling.light_rays : 1));
  }
  double term = most_of(scene.background), throughput = 1;
  const std::vector<char> used = used_materials(scene);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!used[i])
      continue;
    const double returned = most_of(m.diffuse) + most_of(m.specular);
    term = std::max({term, light * returned, most_of(m.emission)});
    throughput = std::max({throughput, most_of(m.mirror), double(m.transmission)});
  }
  for (int bounce = 1; bounce < options.depth && throughput > 1 && term < 1e30; ++bounce)
    term *= throughput;
  return term;
}

/// See kernel/scene/light_unit.hpp.
double most_held(const RenderOptions& options) {
  constexpr double kMostTerm = 0x1p20, kMostOfAll = 0x1p25;
  const int samples = options.refine.on() ? kMostSamples : options.sampling.samples;
  return std::min(kMostTerm, kMostOfAll / samples);
}

}  // namespace

void warn_of_cut_light(const std::string& path,
                       const Scene& scene,
                       const RenderOptions& options,
                       const Warn& warn) {
  const double found = max_radiance(scene, options), held = most_held(options);
  if (!(found > held))
    return;
  char text[128];
  std::snprintf(text,
                sizeof text,
                "light may reach %.6g in a sample: what is beyond %.6g is cut",
                found,
                held);
  warn(path + ": warning: " + text);
}

}  // namespace grelha
