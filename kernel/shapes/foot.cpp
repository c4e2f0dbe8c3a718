#include "kernel/shapes/foot.hpp"

#include "kernel/shapes/nearest.hpp"

namespace grelha {

Foot foot_on(const GeometryView& geometry, std::uint32_t id, const double (&point)[3]) {
  const scalar::Point p = scalar::vec(point);
  scalar::Point at{};
  visit_primitive(geometry, id, [&]<class Shape>(const auto& one) { at = nearest_on(p, one); });
  return {{at.x, at.y, at.z}, length(at - p)};
}

}  // namespace grelha
