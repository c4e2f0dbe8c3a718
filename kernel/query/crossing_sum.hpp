#pragma once
// How often rays from points cross a mesh outwards and inwards, as the copies of the kernel count.

#include "kernel/query/variants.hpp"
#include "kernel/traverse/one_ray.hpp"

namespace grelha::GRELHA_ISA {

/// The direction of rays that tell whether points are inside: no axis, plane of a lattice or
/// diagonal of a cube, so that few meet edges.
inline constexpr Float3 kInsideDirection{.4375f, .8125f, .3125f};

/// Times a sum of the sizes of products: error of a normal times a direction in double, 8 u.
inline constexpr double kFacingError = 16 * 0x1p-53;

/// crosses_front(), by doubles where they tell.
inline bool is_crossed_inwards(const ExactRay& ray, const float (&corner)[3][3]) {
  double sum = 0, size = 0;
  for (int a = 0; a < 3; ++a) {
    const int y = kNextAxis[a], z = kPreviousAxis[a];
    const auto edge = [&](int k, int axis) {
      return double{corner[k][axis]} - double{corner[0][axis]};
    };
    const double first = edge(1, y) * edge(2, z);
    const double second = edge(1, z) * edge(2, y);
    sum += (first - second) * ray.dir[a];
    size += (magnitude(first) + magnitude(second)) * magnitude(ray.dir[a]);
  }
  return magnitude(sum) > kFacingError * size ? sum < 0 : crosses_front(ray, corner);
}

/// For walk_scene(): adds up the crossings of a ray with triangles, edges and corners decided by
/// simulation of simplicity, and finds the spheres that it starts in.
class CrossingCounter {
 public:
  static constexpr bool kInAnyOrder = true;

  CrossingCounter(const SceneView& scene, const Single& ray)
      : scene_(scene), given_(ray.given.ray(0)) {}

  const CrossingSum& sum() const { return sum_; }

  bool block(Single& r, const TriangleBlock& block) {
    const Shear<Block> shear{
        Block(r.shear[0][0]), Block(r.shear[1][0]), Block(r.shear[2][0]), Block(r.frame_error)};
    for (int i = 0; i < kBlock; i += kWidth<Block>) {
      const BlockSource<SingleRay> with{SingleRay{r}, &block, i};
      const HitInterval<Block> found =
          bound_triangle<Block>(with(), shear, Block(*r.t_min), Block(*r.best));
      const unsigned sure = bits(found.sure);
      each_bit(bits(found.some), [&](int k) { take(block, i + k, (sure >> k & 1) != 0); });
    }
    return false;
  }
  bool arrays(Single&, const CellLists& lists, std::size_t cell) {
    const Sphere::CellList& spheres = lists.of<Sphere>();
    for (std::uint32_t i = spheres.first ? spheres.first[cell] : 0;
         spheres.first && i < spheres.first[cell + 1] && !sum_.in_sphere;
         ++i) {
      const auto sphere = one_of<Sphere>(spheres.fields, i);
      sum_.in_sphere = is_within(given_.org, sphere.center, sphere.radius);
    }
    return false;
  }

 private:
  static constexpr std::uint32_t kMost = 64;  ///< crossed triangles

  void take(const TriangleBlock& block, int i, bool sure) {
    const std::uint32_t id = block.id[i];
    for (std::uint32_t k = 0; k < count_; ++k)
      if (id_[k] == id)
        return;  // a triangle may stand in several cells
    const Triangle::Fields<float> triangle = triangle_of(block, i);
    if (!sure && !crosses(triangle.corner))
      return;
    sum_.is_whole = sum_.is_whole && count_ < kMost;
    if (!sum_.is_whole)
      return;
    id_[count_++] = id;
    const std::int32_t by = is_crossed_inwards(given_, triangle.corner) ? -1 : 1;
    sum_.outwards += by;
    const CopyTable& copies = scene_.copies;
    for (std::uint32_t c = copies.begin(id); copies.has(c, id); ++c)
      sum_.outwards += by;
  }
  bool crosses(const float (&corner)[3][3]) const {
    const HitInterval<double> bound = bound_triangle(given_, corner);
    if (!bound.some || bound.lo >= given_.t_max)
      return false;
    return (bound.sure && bound.hi < given_.t_max) || crosses_beside(given_, corner);
  }

  const SceneView& scene_;
  const ExactRay given_;
  CrossingSum sum_;
  std::uint32_t id_[kMost];
  std::uint32_t count_ = 0;
};

/// The crossings of rays from [count] points.
inline void sum_crossings(const SceneView& scene,
                          const Float3* points,
                          std::size_t count,
                          CrossingSum* sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] = {};
    Single r;
    if (!prepare(r, {points[i], kInsideDirection}, true))
      continue;
    r.geometry = &scene.geometry;
    CrossingCounter counter(scene, r);
    walk_scene(scene, r, counter);
    sums[i] = counter.sum();
  }
}

}  // namespace grelha::GRELHA_ISA
