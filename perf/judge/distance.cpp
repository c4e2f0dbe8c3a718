#include <algorithm>
#include <cmath>
#include <cstdio>

#include "grelha/all_hits.hpp"
#include "grelha/distance.hpp"
#include "perf/judge/judge.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/triangle_tree.hpp"

namespace grelha::perf {
namespace {

using test::brute::Corners;
using test::oracle::Real;

class NearestTriangle {
 public:
  explicit NearestTriangle(const Triangles& all) : all_(all), tree_(all) {}
  Real distance(const Float3& point) const {
    const auto p = test::brute::v(point);
    Real least = HUGE_VALL;
    const auto to_box = [&](const test::TriangleTree::Bounds& box) {
      const Real at[3] = {point.x, point.y, point.z};
      Real squares = 0;
      for (int a = 0; a < 3; ++a) {
        const Real beyond = std::max({box.lo[a] - at[a], at[a] - box.hi[a], Real{0}});
        squares += beyond * beyond;
      }
      return squares;
    };
    tree_.visit([&](const auto& box) { return to_box(box) > least * least * (1 + 1e-12L); },
                to_box,
                [&](std::uint32_t i) {
                  least = std::min(least, test::brute::to_triangle(p, Corners(all_, i)));
                });
    return least;
  }

 private:
  const Triangles& all_;
  test::TriangleTree tree_;
};

/// The diagonal and the middle of a mesh's box.
struct Extent {
  double diagonal = 0;
  Float3 middle{};
};
Extent extent_of(const Triangles& t) {
  const std::vector<float>* const all[] = {&t.x, &t.y, &t.z};
  float middle[3];
  double squares = 0;
  for (int a = 0; a < 3; ++a) {
    const auto [lo, hi] = std::minmax_element(all[a]->begin(), all[a]->end());
    middle[a] = static_cast<float>(.5 * (double{*lo} + *hi));
    squares += (double{*hi} - *lo) * (double{*hi} - *lo);
  }
  return {std::sqrt(squares), {middle[0], middle[1], middle[2]}};
}

}  // namespace

std::size_t judge_distance(const JudgeOptions& options) {
  std::printf("mesh,triangles,points,wrong sign,too far off,largest error over the diagonal\n");
  std::size_t wrong = 0;
  for (auto& [name, mesh] : closed_meshes(options)) {
    const Triangles& triangles = mesh.geometry.triangles;
    const Extent box = extent_of(triangles);
    const World world(mesh, {});
    const NearestTriangle exact(triangles);
    std::size_t sign = 0, far = 0;
    double largest = 0;
#pragma omp parallel for reduction(+ : sign, far) reduction(max : largest) schedule(dynamic, 64)
    for (std::size_t i = 0; i < options.count; ++i) {
      test::Random random(i + 1);
      const Float3 point =
          test::at(box.middle, .6 * box.diagonal * random.unit(), random.direction());
      const float found = signed_distance(world, point);
      const Real error = std::fabs(std::fabs(Real{found}) - exact.distance(point)) / box.diagonal;
      sign += std::signbit(found) != contains(world, point);
      far += !(error < 1e-6L);
      largest = std::max(largest, static_cast<double>(error));
    }
    std::printf("%s,%zu,%zu,%zu,%zu,%.1e\n",
                name.c_str(),
                triangles.size(),
                options.count,
                sign,
                far,
                largest);
    std::fflush(stdout);
    wrong += sign + far;
  }
  return wrong;
}

}  // namespace grelha::perf
