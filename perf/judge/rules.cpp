#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "grelha/distance.hpp"
#include "grelha/inside.hpp"
#include "perf/judge/judge.hpp"
#include "tests/support/inside_cases.hpp"
#include "tests/support/rational_winding.hpp"
#include "tests/support/solid_angle.hpp"

namespace grelha::perf {
namespace {

constexpr double kAllowed[] = {1, .01, 1e-6, 1e-12};  ///< errors of winding numbers
constexpr double kDecided = 0x1p-16;     ///< how near to 1/2 a winding number may decide either way
constexpr double kRounding = 0x1p-40;    ///< of a winding number in double
constexpr double kLongDouble = 0x1p-26;  ///< what that of an open mesh is known within
constexpr float kTooNear = 1e-6f;        ///< to an open mesh for long double

struct Tally {
  std::size_t inside = 0, wrong = 0, far_off = 0;
  double largest = 0;  ///< error of a winding number over what it may be
};

/// Rules that count crossings: each against rational numbers, and the sign of the distance.
void judge_crossings(const World& world, const Float3& point, int around, Tally& tally) {
  const float distance = signed_distance(world, point, InsideRule::kNonzero);
  tally.wrong += contains(world, point) != (around % 2 != 0);
  tally.wrong += contains(world, point, InsideRule::kNonzero) != (around != 0);
  tally.wrong += distance != 0 && (distance < 0) != (around != 0);
}

void judge_winding(
    const World& world, const Float3& point, double expected, double rounding, Tally& tally) {
  for (const double error : kAllowed) {
    const double off = std::abs(winding_number(world, point, error) - expected);
    tally.far_off += !(off <= error + rounding);
    tally.largest = std::max(tally.largest, off / (error + rounding));
  }
  const double beyond = std::abs(expected) - .5;
  tally.inside += beyond > 0;
  if (std::abs(beyond) > kDecided)
    tally.wrong += contains(world, point, InsideRule::kWinding) != (beyond > 0);
}

/// True if a point is nearer to an edge than 2^-24 of its length, where nothing is promised.
bool is_beside_edge(const Triangles& t, const Float3& point) {
  using test::brute::v;
  const auto corner = [&](std::uint32_t i) { return v(t.x[i], t.y[i], t.z[i]); };
  const auto is_beside = [&](std::uint32_t from, std::uint32_t to) {
    const auto edge = corner(to) - corner(from);
    const auto way = v(point) - corner(from);
    const auto square = dot(edge, edge);
    const auto along = std::clamp<test::oracle::Real>(dot(way, edge) / square, 0, 1);
    const auto gap = way - along * edge;
    return dot(gap, gap) < 0x1p-48L * square;
  };
  for (std::size_t i = 0; i < t.size(); ++i)
    if (is_beside(t.a[i], t.b[i]) || is_beside(t.b[i], t.c[i]) || is_beside(t.c[i], t.a[i]))
      return true;
  return false;
}

}  // namespace

std::size_t judge_rules(const JudgeOptions& options) {
  std::printf(
      "mesh,triangles,points,inside by winding,wrong,winding too far off,largest share of its "
      "bound\n");
  std::vector<Scene> closed = test::closed_meshes();
  const std::vector<Scene> open = test::open_meshes();
  for (const Scene& s : test::flat_sided_meshes())
    closed.push_back(s);
  std::size_t wrong = 0;
  for (std::size_t m = 0; m < closed.size() + open.size(); ++m) {
    const bool is_closed = m < closed.size();
    const Scene& s = is_closed ? closed[m] : open[m - closed.size()];
    Scene with_nan = s;  // which changes nothing
    test::add_triangle(with_nan, {test::kNaN, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const World world(with_nan, {});
    const std::size_t count = options.count / (closed.size() + open.size());
    const std::vector<Float3> points = test::points_around(s, m + 1, count);
    std::size_t inside = 0, bad = 0, far_off = 0;
    double largest = 0;
#pragma omp parallel for reduction(+ : inside, bad, far_off) reduction(max : largest) \
    schedule(dynamic, 64)
    for (std::size_t i = 0; i < count; ++i) {
      Tally tally;
      test::Random random(i + 1);
      const auto around = test::rational::winding(s.geometry.triangles, points[i], random);
      if (!around)
        continue;  // on the mesh
      if (is_closed) {
        judge_crossings(world, points[i], *around, tally);
        if (!is_beside_edge(s.geometry.triangles, points[i]))
          judge_winding(world, points[i], *around, kRounding, tally);
      } else if (closest_point(world, points[i]).distance > kTooNear) {
        const auto number = test::winding_number(s.geometry.triangles, points[i]);
        judge_winding(world, points[i], static_cast<double>(number), kLongDouble, tally);
      }
      inside += tally.inside;
      bad += tally.wrong;
      far_off += tally.far_off;
      largest = std::max(largest, tally.largest);
    }
    std::printf("%s %zu,%zu,%zu,%zu,%zu,%zu,%.1e\n",
                is_closed ? "closed" : "open",
                m,
                s.geometry.triangles.size(),
                count,
                inside,
                bad,
                far_off,
                largest);
    std::fflush(stdout);
    wrong += bad + far_off;
  }
  return wrong;
}

}  // namespace grelha::perf
