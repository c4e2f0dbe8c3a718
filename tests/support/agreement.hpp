#pragma once
// Every query about triangles against rational numbers.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/grelha.hpp"
#include "tests/support/hard_rays.hpp"
#include "tests/support/rational.hpp"

namespace grelha::test {

/// Wrong answers by query.
struct WrongAnswers {
  std::size_t rays = 0, hits = 0;
  std::size_t closest = 0, occluded = 0, lists = 0, counts = 0, filters = 0, uv = 0, crossings = 0;

  std::size_t all() const { return closest + occluded + lists + counts + filters + uv + crossings; }
  WrongAnswers& operator+=(const WrongAnswers& w) {
    rays += w.rays;
    hits += w.hits;
    closest += w.closest;
    occluded += w.occluded;
    lists += w.lists;
    counts += w.counts;
    filters += w.filters;
    uv += w.uv;
    crossings += w.crossings;
    return *this;
  }
};

/// Asks about rays at triangles, and compares with rational numbers.
class Judge {
 public:
  explicit Judge(const Scene& scene) : scene_(scene), world_(scene, {.threads = 1}), exact_(scene) {
    Random random(3);
    for (std::size_t i = 0; i < scene.geometry.triangles.a.size(); ++i)
      masks_.push_back(static_cast<std::uint8_t>(1 + random.below(3)));
  }

  WrongAnswers ask(const std::vector<Ray>& rays, std::uint64_t seed) const {
    Asked a(*this, rays, seed);
    WrongAnswers sum;
    for (std::size_t i = 0; i < rays.size(); ++i)
      sum += judge(a, i);
    return sum;
  }

 private:
  using Exact = std::vector<std::pair<mpq_class, std::uint32_t>>;

  /// What the queries answer.
  struct Asked {
    const std::vector<Ray>& rays;
    std::vector<Hit> closest, filtered;
    std::vector<float> u, v;
    std::vector<double> t_double;
    std::vector<std::uint8_t> blocked, blocked_of_filtered, mask;
    std::vector<std::uint32_t> skip, counts, crossing_counts;
    HitLists lists;
    CrossingLists crossings;

    Asked(const Judge& judge, const std::vector<Ray>& asked, std::uint64_t seed)
        : rays(asked),
          closest(asked.size()),
          filtered(asked.size()),
          u(asked.size()),
          v(asked.size()),
          t_double(asked.size()),
          blocked(asked.size()),
          blocked_of_filtered(asked.size()),
          counts(asked.size()),
          crossing_counts(asked.size()) {
      const World& world = judge.world_;
      Rays view = Rays::of(std::span(rays));
      Hits hits = Hits::of(std::span(closest));
      hits.u = u.data();
      hits.v = v.data();
      grelha::closest(world, view, hits);
      occluded(world, view, blocked.data());
      lists = all_hits(world, view);
      count_hits(world, view, counts.data());
      crossings = grelha::crossings(world, view);
      count_crossings(world, view, crossing_counts.data());
      Random random(seed);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        mask.push_back(static_cast<std::uint8_t>(1 + random.below(3)));
        skip.push_back(closest[i].id);
      }
      view.skip = skip.data();
      view.mask = mask.data();
      hits = Hits::of(std::span(filtered));
      hits.t_double = t_double.data();
      grelha::closest(world, view, hits, {.mask = judge.masks_});
      occluded(world, view, blocked_of_filtered.data(), {.mask = judge.masks_});
    }
  };

