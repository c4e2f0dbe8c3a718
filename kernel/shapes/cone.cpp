#include "kernel/shapes/cone.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grelha {
namespace {

/// Least height = kFlattest * wider radius. A flatter cone is taken to be so high, which moves it
/// by 4 u of that radius.
constexpr double kFlattest = 0x1p-22;

struct ConeEnd {
  double at[3], radius;
};

Cone::Fields<float> setup_cone(const ConeSpans& c, std::size_t i) {
  ConeEnd narrow{{c.base_x[i], c.base_y[i], c.base_z[i]},
                 std::abs(static_cast<double>(c.base_radius[i]))};
  ConeEnd wide{{c.apex_x[i], c.apex_y[i], c.apex_z[i]},
               std::abs(static_cast<double>(c.apex_radius[i]))};
  if (wide.radius < narrow.radius)
    std::swap(narrow, wide);
  double height = 0;
  for (int a = 0; a < 3; ++a)
    height += (wide.at[a] - narrow.at[a]) * (wide.at[a] - narrow.at[a]);
  height = std::sqrt(height);
  Cone::Fields<float> out;
  for (int a = 0; a < 3; ++a) {
    out.base[a] = static_cast<float>(narrow.at[a]);
    out.axis[a] = static_cast<float>((wide.at[a] - narrow.at[a]) / height);
  }
  height = std::max(height, kFlattest * wide.radius);
  out.height = static_cast<float>(height);
  out.radius = static_cast<float>(narrow.radius);
  out.slope = static_cast<float>((wide.radius - narrow.radius) / height);
  out.side = c.base_radius[i] + c.apex_radius[i] < 0 ? -1.f : 1.f;
  return out;
}

}  // namespace

Cone::Source::Source(const GeometrySpans& g) : spans(g.cones) {
  for_each_field([n = spans.size()](std::vector<float>& v) { v.resize(n); }, prepared);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const Fields<float> cone = setup_cone(spans, i);
    for_each_field(
        [i](std::vector<float>& to, const float& from) { to[i] = from; }, prepared, cone);
  }
}

Cone::Fields<const float*> Cone::Source::fields() const {
  Fields<const float*> out;
  for_each_field(
      [](const float*& to, const std::vector<float>& from) { to = from.data(); }, out, prepared);
  return out;
}

// A disc of radius r across a unit axis d reaches r sqrt(1 - d_a^2). Doubles are off by 2^-26 of r
// where that is nearly zero, a thousandth of the pad that is added to boxes.
Box Cone::box(const Source& source, std::size_t i) {
  const ConeSpans& c = source.spans;
  const double ends[2][4] = {{c.base_x[i], c.base_y[i], c.base_z[i], c.base_radius[i]},
                             {c.apex_x[i], c.apex_y[i], c.apex_z[i], c.apex_radius[i]}};
  double axis[3];
  double height = 0;
  for (int a = 0; a < 3; ++a) {
    axis[a] = ends[1][a] - ends[0][a];
    height += axis[a] * axis[a];
  }
  Box b;
  for (const auto& e : ends) {
    double half_width[3];
    for (int a = 0; a < 3; ++a) {
      const double across = std::max(0., 1 - axis[a] * axis[a] / height);
      half_width[a] = std::abs(e[3]) * std::sqrt(across);
    }
    b.add(e[0] - half_width[0], e[1] - half_width[1], e[2] - half_width[2]);
    b.add(e[0] + half_width[0], e[1] + half_width[1], e[2] + half_width[2]);
  }
  return b;
}

}  // namespace grelha
