#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "grelha/all_hits.hpp"
#include "perf/judge/hard_rays.hpp"
#include "tests/support/rational.hpp"

namespace grelha::perf {
namespace {

constexpr double kMoves[] = {0, 1e3, 1e6};
constexpr double kEyes[] = {.8, 3, 100, 1e4};

struct Wrong {
  std::size_t rays = 0, hits = 0, found = 0, id = 0, t = 0, order = 0;
  std::size_t all() const { return found + id + t + order; }
  Wrong& operator+=(const Wrong& w) {
    rays += w.rays;
    hits += w.hits;
    found += w.found;
    id += w.id;
    t += w.t;
    order += w.order;
    return *this;
  }
};

/// The answers to one ray beside the exact ones.
Wrong compare(const Hit& first,
              std::span<const Hit> all,
              const std::vector<std::pair<mpq_class, std::uint32_t>>& exact) {
  Wrong w{1, !exact.empty()};
  if (bool(first) != !exact.empty()) {
    w.found = 1;
    return w;
  }
  if (first) {
    w.id = first.id != exact[0].second;
    w.t = first.t != test::rational::nearest(exact[0].first);
  }
  w.order = all.size() != exact.size();
  for (std::size_t i = 0; i < all.size() && w.order == 0; ++i)
    w.order = all[i].id != exact[i].second;
  return w;
}

Wrong judge(const MovedMesh& m,
            const World& world,
            const test::rational::FirstTriangle& exact,
            int kind,
            double away,
            std::size_t count) {
  std::vector<Ray> rays;
  test::Random random(7 + static_cast<std::uint64_t>(kind));
  for (std::size_t i = 0; i < count; ++i)
    rays.push_back(ray_of(m, kind, away, random));
  std::vector<Hit> first(count);
  closest(world, std::span(rays), std::span(first));
  const HitLists lists = all_hits(world, Rays::of(rays));
  Wrong sum;
#pragma omp parallel
  {
    Wrong own;
#pragma omp for schedule(dynamic, 16)
    for (std::size_t i = 0; i < count; ++i)
      own += compare(first[i], lists.of(i), exact.all(rays[i]));
#pragma omp critical
    sum += own;
  }
  return sum;
}

void tell(const char* mesh, double by, const char* kind, const Wrong& w) {
  std::printf("%s,%g,%s,%zu,%zu,%zu,%zu,%zu,%zu\n",
              mesh,
              by,
              kind,
              w.rays,
              w.hits,
              w.found,
              w.id,
              w.t,
              w.order);
  std::fflush(stdout);
}

}  // namespace

std::size_t judge_rays(const JudgeOptions& options) {
  std::printf("mesh,moved,kind,rays,hits,hit or miss,id,t,order\n");
  const std::vector<Mesh> all = hard_meshes(options);
  // a scan that keeps four bits a coordinate takes rational numbers a hundred times as long
  constexpr double kSmallShare = .01;
  double shares = 0;
  const auto share = [&](const Mesh& mesh, double by) {
    return mesh.is_large && by > 1e5 ? kSmallShare : 1.;
  };
  for (const Mesh& mesh : all)
    for (const double by : kMoves)
      shares += share(mesh, by) * std::size(kEyes);
  Wrong sum[kKindCount];
  for (const Mesh& mesh : all)
    for (const double by : kMoves) {
      const MovedMesh m = moved(mesh.scene, by);
      const World world(m.scene, {});
      const test::rational::FirstTriangle exact(m.scene);
      const double each = std::ceil(share(mesh, by) / shares * static_cast<double>(options.count));
      for (int kind = 0; kind < kKindCount; ++kind) {
        Wrong here;
        for (const double away : kEyes)
          here += judge(m, world, exact, kind, away, static_cast<std::size_t>(each));
        tell(mesh.name.c_str(), by, kKinds[kind], here);
        sum[kind] += here;
      }
    }
  std::size_t wrong = 0;
  for (int kind = 0; kind < kKindCount; ++kind) {
    tell("all", 0, kKinds[kind], sum[kind]);
    wrong += sum[kind].all();
  }
  return wrong;
}

}  // namespace grelha::perf
