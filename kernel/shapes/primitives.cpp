#include "kernel/shapes/primitives.hpp"

#include <cmath>
#include <utility>

namespace grelha {

PreparedCones prepare_cones(const ConeSpans& c) {
  PreparedCones out;
  for (auto& v : out)
    v.resize(c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {
    struct End {
      double at[3], radius;
    };
    End narrow{{c.base_x[i], c.base_y[i], c.base_z[i]},
               std::abs(static_cast<double>(c.base_radius[i]))};
    End wide{{c.apex_x[i], c.apex_y[i], c.apex_z[i]},
             std::abs(static_cast<double>(c.apex_radius[i]))};
    if (wide.radius < narrow.radius)
      std::swap(narrow, wide);
    double height = 0;
    for (int a = 0; a < 3; ++a)
      height += (wide.at[a] - narrow.at[a]) * (wide.at[a] - narrow.at[a]);
    height = std::sqrt(height);
    for (std::size_t a = 0; a < 3; ++a) {
      out[a][i] = static_cast<float>(narrow.at[a]);
      out[3 + a][i] = static_cast<float>((wide.at[a] - narrow.at[a]) / height);
    }
    out[6][i] = static_cast<float>(height);
    out[7][i] = static_cast<float>(narrow.radius);
    out[8][i] = static_cast<float>((wide.radius - narrow.radius) / height);
    out[9][i] = c.base_radius[i] + c.apex_radius[i] < 0 ? -1.f : 1.f;
  }
  return out;
}

Primitives::Primitives(const GeometrySpans& g)
    : geometry(g),
      cones(prepare_cones(g.cones)),
      sphere_base(static_cast<std::uint32_t>(g.planes.size())),
      triangle_base(sphere_base + static_cast<std::uint32_t>(g.spheres.size())),
      cone_base(triangle_base + static_cast<std::uint32_t>(g.triangles.size())),
      end(cone_base + static_cast<std::uint32_t>(g.cones.size())) {}

Box Primitives::flat_box(std::uint32_t id) const {
  Box b;
  switch (kind_of(*this, id)) {
    case Kind::kSphere:
      break;
    case Kind::kTriangle:
      return box_of(corners_of(*this, id));
    // the discs at both ends: a disc of radius r across a unit axis d reaches r sqrt(1 - d_a^2)
    case Kind::kCone: {
      const ConeSpans& c = geometry.cones;
      const std::uint32_t i = id - cone_base;
      const double ends[2][4] = {{c.base_x[i], c.base_y[i], c.base_z[i], c.base_radius[i]},
                                 {c.apex_x[i], c.apex_y[i], c.apex_z[i], c.apex_radius[i]}};
      const double h = cones[6][i];
      for (const auto& e : ends) {
        double reach[3];
        for (int a = 0; a < 3; ++a) {
          const double d = cones[static_cast<std::size_t>(3 + a)][i];
          reach[a] = std::abs(e[3]) * std::sqrt(std::max(0., 1 - d * d) + 1e-6);
        }
        b.add(e[0] - reach[0], e[1] - reach[1], e[2] - reach[2]);
        b.add(e[0] + reach[0], e[1] + reach[1], e[2] + reach[2]);
      }
      b.grow(h * 1e-6);
      break;
    }
  }
  return b;
}

}  // namespace grelha
