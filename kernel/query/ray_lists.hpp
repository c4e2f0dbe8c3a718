#pragma once
// One ray of a query for all that it crosses.

#include "grelha/query.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/traverse/ray.hpp"

namespace grelha {

/// A ray whose direction has a length that exact tests can work with, as lists need it.
class ListedRay {
 public:
  explicit ListedRay(const World& world) : scene_(world.impl().view) {}
  void set(const Ray& ray, const Filter& filter) {
    ray_ = ray;
    filter_ = filter;
    is_scaled_ = false;
  }

 protected:
  /// Calls visit(id) for a primitive and its copies, as far as the ray does not leave them out.
  template <class Visit>
  void each_passing(std::uint32_t id, const Visit& visit) const {
    const auto pass = [&](std::uint32_t one) {
      if (one != filter_.skip &&
          (filter_.masks.empty() || (filter_.masks[one] & filter_.mask) != 0))
        visit(one);
    };
    pass(id);
    const CopyTable& copies = scene_.copies;
    for (std::uint32_t i = copies.begin(id); copies.has(i, id); ++i)
      pass(copies.pair[i].copy);
  }

  /// The ray as the tests of packets have it: t counts multiples of `unit`.
  const ExactRay& scaled() {
    if (!is_scaled_) {
      const scalar::Vec3<float> dir{ray_.dir.x, ray_.dir.y, ray_.dir.z};
      const float unit = scalar::length_unit(dir);
      const double by = unit;
      const float t_max = unit == 1 ? ray_.t_max : scalar::finite_end(unit, ray_.t_max);
      scaled_ = {{ray_.org.x, ray_.org.y, ray_.org.z},
                 {dir.x / unit, dir.y / unit, dir.z / unit},
                 by * ray_.t_min,
                 by * t_max};
      unit_ = unit;
      is_scaled_ = true;
    }
    return scaled_;
  }
  /// t of a crossing that lies from lo to hi of a scaled ray, rounded once. Where that does not
  /// tell, exactly(ray) does, the ray being in its own length.
  template <class Exactly>
  float rounded(const ExactRay& ray, double lo, double hi, const Exactly& exactly) const {
    const auto first = static_cast<float>(lo);
    const bool known = unit_ == 1 && first == static_cast<float>(hi);
    const float t = (known ? first : exactly(ray.in_units_of(1 / unit_))) + 0.f;  // no zero is -0
    return scalar::strictly_between(t, ray_.t_min, ray_.t_max);
  }

  /// Bounds t of a triangle that the ray surely crosses. Returns false where doubles do not tell.
  bool bound_plane(const Candidate& c, double& lo, double& hi) {
    const Triangle::Fields<float> triangle = scalar::triangle_of(*c.block, c.index);
    const scalar::PlaneSpan<double> span =
        scalar::plane_span<double>(scalar::vec(scaled().org),
                                   scalar::vec(scaled().dir),
                                   {scalar::vec_double(triangle.corner[0]),
                                    scalar::vec_double(triangle.corner[1]),
                                    scalar::vec_double(triangle.corner[2])});
    lo = span.lo;
    hi = span.hi;
    return span.known;
  }

  const SceneView& scene_;
  Filter filter_;

 private:
  Ray ray_{};
  ExactRay scaled_{};
  double unit_ = 1;
  bool is_scaled_ = false;
};

}  // namespace grelha
