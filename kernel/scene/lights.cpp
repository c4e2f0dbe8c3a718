#include "kernel/scene/lights.hpp"

#include <algorithm>

namespace grelha {

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
