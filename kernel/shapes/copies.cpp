#include "kernel/shapes/copies.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace grelha {

Shape shape_of(const Primitives& p, std::uint32_t id) {
  Shape shape;
  const GeometrySpans& g = p.geometry;
  if (id >= p.cone_base) {
    for (std::size_t k = 0; k < p.cones.size(); ++k)
      shape.set(k, p.cones[k][id - p.cone_base]);
  } else if (id >= p.triangle_base) {
    const TriangleSpans& t = g.triangles;
    const std::uint32_t i = id - p.triangle_base, v[3] = {t.a[i], t.b[i], t.c[i]};
    for (std::size_t k = 0; k < 3; ++k)
      shape.set(3 * k, t.x[v[k]]), shape.set(3 * k + 1, t.y[v[k]]), shape.set(3 * k + 2, t.z[v[k]]);
  } else {
    const std::size_t i = id - p.sphere_base;
    shape.set(0, g.spheres.x[i]);
    shape.set(1, g.spheres.y[i]);
    shape.set(2, g.spheres.z[i]);
    shape.set(3, g.spheres.radius[i]);
  }
  return shape;
}

std::vector<std::uint32_t> copies_among(const Primitives& p, std::span<const std::uint32_t> ids) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed;
  hashed.reserve(ids.size());
  for (const std::uint32_t id : ids)
    hashed.emplace_back(shape_of(p, id).hash(), id);
  std::sort(hashed.begin(), hashed.end());
  std::vector<std::uint32_t> copies;
  for (std::size_t i = 0; i < hashed.size();) {
    const auto [hash, first] = hashed[i];
    for (++i; i < hashed.size() && hashed[i].first == hash; ++i) {
      const std::uint32_t id = hashed[i].second;
      if (kind_of(p, id) == kind_of(p, first) && shape_of(p, id) == shape_of(p, first))
        copies.push_back(id);
    }
  }
  return copies;
}

std::uint32_t planes_without_copies(const PlaneSpans& planes) {
  const auto less = [](const Shape& a, const Shape& b) {
    return std::lexicographical_compare(a.bits, a.bits + 6, b.bits, b.bits + 6);
  };
  std::set<Shape, decltype(less)> known(less);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < planes.size(); ++i) {
    Shape s;
    s.set(0, planes.x[i]);
    s.set(1, planes.y[i]);
    s.set(2, planes.z[i]);
    s.set(3, planes.nx[i]);
    s.set(4, planes.ny[i]);
    s.set(5, planes.nz[i]);
    if (known.insert(s).second)
      count = i + 1;
  }
  return count;
}

}  // namespace grelha
