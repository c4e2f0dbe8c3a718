#pragma once
// Rays that start far from a grid. Floats lose such a ray's way through it, so it walks in the
// frame of the grid: from the grid's corner, and from the point where it comes near, which is found
// in double. Cases that float tests cannot decide there are decided with the ray as given.

#include "kernel/walk/packet_traversal.hpp"

namespace grelha::GRELHA_ISA {

inline bool starts_near(const GridView& g, const float (&org)[3]) {
  bool near = true;
  for (int a = 0; a < 3; ++a)
    near &= org[a] >= g.near_lo[a] && org[a] <= g.near_hi[a];
  return near;
}

/// The point where a ray comes near a grid.
struct Entry {
  float org[3];  ///< from the corner of the grid
  double shift;  ///< t at that point
};

/// A coordinate of a ray at t, relative to x.
inline double place_at(double org, double dir, double t, double x) {
  double along = 0, rest = 0, from = 0, of_from = 0, sum = 0, of_sum = 0;
  two_product(t, dir, along, rest);
  two_sum(org, -x, from, of_from);
  two_sum(along, from, sum, of_sum);
  return sum + (of_sum + (rest + of_from));
}

/// Returns false if the ray, which starts far from a grid, does not come to it from t_min to t_max.
/// Points on its way are off by 2^-100 of it; a second look would be off by that much of the first
/// error.
inline bool enter_from_afar(const GridView& g,
                            const float (&org)[3],
                            const float (&dir)[3],
                            double t_min,
                            double t_max,
                            Entry& to) {
  const GridRay r = to_grid(g, org, dir);
  double t0 = -static_cast<double>(kInfinity);
  double t1 = static_cast<double>(kInfinity);
  clip_to_grid(g, r, t0, t1);
  const double slack = 0x1p-48 * t0;
  // a NaN fails these tests
  if (!(t0 <= t1 + slack) || !(t0 > 0) || !(t_min <= t1 + slack) || !(t_max >= t0 - slack))
    return false;
  to.shift = greater(t0, t_min);
  for (int a = 0; a < 3; ++a)
    to.org[a] = static_cast<float>(place_at(org[a], dir[a], to.shift, g.lo[a]));
  return true;
}

/// Times t: bound of the error of entries and exits in float, which is 3 u.
inline constexpr float kEntryRoom = 0x1p-20f;

/// Upper and lower bounds of t, counted from `shift` on.
inline float no_later(float t, double shift) {
  return not_below((t - shift) + magnitude(shift) * 0x1p-51);
}
inline float no_earlier(float t, double shift) {
  return not_above((t - shift) - magnitude(shift) * 0x1p-51);
}
/// Start of a search from `shift` on: unlimited if t_min comes before the shift, else 0.
inline float begin_from(double t_min, double shift) {
  return t_min < shift ? -kInfinity : 0.f;
}

/// A grid in its own frame.
inline GridView in_its_frame(const GridView& g) {
  GridView own = g;
  for (int a = 0; a < 3; ++a) {
    own.lo_f[a] = 0;
    own.hi_f[a] = not_below(g.cell[a] * g.n[a]);
    own.lo[a] = 0;
  }
  return own;
}

/// Copies rays that start far from a grid and come to it into the frame of the grid.
class RaysFromAfar {
 public:
  RaysFromAfar(const GridView& g, Packet& p) : p_(p) {
    Packet& w = moved_;
    w.size = p.size;
    w.groups = p.groups;
    w.has_units = false;
    w.geometry = p.geometry;
    w.base = g.lo_f;
    w.off = g.off;
    w.room = g.room + 32 * g.off;
    w.given = p.given;
    w.given.shift = shift_;
    w.end = p.best;
    w.live = 0;
    each_live_group(p, [&](int i, int group) {
      if (set_group(g, i, group))
        w.live |= std::uint64_t{1} << group;
    });
  }

  bool any() const { return moved_.live != 0; }
  Packet& packet() { return moved_; }

  /// Stores the hits, with t of the rays as given.
  template <bool kAny>
  void take_hits() {
    each_live_group(moved_, [&](int i, int) {
      for (int k = i; k < i + kWidth<Lanes>; ++k)
        if (comes_[k] && id_of(moved_.id[k]) != id_of(p_.id[k]))
          take_hit<kAny>(k);
    });
  }

