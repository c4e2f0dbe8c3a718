#include "kernel/scene/materials.hpp"

#include <algorithm>

namespace grelha {

MaterialTable::MaterialTable(const SceneSpans& scene) {
  const std::span<const Material> materials = scene.materials;
  const std::vector<char> used = used_materials(scene);
  for (auto& f : fields)
    f.resize(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& m = materials[i];
    const bool clear = m.transmission > 0;
    const float values[kMaterialFields] = {m.diffuse.x,
                                           m.diffuse.y,
                                           m.diffuse.z,
                                           m.specular.x,
                                           m.specular.y,
                                           m.specular.z,
                                           m.mirror.x,
                                           m.mirror.y,
                                           m.mirror.z,
                                           m.emission.x,
                                           m.emission.y,
                                           m.emission.z,
                                           m.transmission,
                                           m.shine,
                                           clear ? m.ior : 1.f,
                                           clear && m.fresnel ? 1.f : 0.f,
                                           m.roughness};
    for (std::size_t k = 0; k < kMaterialFields; ++k)
      fields[k][i] = values[k];
    if (!used[i])
      continue;
    reflects |= clear || m.mirror != Float3{};
    refracts |= clear;
    fresnel |= clear && m.fresnel;
    emits |= m.emission != Float3{};
    highlights |= m.specular != Float3{};
    constexpr float kRounding = 1.0001f;  // .9 + .1 as floats is no gain
    gains |= !(clear && m.fresnel) &&
             largest_channel(m.mirror) + (clear ? m.transmission : 0) > kRounding;
    lit = std::max(lit, largest_channel(m.diffuse) + largest_channel(m.specular));
    emitted = std::max(emitted, largest_channel(m.emission));
    gloss |= m.roughness > 0 && (clear || m.mirror != Float3{});
  }
}

MaterialView MaterialTable::view() const {
  MaterialView v;
  for (std::size_t k = 0; k < kMaterialFields; ++k)
    v.field[k] = fields[k].data();
  return v;
}

}  // namespace grelha
