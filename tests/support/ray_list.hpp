#pragma once
// Bundles of rays and what a copy of the kernel answers to them.

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/query/variants.hpp"
#include "kernel/world/world_impl.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {

struct RayList {
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t;

  void add(const Float3& o, const Float3& d, float from = 0, float to = kInf) {
    ox.push_back(o.x);
    oy.push_back(o.y);
    oz.push_back(o.z);
    dx.push_back(d.x);
    dy.push_back(d.y);
    dz.push_back(d.z);
    t_min.push_back(from);
    t.push_back(to);
  }
  void add(const RayList& other) {
    for (std::size_t i = 0; i < other.size(); ++i)
      add(other.org(i), other.dir(i), other.t_min[i], other.t[i]);
  }
  std::size_t size() const { return t.size(); }
  Float3 org(std::size_t i) const { return {ox[i], oy[i], oz[i]}; }
  Float3 dir(std::size_t i) const { return {dx[i], dy[i], dz[i]}; }
  Rays view() const {
    return {.org = {ox.data(), oy.data(), oz.data()},
            .dir = {dx.data(), dy.data(), dz.data()},
            .t_min = t_min.data(),
            .t_max = t.data(),
            .count = size()};
  }
  /// In hexadecimal, to be pasted into a smaller test.
  std::string describe(std::size_t i) const {
    std::ostringstream s;
    s << "ray " << i << std::hexfloat << ": org {" << ox[i] << ", " << oy[i] << ", " << oz[i]
      << "} dir {" << dx[i] << ", " << dy[i] << ", " << dz[i] << "} t (" << t_min[i] << ", " << t[i]
      << ")";
    return s.str();
  }
};

struct Answers {
  std::vector<float> t;
  std::vector<std::uint32_t> id;
  TraceCounts counts;

  /// Answers of occluded(): of rays with something in the way t is -infinity, and the id 0.
  void block(const RayList& rays, const std::vector<std::uint8_t>& blocked) {
    for (std::size_t i = 0; i < blocked.size(); ++i) {
      if (blocked[i] > 1)
        throw std::logic_error("expected 0 or 1 for ray " + std::to_string(i));
      t.push_back(blocked[i] ? -kInf : rays.t[i]);
      id.push_back(blocked[i] ? 0 : kNoPrimitive);
    }
  }
};

enum class Query { kClosest, kOccluded };

inline Answers trace(const Variant& variant,
                     const World& world,
                     const RayList& rays,
                     const TraceOptions& settings,
                     Query query) {
  Answers a;
  const SceneView& scene = world.impl().view;
  if (query == Query::kOccluded) {
    std::vector<std::uint8_t> blocked(rays.size(), 77);
    variant.loops.occluded(scene, rays.view(), blocked.data(), settings, a.counts);
    a.block(rays, blocked);
    return a;
  }
  a.t.assign(rays.size(), 12345);  // what no trace may leave behind
  a.id.assign(rays.size(), 12345u);
  const Hits hits{.t = a.t.data(), .id = a.id.data()};
  variant.loops.closest(scene, rays.view(), hits, settings, a.counts);
  return a;
}

// ---- bundles ----

/// Rays about a ball of the given size: most aimed at it from any distance, some from inside, some
/// past it, some along the axes, with ends and lengths of all kinds.
inline RayList rays_about(
    Random& random, const Float3& center, double size, int count, double farthest = 1e3) {
  RayList rays;
  for (int i = 0; i < count; ++i) {
    const double away = size * (random.chance(.2) ? random.unit() : random.log_in(.5, farthest));
    const Float3 org = at(center, away, random.direction());
    const Float3 aim = at(center, size * random.in(0, 1.3), random.direction());
    Float3 dir = minus(aim, org);
    if (random.chance(.2)) {  // along an axis, with zeros of both signs beside it
      const std::uint32_t a = random.below(3);
      const float length = static_cast<float>(random.sign());
      for (std::uint32_t b = 0; b < 3; ++b)
        component(dir, b) = b == a ? length : random.zero();
    } else if (random.chance(.15)) {
      component(dir, random.below(3)) = random.chance(.5) ? random.zero() : 1e-41f;
    }
    if (random.chance(.5))
      dir = scaled(dir, random.log_in(1e-3, 1e3));
    const float from = random.chance(.8) ? 0.f : static_cast<float>(random.in(-1, 1));
    rays.add(
        org, dir, from, random.chance(.7) ? kInf : static_cast<float>(random.log_in(1e-2, 1e2)));
  }
  return rays;
}

/// The same with one component of some rays replaced by a value no caller should send.
inline RayList with_odd_values(Random& random, RayList rays, double share) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!random.chance(share))
      continue;
    std::vector<float>* const fields[] = {
        &rays.ox, &rays.oy, &rays.oz, &rays.dx, &rays.dy, &rays.dz, &rays.t_min, &rays.t};
    (*fields[random.below(8)])[i] = random.odd();
  }
  return rays;
}

}  // namespace grelha::test