 private:
  /// Rays of a group that start far from a grid and do not surely pass it by.
  static unsigned may_come(const GridView& g, const Packet& p, int i) {
    Mask<Lanes> away = Lanes(0) != Lanes(0);
    Lanes t0 = load<Lanes>(p.t_min + i);
    Lanes t1 = load<Lanes>(p.best + i);
    const Mask<Lanes> searching = t1 > t0;
    for (int a = 0; a < 3; ++a) {
      const Lanes o = load<Lanes>(p.org[a] + i);
      const Lanes inverse = Lanes(1) / load<Lanes>(p.dir[a] + i);
      away = either(away, either(o<Lanes(g.near_lo[a]), o> Lanes(g.near_hi[a])));
      // NaN, of a ray along a plane, bounds nothing
      const Lanes x = (Lanes(g.lo_f[a]) - o) * inverse;
      const Lanes y = (Lanes(g.hi_f[a]) - o) * inverse;
      const Mask<Lanes> sound = x - y == x - y;
      t0 = greater(select(sound, lesser(x, y), t0), t0);
      t1 = lesser(select(sound, greater(x, y), t1), t1);
    }
    const Lanes room = Lanes(kEntryRoom) * larger(t0, t1);
    return bits(both(both(away, searching), but_not(away, t0 - room > t1 + room)));
  }

  bool set_group(const GridView& g, int i, int group) {
    Packet& w = moved_;
    bool some = false;
    const unsigned lanes = may_come(g, p_, i);
    if (lanes == 0)
      return false;
    for (int k = i; k < i + kWidth<Lanes>; ++k) {
      float org[3], dir[3];
      for (int a = 0; a < 3; ++a) {
        org[a] = p_.org[a][k];
        dir[a] = p_.dir[a][k];
      }
      Entry to{};
      const bool comes =
          (lanes >> (k - i) & 1) && enter_from_afar(g, org, dir, p_.t_min[k], p_.best[k], to);
      comes_[k] = comes;
      some |= comes;
      shift_[k] = to.shift;
      for (int a = 0; a < 3; ++a)
        w.org[a][k] = to.org[a];
      w.t_min[k] = w.start[k] = begin_from(p_.t_min[k], to.shift);
      w.best[k] = comes ? no_later(p_.best[k], to.shift) : -kInfinity;
      w.low[k] = no_earlier(p_.low[k], to.shift);
    }
    if (some)
      copy_group(i, group);
    return some;
  }

  void copy_group(int i, int group) {
    const auto copy = [i](const float* from, float* to) { store(to + i, load<Lanes>(from + i)); };
    Packet& w = moved_;
    w.group_axis[group] = p_.group_axis[group];
    copy(p_.id, w.id);
    copy(p_.axis, w.axis);
    copy(p_.inv_dd, w.inv_dd);
    copy(p_.inv_length, w.inv_length);
    for (int a = 0; a < 3; ++a) {
      copy(p_.dir[a], w.dir[a]);
      copy(p_.shear[a], w.shear[a]);
    }
  }

  template <bool kAny>
  void take_hit(int k) {
    p_.id[k] = moved_.id[k];
    p_.best[k] = kAny ? -kInfinity : no_later(moved_.best[k], -shift_[k]);
    p_.low[k] = kAny ? -kInfinity : no_earlier(moved_.low[k], -shift_[k]);
  }

  Packet& p_;
  Packet moved_;
  alignas(64) double shift_[kPacket];
  bool comes_[kPacket];
};

/// The live rays of a packet that start far from a grid.
template <bool kAny>
[[gnu::noinline]] void search_from_afar(const GridView& g,
                                        Packet& p,
                                        const TraceOptions& options,
                                        Counters& n) {
  RaysFromAfar rays(g, p);
  if (rays.any()) {
    traverse_packet<kAny>(in_its_frame(g), rays.packet(), options.packet, options.mailbox, n);
    rays.template take_hits<kAny>();
  }
}

}  // namespace grelha::GRELHA_ISA
