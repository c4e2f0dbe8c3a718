#include "kernel/scene/tables.hpp"

#include <algorithm>

namespace grelha {
namespace {

/// Least ratio of light sent on to light received that is a gain: .9 + .1 as floats is none.
constexpr float kGain = 1.0001f;

bool is_clear(const Material& m) {
  return m.transmission > 0;
}
bool obeys_fresnel(const Material& m) {
  return is_clear(m) && m.fresnel;
}

}  // namespace

MaterialTable::MaterialTable(const SceneSpans& scene) {
  const std::span<const Material> materials = scene.materials;
  const std::vector<char> used = used_materials(scene);
  for (auto& f : fields)
    f.resize(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    set_fields(i, materials[i]);
    if (used[i])
      record_effects(materials[i]);
  }
}

void MaterialTable::set_fields(std::size_t i, const Material& m) {
  const auto set = [&](MaterialField k, float value) {
    fields[static_cast<std::size_t>(k)][i] = value;
  };
  const auto set_color = [&](MaterialField red, const Float3& color) {
    set(red, color.x);
    set(static_cast<MaterialField>(red + 1), color.y);
    set(static_cast<MaterialField>(red + 2), color.z);
  };
  set_color(kDiffuseR, m.diffuse);
  set_color(kSpecularR, m.specular);
  set_color(kMirrorR, m.mirror);
  set_color(kEmissionR, m.emission);
  set(kTransmission, m.transmission);
  set(kShine, m.shine);
  set(kIor, is_clear(m) ? m.ior : 1.f);
  set(kFresnel, obeys_fresnel(m) ? 1.f : 0.f);
  set(kRoughness, m.roughness);
}

void MaterialTable::record_effects(const Material& m) {
  const bool clear = is_clear(m);
  const bool mirrors = clear || m.mirror != Float3{};
  reflects |= mirrors;
  refracts |= clear;
  fresnel |= obeys_fresnel(m);
  emits |= m.emission != Float3{};
  highlights |= m.specular != Float3{};
  const float sent_on = largest_channel(m.mirror) + (clear ? m.transmission : 0);
  gains |= !obeys_fresnel(m) && sent_on > kGain;
  lit = std::max(lit, largest_channel(m.diffuse) + largest_channel(m.specular));
  emitted = std::max(emitted, largest_channel(m.emission));
  glossy |= m.roughness > 0 && mirrors;
}

MaterialView MaterialTable::view() const {
  MaterialView v;
  for (std::size_t k = 0; k < kMaterialFields; ++k)
    v.field[k] = fields[k].data();
  return v;
}

LightTable::LightTable(std::span<const Light> lights, const Float3& background)
    : background_(background) {
  for (const Light& l : lights) {
    for (const Float3& part : {l.position, l.color, l.edge1, l.edge2})
      fields_.insert(fields_.end(), {part.x, part.y, part.z});
    area_ |= l.is_area();
    sum_ += largest_channel(l.color);
  }
}

void LightTable::show(const MaterialTable& materials, ShadingView& view) const {
  view.lights = fields_.data();
  view.light_count = static_cast<int>(fields_.size()) / kLightFloats;
  view.area = area_;
  std::ranges::copy(std::array{background_.x, background_.y, background_.z}, view.background);
  view.brightest = std::max(largest_channel(background_), materials.emitted + materials.lit * sum_);
}

}  // namespace grelha
