#include "frontend/input/effects.hpp"

#include <algorithm>
#include <vector>

#include "frontend/scene/double3.hpp"
#include "grelha/scene_spans.hpp"

namespace grelha {
namespace {

constexpr int kSamplesOfEffects = 16;
constexpr int kSamplesOfMeshes = 16;  ///< alone, whose edges are all there is to see

void apply_lens(const Effects& effects, const LensHint& hint, Camera& camera) {
  const double to_at = length(difference(camera.eye, camera.at));
  double aperture = hint.present ? hint.aperture : 0,
         focus = hint.present ? hint.focal * to_at : to_at;
  if (effects.lens) {
    aperture = effects.lens->aperture;
    if (effects.lens->focus > 0)
      focus = effects.lens->focus;
  }
  // The course's measure: pixels of the view plane, which lies at the point looked at and has the
  // scene's own resolution.
  const double pixel =
      camera.orthographic_height > 0 ? pixel_size(camera) : to_at * pixel_size(camera);
  camera.aperture = aperture > 0 && focus > 0 ? aperture * pixel : 0;
  camera.focus = focus > 0 ? focus : 1;
}

/// A point light becomes a square facing the point looked at.
void make_square(Light& light, const Float3& at, float size) {
  const Float3 d = at - light.position;
  const double n = length(difference(light.position, at));
  const double z[3] = {n > 0 ? d.x / n : 0, n > 0 ? d.y / n : 0, n > 0 ? d.z / n : 1};
  // Any two directions across do; these are the ones nearest to the axes (Duff et al. 2017).
  const double sign = z[2] < 0 ? -1 : 1, a = -1 / (sign + z[2]), b = z[0] * z[1] * a;
  light.edge1 = {float(size * (1 + sign * z[0] * z[0] * a)),
                 float(size * sign * b),
                 float(size * -sign * z[0])};
  light.edge2 = {float(size * b), float(size * (sign + z[1] * z[1] * a)), float(size * -z[1])};
}

void apply_shadows(const Effects::Shadows& shadows, SceneFile& file) {
  for (Light& light : file.scene.lights) {
    if (shadows.hard)
      light.edge1 = light.edge2 = {};
    else if (!light.is_area() && shadows.size > 0)
      make_square(light, file.camera.at, shadows.size);
  }
}

void apply_gloss(float roughness, std::vector<Material>& materials) {
  for (Material& m : materials)
    if (m.mirror != Float3{})
      m.roughness = roughness;
}

bool has_rough_mirror(const Scene& scene) {
  const auto rough = [](const Material& m) {
    return m.roughness > 0 && (m.mirror != Float3{} || m.transmission > 0);
  };
  // millions of primitives need not be asked
  if (std::ranges::none_of(scene.materials, rough))
    return false;
  const std::vector<char> used = used_materials(scene);
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] && rough(scene.materials[i]))
      return true;
  return false;
}

bool has_something_to_sample(const SceneFile& file, const Effects& effects) {
  if (file.camera.aperture > 0 || std::ranges::any_of(file.scene.lights, &Light::is_area))
    return true;
  return !(effects.glossy && effects.glossy->rays > 0) && has_rough_mirror(file.scene);
}

int ceiling_share(long long all, int parts) {
  return static_cast<int>((all + parts - 1) / parts);
}

/// Returns the samples of a pixel; `otherwise` if neither effects nor the scene set them.
int samples_of(const Effects& e, const SceneFile& file, int lens_samples, int otherwise) {
  if (e.samples)
    return *e.samples;
  if (e.jitter > 0)
    return e.jitter * e.jitter * lens_samples;
  if (lens_samples > 1 || e.adaptive.on)
    return lens_samples;
  if (has_something_to_sample(file, e))
    return file.samples_per_pixel > 0 ? file.samples_per_pixel : kSamplesOfEffects;
  return file.default_camera ? kSamplesOfMeshes : otherwise;
}

}  // namespace

void apply_effects(const Effects& e, SceneFile& file, RenderOptions& options) {
  apply_lens(e, file.lens, file.camera);
  if (e.shadows)
    apply_shadows(*e.shadows, file);
  if (e.glossy)
    apply_gloss(e.glossy->roughness, file.scene.materials);

  SampleOptions& s = options.sampling;
  const int lens_samples = e.lens && e.lens->aperture > 0 ? std::max(e.lens->samples, 1) : 1;
  Effects counted = e;
  if (options.refine.on()) {
    options.refine.most = e.samples.value_or(0);
    counted.samples.reset();
  }
  s.samples = std::clamp(samples_of(counted, file, lens_samples, s.samples), 1, kMostSamples);
  s.sampler = e.sampler.value_or(e.jitter > 0 ? Sampler::kJitter : Sampler::kSobol);
  s.seed = e.seed;
  options.subdivision = e.adaptive;
  if (e.shadows && e.shadows->positions > 1 && !options.refine.on())
    s.light_rays = ceiling_share(1LL * e.shadows->positions * e.shadows->positions, s.samples);
  if (e.glossy)
    s.glossy_rays = e.glossy->rays;
}

}  // namespace grelha