  WrongAnswers judge(const Asked& a, std::size_t i) const {
    const Ray& ray = a.rays[i];
    Exact exact;
    if (std::nextafter(ray.t_min, kInf) < ray.t_max)
      exact = exact_.all(ray);
    WrongAnswers w;
    w.rays = 1;
    w.hits = exact.size();
    const Hit first = exact.empty() ? Hit{ray.t_max} : hit_of(ray, exact.front());
    w.closest = !same(a.closest[i], first) || !same(closest(world_, ray), first);
    w.occluded = (a.blocked[i] != 0) != bool(first) || occluded(world_, ray) != bool(first);
    w.lists = !is_list(ray, a.lists.of(i), exact) || !is_list(ray, all_hits(world_, ray), exact);
    w.counts = a.counts[i] != exact.size();
    const auto* const exact_passing = first_passing(exact, a.skip[i], a.mask[i]);
    const Hit passing = exact_passing ? hit_of(ray, *exact_passing) : Hit{ray.t_max};
    const Filter filter{a.skip[i], masks_, a.mask[i]};
    w.filters = !same(a.filtered[i], passing) || (a.blocked_of_filtered[i] != 0) != bool(passing) ||
                !same(closest(world_, ray, filter), passing) ||
                occluded(world_, ray, filter) != bool(passing) ||
                (exact_passing && !is_near(a.t_double[i], exact_passing->first));
    w.uv = first && !are_weights(ray, first.id, a.u[i], a.v[i]);
    w.crossings = !is_crossed(ray, a.crossings.of(i), a.crossing_counts[i], exact) ||
                  count_crossings(world_, ray) != a.crossing_counts[i];
    return w;
  }

  static bool same(const Hit& a, const Hit& b) {
    return a.id == b.id && a.t == b.t && std::signbit(a.t) == std::signbit(b.t);
  }
  static bool is_near(double t, const mpq_class& exact) {
    return abs(mpq_class(t) - exact) <= 0x1p-45 * abs(exact);
  }

  /// t between the ends of the search, rounded once.
  static float inner(const Ray& ray, const mpq_class& exact) {
    const float t = rational::nearest(exact);
    const float after = t > ray.t_min ? t : std::nextafter(ray.t_min, kInf);
    return (after < ray.t_max ? after : std::nextafter(ray.t_max, -kInf)) + 0.f;
  }
  static Hit hit_of(const Ray& ray, const std::pair<mpq_class, std::uint32_t>& exact) {
    return {inner(ray, exact.first), exact.second};
  }

  static bool is_list(const Ray& ray, std::span<const Hit> found, const Exact& exact) {
    bool is = found.size() == exact.size();
    for (std::size_t k = 0; is && k < found.size(); ++k)
      is = same(found[k], hit_of(ray, exact[k]));
    return is;
  }

  const std::pair<mpq_class, std::uint32_t>* first_passing(const Exact& exact,
                                                           std::uint32_t skip,
                                                           unsigned mask) const {
    for (const auto& hit : exact)
      if (hit.second != skip && (masks_[hit.second] & mask) != 0)
        return &hit;
    return nullptr;
  }

  /// Corners of a triangle.
  std::array<rational::Vector, 3> corners(std::uint32_t id) const {
    const Triangles& t = scene_.geometry.triangles;
    return {vertex(scene_, t.a[id]), vertex(scene_, t.b[id]), vertex(scene_, t.c[id])};
  }

  bool are_weights(const Ray& ray, std::uint32_t id, float u, float v) const {
    const auto c = corners(id);
    const rational::Vector d(ray.dir);
    const rational::Vector org(ray.org);
    const auto edge = [&](int k) {
      return dot(d, cross(c[(k + 1) % 3] - org, c[(k + 2) % 3] - org));
    };
    const mpq_class sum = edge(0) + edge(1) + edge(2);
    const auto near = [&](float x, int k) {
      return x >= 0 && abs(mpq_class(x) - edge(k) / sum) < 0x1p-22;
    };
    return double{u} + double{v} <= 1 && near(u, 1) && near(v, 2);
  }

