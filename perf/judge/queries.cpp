#include <cmath>
#include <cstdio>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/isa.hpp"
#include "perf/judge/judge.hpp"
#include "tests/support/brute_force.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::perf {
namespace {

using test::Random;
using test::brute::Crossing;

constexpr int kScenes = 50;
constexpr int kPrimitives = 120;

/// Wrong answers by query; rays whose crossings rounding may decide are not judged.
struct Wrong {
  std::size_t judged = 0, hits = 0, lists = 0, counts = 0, filtered = 0, uv = 0, bits = 0;
};

/// Rays with what they leave out, and the answers to them.
struct Asked {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> skip, counts;
  std::vector<std::uint8_t> mask, masks;
  HitLists lists;
  std::vector<Hit> filtered;
  std::vector<float> u, v;

  Asked(const World& world, std::size_t primitives, std::uint64_t seed, std::size_t count) {
    Random random(seed);
    for (std::size_t i = 0; i < primitives; ++i)
      masks.push_back(static_cast<std::uint8_t>(1 + random.below(3)));
    for (std::size_t i = 0; i < count; ++i) {
      const Float3 org = random.point(2);
      rays.push_back({org, test::minus(random.point(1), org)});
      if (random.chance(.3))
        rays.back().t_min = static_cast<float>(random.in(-1, 1));
      mask.push_back(static_cast<std::uint8_t>(1 + random.below(3)));
    }
    lists = all_hits(world, Rays::of(rays));
    counts.resize(count);
    count_hits(world, Rays::of(rays), counts.data());
    for (std::size_t i = 0; i < count; ++i)
      skip.push_back(lists.of(i).empty() ? kNoPrimitive : lists.of(i)[0].id);
    ask_filtered(world, {.mask = masks});
  }

  void ask_filtered(const World& world, const QueryOptions& options) {
    Rays view = Rays::of(rays);
    view.skip = skip.data();
    view.mask = mask.data();
    filtered.assign(rays.size(), {});
    u.assign(rays.size(), 0);
    v.assign(rays.size(), 0);
    Hits hits = Hits::of(filtered);
    hits.u = u.data();
    hits.v = v.data();
    closest(world, view, hits, options);
  }
};

/// Lists and counts of one ray, and its first hit among what is not left out.
void judge_ray(const Scene& s, const Asked& a, std::size_t i, Wrong& w) {
  const test::brute::RayThroughScene truth(s, a.rays[i]);
  if (!truth.crossings().is_clear)
    return;
  const std::vector<Crossing>& exact = truth.crossings().list;
  const auto found = a.lists.of(i);
  ++w.judged;
  w.hits += exact.size();
  bool is_same = found.size() == exact.size();
  for (std::size_t k = 0; is_same && k < exact.size(); ++k)
    is_same = found[k].id == exact[k].id &&
              std::fabs(found[k].t - exact[k].t) < 1e-6L * (1 + std::fabs(exact[k].t));
  w.lists += !is_same;
  w.counts += a.counts[i] != exact.size();
  std::uint32_t first = kNoPrimitive;
  for (const Crossing& c : exact)
    if (first == kNoPrimitive && c.id != a.skip[i] && (a.masks[c.id] & a.mask[i]) != 0)
      first = c.id;
  w.filtered += a.filtered[i].id != first;
}

/// u and v of a hit meet the point on the ray.
void judge_uv(const World& world, const Scene& s, const Asked& a, std::size_t i, Wrong& w) {
  const Hit& hit = a.filtered[i];
  if (!hit || primitive_of(world, hit.id).kind != PrimitiveKind::kTriangle)
    return;
  const test::brute::Corners c(s.geometry.triangles, primitive_of(world, hit.id).index);
  const test::oracle::Real u = a.u[i], v = a.v[i];
  const auto on_triangle = c.a + u * (c.b - c.a) + v * (c.c - c.a);
  const auto on_ray =
      test::brute::v(a.rays[i].org) + test::oracle::Real{hit.t} * test::brute::v(a.rays[i].dir);
  w.uv += !(u >= 0 && v >= 0 && u + v <= 1) || !(length(on_triangle - on_ray) < 1e-5L);
}

Wrong judge_scene(std::uint64_t seed, std::size_t count) {
  const Scene s = test::random_mixture(seed, kPrimitives);
  const World world(s, {});
  const Geometry& g = s.geometry;
  Asked asked(
      world, g.planes.size() + g.spheres.size() + g.triangles.size() + g.cones.size(), seed, count);
  Wrong w;
  for (std::size_t i = 0; i < count; ++i) {
    judge_ray(s, asked, i, w);
    judge_uv(world, s, asked, i, w);
  }
  const std::vector<Hit> before = asked.filtered;
  for (const Isa& isa : isas()) {
    if (!isa.is_supported)
      continue;
    asked.ask_filtered(world, {.isa = isa.name, .mask = asked.masks});
    for (std::size_t i = 0; i < count; ++i)
      w.bits += asked.filtered[i].id != before[i].id || asked.filtered[i].t != before[i].t;
  }
  return w;
}

}  // namespace

std::size_t judge_queries(const JudgeOptions& options) {
  std::size_t judged = 0, hits = 0, lists = 0, counts = 0, filtered = 0, uv = 0, bits = 0;
#pragma omp parallel for schedule(dynamic) \
    reduction(+ : judged, hits, lists, counts, filtered, uv, bits)
  for (int scene = 0; scene < kScenes; ++scene) {
    const Wrong w = judge_scene(static_cast<std::uint64_t>(scene) + 1, options.count / kScenes);
    judged += w.judged;
    hits += w.hits;
    lists += w.lists;
    counts += w.counts;
    filtered += w.filtered;
    uv += w.uv;
    bits += w.bits;
  }
  std::printf("rays judged,hits,lists,counts,skip and masks,u v,instruction sets\n");
  std::printf("%zu,%zu,%zu,%zu,%zu,%zu,%zu\n", judged, hits, lists, counts, filtered, uv, bits);
  return lists + counts + filtered + uv + bits;
}

}  // namespace grelha::perf
