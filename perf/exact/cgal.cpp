#include "perf/exact/cgal.hpp"

#ifdef GRELHA_CGAL
#include <cmath>
#include <optional>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <boost/variant/get.hpp>

namespace grelha::perf {
namespace {

template <class Kernel>
class Tree : public CgalTree {
  using Point = typename Kernel::Point_3;
  using Triangle = typename Kernel::Triangle_3;
  using Triangles = std::vector<Triangle>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, typename Triangles::const_iterator>;
  using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

 public:
  explicit Tree(const grelha::Triangles& t) {
    const auto corner = [&](std::uint32_t v) { return Point(t.x[v], t.y[v], t.z[v]); };
    for (std::size_t i = 0; i < t.size(); ++i) {
      const Triangle triangle(corner(t.a[i]), corner(t.b[i]), corner(t.c[i]));
      if (triangle.is_degenerate())
        continue;
      triangles_.push_back(triangle);
      ids_.push_back(static_cast<std::uint32_t>(i));
    }
    boxes_ = std::make_unique<Boxes>(triangles_.begin(), triangles_.end());
    boxes_->build();
  }

  void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i)
      hits[i] = closest(rays[i]);
  }

 private:
  Hit closest(const Ray& r) const {
    const Point org(r.org.x, r.org.y, r.org.z);
    const typename Kernel::Vector_3 dir(r.dir.x, r.dir.y, r.dir.z);
    const auto found = boxes_->first_intersection(typename Kernel::Ray_3(org, dir));
    if (!found)
      return {r.t_max};
    const auto id = ids_[static_cast<std::size_t>(found->second - triangles_.begin())];
    const Point* point = boost::get<Point>(&found->first);
    if (!point)  // a segment: the ray lies in the triangle's plane
      return {r.t_max};
    const double d[3] = {r.dir.x, r.dir.y, r.dir.z};
    int a = 0;
    for (int k = 1; k < 3; ++k)
      if (std::abs(d[k]) > std::abs(d[a]))
        a = k;
    return {static_cast<float>(CGAL::to_double((*point)[a] - org[a]) / d[a]), id};
  }

  Triangles triangles_;
  std::vector<std::uint32_t> ids_;
  std::unique_ptr<Boxes> boxes_;
};

}  // namespace

std::unique_ptr<CgalTree> make_cgal_tree(const Scene& scene, bool exact) {
  const grelha::Triangles& t = scene.geometry.triangles;
  if (exact)
    return std::make_unique<Tree<CGAL::Exact_predicates_exact_constructions_kernel>>(t);
  return std::make_unique<Tree<CGAL::Exact_predicates_inexact_constructions_kernel>>(t);
}

}  // namespace grelha::perf
#else
namespace grelha::perf {

std::unique_ptr<CgalTree> make_cgal_tree(const Scene&, bool) {
  return nullptr;
}

}  // namespace grelha::perf
#endif
