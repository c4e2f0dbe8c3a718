// The surfaces that rays hit.
#include <limits>
#include <vector>

#include "grelha/query.hpp"
#include "src/hear.hpp"
#include "src/queries.hpp"

namespace grelha::python {
namespace {

std::vector<Ray> rays_of(const Rays& from, std::size_t count) {
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto at = [i](const float* const(&axes)[3], std::ptrdiff_t stride) {
      const std::ptrdiff_t k = std::ptrdiff_t(i) * stride;
      return Float3{axes[0][k], axes[1][k], axes[2][k]};
    };
    rays[i].org = at(from.org, from.org_stride);
    rays[i].dir = at(from.dir, from.dir_stride);
  }
  return rays;
}

/// What rays hit.
struct Found {
  explicit Found(std::size_t count)
      : points(count, kNone),
        normals(count, kNone),
        colors(count, kNone),
        ids(count, kNoPrimitive) {}
  static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  static constexpr Float3 kNone{kNan, kNan, kNan};
  std::vector<Float3> points, normals, colors;
  std::vector<std::uint32_t> ids;
};

/// The colour at a hit: the material's diffuse, times the mix of the vertices' colours.
Float3 color_at(
    const Model& model, const Primitive& hit, std::uint32_t material, double u, double v) {
  const Triangles& t = model.geometry().triangles;
  const std::vector<Material>& materials = model.scene().materials;
  const Float3 diffuse = materials.empty() ? Float3{.8f, .8f, .8f} : materials[material].diffuse;
  if (t.red.empty() || hit.kind != PrimitiveKind::kTriangle)
    return diffuse;
  const auto mixed = [&](const std::vector<float>& channel) {
    return float((1 - u - v) * double{channel[t.a[hit.index]]} +
                 u * double{channel[t.b[hit.index]]} + v * double{channel[t.c[hit.index]]});
  };
  return {diffuse.x * mixed(t.red), diffuse.y * mixed(t.green), diffuse.z * mixed(t.blue)};
}

void find(const Model& model, RayBatch& batch, const QueryOptions& options, Found& found) {
  const Rays given = batch.rays();
  const std::vector<Ray> rays = rays_of(given, batch.count());
  std::vector<float> t(rays.size()), u(rays.size()), v(rays.size());
  closest(model.world(),
          given,
          {.t = t.data(), .id = found.ids.data(), .u = u.data(), .v = v.data()},
          options);
  std::vector<Hit> hits(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    hits[i] = {t[i], found.ids[i]};
  std::vector<SurfacePoint> surface(rays.size());
  surfaces(model.world(), rays, hits, surface, options);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (found.ids[i] == kNoPrimitive)
      continue;
    found.points[i] = surface[i].point;
    found.normals[i] = surface[i].shading;
    found.colors[i] = color_at(model,
                               primitive_of(model.world(), found.ids[i]),
                               surface[i].material,
                               double{u[i]},
                               double{v[i]});
  }
}

}  // namespace

py::object ray_surfaces(const Model& model, const RayArguments& given, py::handle wanted) {
  const int threads = threads_in(wanted);
  RayBatch batch(model, given);
  Found found(batch.count());
  hear_signals(batch.count(), [&](const Progress& progress) {
    QueryOptions options;
    options.threads = threads;
    options.mask = batch.masks();
    options.progress = progress;
    find(model, batch, options, found);
  });
  py::array_t<std::int64_t> ids(batch.shape());
  for (std::size_t i = 0; i < found.ids.size(); ++i)
    ids.mutable_data()[i] = found.ids[i] == kNoPrimitive ? -1 : std::int64_t{found.ids[i]};
  return result_class("Surfaces")(outside_points(model, found.points, batch.shape()),
                                  floats_of(found.normals, batch.shape()),
                                  floats_of(found.colors, batch.shape()),
                                  ids);
}

}  // namespace grelha::python
