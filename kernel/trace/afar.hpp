#pragma once
// Rays that start far from a small grid of triangles in a vast scene. Which triangles they meet is
// not off, however far they come from; t is, and so are walks and boxes in float. So each walks by
// itself in the frame of the grid: from the grid's corner, and from where it comes to the grid,
// which is found in double. It is tested as it came (docs/numerics.md).

#include "kernel/walk/abreast.hpp"

namespace grelha::GRELHA_ISA {

/// Of the way to a grid from afar: what t of a hit is off by beside t of a walk. 46 u of the way to
/// the farthest corner, which is at most three times that, and what taking it off rounds by: 140 u,
/// of 256 u.
inline constexpr double kAfarSlack = 0x1p-16;

inline bool starts_near(const GridView& g, const float (&org)[3]) {
  bool near = true;
  for (int a = 0; a < 3; ++a)
    near &= org[a] >= g.near_lo[a] && org[a] <= g.near_hi[a];
  return near;
}

/// Where a ray from afar comes to a grid.
struct Entry {
  float org[3];  ///< from the corner of the grid
  double shift;  ///< t there
  float slack;   ///< what t of its hits may be off by

  float earliest(double t) const { return static_cast<float>(t - shift) - slack; }
  float latest(double t) const { return static_cast<float>(t - shift) + slack; }
};

/// False: the ray, which starts outside the grid, does not come to it from t_min to t_max.
template <class Number>
inline bool enter_from_afar(const GridView& g,
                            const Number (&org)[3],
                            const float (&dir)[3],
                            double t_min,
                            double t_max,
                            Entry& to) {
  const GridRay r = to_grid(g, org, dir);
  double t0 = -static_cast<double>(kInfinity);
  double t1 = static_cast<double>(kInfinity);
  clip_to_grid(g, r, t0, t1);
  const double slack = kAfarSlack * t0;
  // NaN comes nowhere
  if (!(t0 <= t1) || !(t0 > 0) || !(t_min <= t1 + slack) || !(t_max >= t0 - slack))
    return false;
  to.shift = t0;
  to.slack = static_cast<float>(slack);
  for (int a = 0; a < 3; ++a)
    to.org[a] = static_cast<float>((r.p[a] + t0 * r.q[a]) * g.cell[a]);
  return true;
}

/// A grid in its own frame.
inline GridView in_its_frame(const GridView& g) {
  GridView own = g;
  for (float& lo : own.lo_f)
    lo = 0;
  return own;
}

/// Those rays of a packet that start far from a grid and come to it, in the frame of the grid.
template <class In>
class RaysFromAfar : public WalkingRays {
 public:
  RaysFromAfar(const GridView& g, const Packet<In>& p) : p_(p) {
    size = p.size;
    groups = p.groups;
    live = 0;
    each_live_group(p, [&](int i, int group) {
      bool some = false;
      for (int k = i; k < i + kWidth<Lanes>; ++k)
        some |= set(g, k);
      live |= static_cast<std::uint64_t>(some) << group;
    });
  }

  /// What these have met since may be nearer.
  void note_hits_of(const Arrivals& rays) {
    for (int k = 0; k < rays.count; ++k)
      best[rays.ray[k]] = entry_[rays.ray[k]].latest(tested_best(p_)[rays.ray[k]]);
  }

 private:
  bool set(const GridView& g, int i) {
    typename In::Number from[3];
    float at[3], way[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = tested_org(p_, a)[i];
      at[a] = p_.org[a][i];
      way[a] = dir[a][i] = p_.dir[a][i];
    }
    Entry& to = entry_[i];
    const double from_t = tested_t_min(p_)[i];
    const double to_t = tested_best(p_)[i];
    const bool comes = p_.best[i] > p_.t_min[i] && !starts_near(g, at) &&
                       enter_from_afar(g, from, way, from_t, to_t, to);
    for (int a = 0; a < 3; ++a)
      org[a][i] = comes ? to.org[a] : 0;
    t_min[i] = start[i] = comes ? to.earliest(from_t) : 0;
    best[i] = comes ? to.latest(to_t) : -kInfinity;
    return comes;
  }

  const Packet<In>& p_;
  Entry entry_[kPacket];
};

/// The live rays of a packet that start far from a grid, each on its own.
template <bool kAny, class In>
[[gnu::noinline]] void walk_from_afar(const GridView& g, Packet<In>& p, Counters& n) {
  RaysFromAfar<In> rays(g, p);
  if (rays.live == 0)
    return;
  const GridView own = in_its_frame(g);
  RaysUnderWay under_way(own, rays);
  CellTests<kAny, In, true> tests(g, rays, p, n);
  go_abreast(own, under_way, n, [&](const Arrivals& to) {
    tests.test(to);
    rays.note_hits_of(to);
  });
}

}  // namespace grelha::GRELHA_ISA
