#include "frontend/commands/nothing_seen.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "grelha/render.hpp"
#include "grelha/scene_spans.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {
namespace {

bool is_empty(const Geometry& g) {
  return g.planes.size() + g.spheres.size() + g.cones.size() + g.triangles.size() == 0;
}

bool is_lit(const Scene& scene) {
  const auto shines = [](const Light& light) { return light.color != Float3{}; };
  if (std::ranges::any_of(scene.lights, shines))
    return true;
  const std::vector<char> used = used_materials(scene);
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && scene.materials[i].emission != Float3{})
      return true;
  return false;
}

/// Sums of light round the background to a multiple of 2^-32.
bool is_background_only(const Image& image, const Float3& background) {
  constexpr float kRounding = 1e-6f;
  const float color[] = {background.x, background.y, background.z};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const float expected = color[i % 3];
    if (!(std::abs(image.rgb[i] - expected) <= kRounding * std::max(1.f, std::abs(expected))))
      return false;
  }
  return true;
}

}  // namespace

void warn_empty_scene(const std::string& path, const SceneFile& file, const Warn& warn) {
  const Scene& scene = file.scene;
  if (is_empty(scene.geometry))
    warn(path + ": warning: nothing to draw: " +
         (file.default_camera ? "the mesh has no triangle"
                              : "add an object, such as \"s 0 0 0 1\""));
  if (!is_empty(scene.geometry) && !is_lit(scene))
    warn(path + ": warning: no light: surfaces will show no color of their own");
}

void warn_empty_image(const std::string& path,
                      const Geometry& geometry,
                      const Float3& background,
                      const Image& image,
                      const Warn& warn) {
  if (!is_empty(geometry) && is_background_only(image, background))
    warn(path +
         ": warning: the picture shows the background alone: turn the view, or widen \"angle\"");
}

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

double most_held(const RenderOptions& options) {
  const int samples = options.refine.on() ? kMostSamples : options.sampling.samples;
  return std::min<double>(kMostTerm, double{kMostLight} / samples);
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
