#pragma once
// Bundles of rays and what a copy of the kernel answers to them.

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "kernel/variants.hpp"
#include "kernel/world.hpp"
#include "tests/support/random.hpp"

namespace grelha::test {

struct Rays {
  std::vector<float> ox, oy, oz, dx, dy, dz, t_min, t;

  void add(const Float3& o, const Float3& d, float from = 0, float to = kInf) {
    ox.push_back(o.x), oy.push_back(o.y), oz.push_back(o.z), dx.push_back(d.x), dy.push_back(d.y), dz.push_back(d.z);
    t_min.push_back(from), t.push_back(to);
  }
  void add(const Rays& other) {
    for (std::size_t i = 0; i < other.size(); ++i) add(other.org(i), other.dir(i), other.t_min[i], other.t[i]);
  }
  std::size_t size() const { return t.size(); }
  Float3 org(std::size_t i) const { return {ox[i], oy[i], oz[i]}; }
  Float3 dir(std::size_t i) const { return {dx[i], dy[i], dz[i]}; }
  /// In hexadecimal, to be pasted into a smaller test.
  std::string describe(std::size_t i) const {
    std::ostringstream s;
    s << "ray " << i << std::hexfloat << ": org {" << ox[i] << ", " << oy[i] << ", " << oz[i] << "} dir {" << dx[i]
      << ", " << dy[i] << ", " << dz[i] << "} t (" << t_min[i] << ", " << t[i] << ")";
    return s.str();
  }
};

struct Answers {
  std::vector<float> t;
  std::vector<std::uint32_t> id;
  TraceCounts counts;
};

enum class Query { kClosest, kOccluded };

inline Answers trace(const Variant& variant, const World& world, const Rays& rays, const TraceSettings& settings,
                     Query query) {
  Answers a;
  a.t = rays.t;
  a.id.assign(rays.size(), 12345u);  // what no trace may leave behind
  const RaySpan span{rays.ox.data(), rays.oy.data(),    rays.oz.data(), rays.dx.data(), rays.dy.data(),
                     rays.dz.data(), rays.t_min.data(), a.t.data(),     a.id.data(),    static_cast<int>(rays.size())};
  (query == Query::kClosest ? variant.loops.closest : variant.loops.occluded)(world.impl().view, span, settings,
                                                                              a.counts);
  return a;
}

}  // namespace grelha::test