  /// A ray's crossings are those of one that starts beside it, by a distance that is there but less
  /// than all others: 2^-1500 along one axis, the square of that along another.
  bool is_crossed(const Ray& ray,
                  std::span<const Crossing> found,
                  std::size_t count,
                  const Exact& hits) const {
    const double x = std::fabs(ray.dir.x), y = std::fabs(ray.dir.y), z = std::fabs(ray.dir.z);
    const int k = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    mpq_class step(1);
    mpz_mul_2exp(step.get_den_mpz_t(), step.get_den_mpz_t(), 1500);
    rational::Vector org(ray.org);
    mpq_class* const part[] = {&org.x, &org.y, &org.z};
    *part[(k + 1) % 3] += step;
    *part[(k + 2) % 3] += step * step;
    std::vector<std::pair<mpq_class, std::size_t>> order;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const auto c = corners(hits[i].second);
      if (const auto t = rational::crossing(org, ray.dir, c[0], c[1], c[2]))
        order.emplace_back(*t, i);
    }
    std::sort(order.begin(), order.end());
    bool is = found.size() == order.size() && count == order.size();
    for (std::size_t i = 0; is && i < found.size(); ++i) {
      const auto& hit = hits[order[i].second];
      const auto c = corners(hit.second);
      const bool enters = dot(cross(c[1] - c[0], c[2] - c[0]), rational::Vector(ray.dir)) < 0;
      is = found[i].id == hit.second && found[i].t == inner(ray, hit.first) &&
           found[i].enters == enters;
    }
    return is;
  }

  const Scene& scene_;
  World world_;
  rational::FirstTriangle exact_;
  std::vector<std::uint8_t> masks_;
};

/// A surface made with sines and cosines: n x n quadrilaterals, whose coordinates are 6e-17 where
/// they should be 0. Rays along axes see its triangles nearly edge on.
inline Scene turned_mesh(int n, bool is_torus) {
  Scene s = empty_scene();
  Triangles& t = s.geometry.triangles;
  constexpr double kPi = 3.141592653589793;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double a = 2 * kPi * i / n;
      const double b = (is_torus ? 2 : 1) * kPi * k / n;
      const double r = is_torus ? 2 + std::cos(b) : std::sin(b);
      t.x.push_back(static_cast<float>(r * std::cos(a)));
      t.y.push_back(static_cast<float>(r * std::sin(a)));
      t.z.push_back(static_cast<float>(is_torus ? std::sin(b) : std::cos(b)));
    }
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const auto a = static_cast<std::uint32_t>(i * (n + 1) + k);
      const auto b = a + static_cast<std::uint32_t>(n) + 1;
      for (const bool second : {false, true}) {
        t.a.push_back(a);
        t.b.push_back(second ? b + 1 : b);
        t.c.push_back(second ? a + 1 : b + 1);
        t.material.push_back(0);
      }
    }
  return s;
}

/// A mesh with each triangle so many times, as it is.
inline Scene many_times(Scene s, int times) {
  Triangles& t = s.geometry.triangles;
  const std::size_t n = t.a.size();
  for (int k = 1; k < times; ++k)
    for (std::size_t i = 0; i < n; ++i) {
      t.a.push_back(t.a[i]);
      t.b.push_back(t.b[i]);
      t.c.push_back(t.c[i]);
      t.material.push_back(0);
    }
  return s;
}

/// Meshes on which queries have disagreed.
inline std::vector<std::pair<const char*, Scene>> agreement_meshes() {
  std::vector<std::pair<const char*, Scene>> all;
  all.emplace_back("ball of 4", turned_mesh(4, false));
  all.emplace_back("ball of 16", turned_mesh(16, false));
  all.emplace_back("torus of 4", turned_mesh(4, true));
  all.emplace_back("torus of 16", turned_mesh(16, true));
  all.emplace_back("ball, three copies", many_times(turned_mesh(8, false), 3));
  all.emplace_back("four triangles, 1200 copies", many_times(random_triangles(5, 4), 1200));
  all.emplace_back("lattice", lattice_patch(8));
  all.emplace_back("sheets", stacked_sheets(300));
  all.emplace_back("slivers", slivers(5, 200));
  all.emplace_back("cube at 0", cube_at_zero(4));
  all.emplace_back("cube of 12, in no grid", cube_at_zero(1));
  all.emplace_back("seven triangles, in no grid", random_triangles(6, 7));
  return all;
}

}  // namespace grelha::test
