#include "perf/distance/others.hpp"

#ifdef GRELHA_CGAL
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

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

namespace {

class Side : public OtherInside {
  using Exact = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Exact::Point_3>;

 public:
  /// Corners at one place become one vertex.
  explicit Side(const Triangles& t) {
    std::map<std::tuple<float, float, float>, Mesh::Vertex_index> places;
    const auto place = [&](std::uint32_t v) {
      const auto [at, is_new] = places.try_emplace({t.x[v], t.y[v], t.z[v]});
      if (is_new)
        at->second = mesh_.add_vertex({t.x[v], t.y[v], t.z[v]});
      return at->second;
    };
    for (std::size_t i = 0; i < t.size(); ++i) {
      const auto a = place(t.a[i]), b = place(t.b[i]), c = place(t.c[i]);
      if (a != b && b != c && c != a)
        is_taken_ &= mesh_.add_face(a, b, c) != Mesh::null_face();
    }
    if (is_taken_)
      side_ = std::make_unique<CGAL::Side_of_triangle_mesh<Mesh, Exact>>(mesh_);
  }
  /// CGAL's meshes are manifolds.
  bool is_taken() const { return is_taken_; }
  void contains(std::span<const Float3> points, std::span<std::uint8_t> inside) const override {
    for (std::size_t i = 0; i < points.size(); ++i)
      inside[i] = (*side_)({points[i].x, points[i].y, points[i].z}) == CGAL::ON_BOUNDED_SIDE;
  }

 private:
  Mesh mesh_;
  bool is_taken_ = true;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<Mesh, Exact>> side_;
};

}  // namespace

std::unique_ptr<OtherInside> make_cgal_inside(const Triangles& t) {
  auto side = std::make_unique<Side>(t);
  return side->is_taken() ? std::move(side) : nullptr;
}

}  // namespace grelha::perf
#else
namespace grelha::perf {
std::unique_ptr<OtherTree> make_cgal_tree(const Triangles&) {
  return nullptr;
}
std::unique_ptr<OtherInside> make_cgal_inside(const Triangles&) {
  return nullptr;
}
}  // namespace grelha::perf
#endif
