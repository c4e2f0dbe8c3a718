#include "perf/distance/others.hpp"

#ifdef GRELHA_CGAL
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace grelha::perf {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Corners = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Corners::const_iterator>;
using Boxes = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

class Tree : public OtherTree {
 public:
  explicit Tree(const Triangles& t) {
    const auto corner = [&](std::uint32_t v) { return Kernel::Point_3(t.x[v], t.y[v], t.z[v]); };
    for (std::size_t i = 0; i < t.size(); ++i) {
      const Kernel::Triangle_3 one(corner(t.a[i]), corner(t.b[i]), corner(t.c[i]));
      if (one.is_degenerate())
        continue;
      corners_.push_back(one);
      ids_.push_back(static_cast<std::uint32_t>(i));
    }
    boxes_.insert(corners_.begin(), corners_.end());
    boxes_.build();
    boxes_.accelerate_distance_queries();
  }

  void closest(std::span<const Float3> points, std::span<ClosestPoint> found) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Kernel::Point_3 p(points[i].x, points[i].y, points[i].z);
      const auto [at, one] = boxes_.closest_point_and_primitive(p);
      found[i] = {
          {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())},
          static_cast<float>(std::sqrt(CGAL::squared_distance(at, p))),
          ids_[static_cast<std::size_t>(one - corners_.begin())]};
    }
  }

 private:
  Corners corners_;
  std::vector<std::uint32_t> ids_;
  Boxes boxes_;
};

}  // namespace

std::unique_ptr<OtherTree> make_cgal_tree(const Triangles& t) {
  return std::make_unique<Tree>(t);
}

}  // namespace grelha::perf
#else
namespace grelha::perf {
std::unique_ptr<OtherTree> make_cgal_tree(const Triangles&) {
  return nullptr;
}
}  // namespace grelha::perf
#endif
