// Floors of two triangles far larger than what stands on them: t and points must not feel the
// distant corners. Truth is long double from the very float corners.
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/stability/spots.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;
using oracle::Facet;
using oracle::Real;
using oracle::V;

/// Of t: twice the 8 eps of kernel/shapes/triangle.hpp.
constexpr Real kClose = 16 * oracle::kEps;
/// Of the farthest corner's distance: what double leaves open of an edge, some 30 roundings of
/// 2^-53, and more.
constexpr Real kNearEdge = 0x1p-45L;

Float3 rounded(const V& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
Real largest_of(const V& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

struct Place {
  V point, normal;  ///< of a facet: exact, unit, up
  std::uint32_t id;
};

/// The facets of a scene of triangles alone, and what lies where.
class Facets {
 public:
  void add(const Float3& a, const Float3& b, const Float3& c) {
    add_triangle(scene, a, b, c);
    facets_.push_back({a, b, c});
    const V middle = (Real(1) / 3) * (facets_.back().a + facets_.back().b + facets_.back().c);
    const Real reach = std::max({length(facets_.back().a - middle),
                                 length(facets_.back().b - middle),
                                 length(facets_.back().c - middle)});
    balls_.push_back({double(middle.x), double(middle.y), double(middle.z), double(reach)});
  }
  const Facet& operator[](std::size_t i) const { return facets_[i]; }

  /// Returns the required hit of the ray before t = end, ignoring facet `left`. The ray's origin is
  /// exact to within `coarse`.
  Expected wanted(const oracle::Ray& ray, Real coarse, Real end, std::uint32_t left) const {
    Expected w;
    w.left = left;
    Real earliest = end;
    Real latest = end;
    const Real scale = length(ray.dir);
    each_near(ray, [&](std::uint32_t i) {
      const Facet& f = facets_[i];
      const Real along = dot(ray.dir, f.normal());
      if (i == left || along == 0)
        return;
      const Real farthest =
          std::max({length(f.a - ray.org), length(f.b - ray.org), length(f.c - ray.org)});
      const Real inside = f.clearance(ray);
      const Real open = coarse + kNearEdge * farthest;
      if (inside < -open)
        return;
      const Real t = dot(f.a - ray.org, f.normal()) / along;
      Real off = kClose * std::abs(t) + 2 * coarse * length(f.normal()) / std::abs(along);
      if (inside <= open)
        off = std::max(off, 4 * open * length(f.normal()) / std::abs(along));
      off = std::min(off, farthest / scale);
      if (t + off <= 0 || t - off >= end)
        return;
      earliest = std::min(earliest, t - off);
      if (inside > open && t - off > 0 && t + off < end)
        latest = std::min(latest, t + off);
    });
    w.hit = latest < end;
    w.miss = earliest >= end;
    w.earliest = double(earliest);
    w.latest = w.hit ? double(latest) : double{kInf};
    return w;
  }

  /// Finds the first hit of the ray; returns false if it is not certain.
  bool first(const oracle::Ray& ray, Place& to) const {
    Real least = 1e300L;
    Real second = 1e300L;
    bool sure = false;
    each_near(ray, [&](std::uint32_t i) {
      const Facet& f = facets_[i];
      const auto c = f.first(ray, 0);
      if (!c || c->t >= least) {
        if (c)
          second = std::min(second, c->t);
        return;
      }
      second = least;
      least = c->t;
      const V n = oracle::unit(f.normal());
      to = {ray.point(c->t), dot(n, ray.dir) < 0 ? n : Real(-1) * n, i};
      sure = f.to_edges(to.point) > 64 * oracle::kEps * largest_of(to.point);
    });
    return sure && second > least * (1 + 4 * kClose);
  }

  Scene scene = empty_scene();

 private:
  /// Facets whose ball the ray's line touches, with room to spare.
  template <class Use>
  void each_near(const oracle::Ray& ray, const Use& use) const {
    const double d[3] = {double(ray.dir.x), double(ray.dir.y), double(ray.dir.z)};
    const double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const auto& b = balls_[i];
      const double p[3] = {
          b[0] - double(ray.org.x), b[1] - double(ray.org.y), b[2] - double(ray.org.z)};
      const double pd = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
      const double pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
      if (pp - pd * pd / dd <= 1.1 * b[3] * b[3] + 1e-4 * pp)
        use(static_cast<std::uint32_t>(i));
    }
  }

  std::vector<Facet> facets_;
  std::vector<std::array<double, 4>> balls_;  ///< around each: middle, radius
};

/// A square of two triangles, 0 and 1, level or tilted at any angle.
class Ground {
 public:
  Ground(Random& random, double half, bool tilted) : half_(half) {
    up_ = tilted ? V(random.direction()) : V(0, 1, 0);
    along_ = oracle::unit(oracle::cross(up_, random.direction()));
    other_ = oracle::cross(along_, up_);
    middle_ = V(random.point(2));
    const Float3 corner[] = {of(-1, -1), of(1, -1), of(1, 1), of(-1, 1)};
    facets.add(corner[0], corner[1], corner[2]);
    facets.add(corner[0], corner[2], corner[3]);
  }

  /// A place within `reach` of the middle, and no nearer than `clear` to an edge.
  Place place(Random& random, double reach, double clear) const {
    for (;;) {
      const V p = middle_ + offset(random.in(-reach, reach), random.in(-reach, reach));
      for (const std::uint32_t i : {0u, 1u}) {
        const Facet& f = facets[i];
        const V n = oracle::unit(f.normal());
        const V on = p - dot(p - f.a, n) * n;
        if (f.covers(on) && f.to_edges(on) > clear)
          return {on, dot(n, up_) > 0 ? n : Real(-1) * n, i};
      }
    }
  }
  V offset(double x, double y) const { return Real(x) * along_ + Real(y) * other_; }
  V slide(Random& random, double far) const {
    const double turn = random.in(0, 6.283185307);
    return offset(far * std::cos(turn), far * std::sin(turn));
  }
  /// 1 to 2 units above the place, and aside by anything up to `far`, so that it is seen at all
  /// angles.
  Float3 eye(Random& random, const Place& p, double far) const {
    return rounded(p.point + Real(random.in(1, 2)) * p.normal +
                   slide(random, random.log_in(1e-3, far)));
  }
  double half() const { return half_; }

  Facets facets;

 private:
  Float3 of(int x, int y) const { return rounded(middle_ + offset(x * half_, y * half_)); }

  double half_;
  V up_{0, 0, 0}, along_{0, 0, 0}, other_{0, 0, 0}, middle_{0, 0, 0};
};

/// Level and tilted grounds of each half side, a thousand rays or less each.
template <class Use>
void on_grounds(Random& random,
                std::size_t rays,
                const std::vector<double>& halves,
                const Use& use) {
  const std::size_t least = 2 * halves.size();
  const std::size_t grounds = std::max(least, rays / 1000);
  for (std::size_t i = 0; i < grounds; ++i) {
    Ground g(random, halves[i / 2 % halves.size()], i % 2 == 1);
    use(g, rays / grounds);
  }
}

/// An eye 1 to 2 above the floor, near its middle or anywhere; rays at all angles.
template <int kExponent>
void floors(Random& random, std::size_t rays, const Sink& sink) {
  on_grounds(random, rays, {std::pow(10., kExponent)}, [&](Ground& g, std::size_t count) {
    Trial trial;
    trial.scene = g.facets.scene;
    for (std::size_t i = 0; i < count; ++i) {
      const Place p = g.place(random, random.chance(.5) ? 2 : .8 * g.half(), 0);
      const Float3 eye = g.eye(random, p, 2 * g.half());
      const Float3 dir = scaled(minus(rounded(p.point), eye), random.log_in(.1, 10));
      trial.add(eye, dir, g.facets.wanted({eye, dir}, 0, kInf, kNoPrimitive));
    }
    sink(trial);
  });
}

/// The point where a ray from `eye` to `aim` hits its facet: exact, and as the renderer has it.
struct Left {
  Place place;
  Spot spot;
};
Left left_from(const Facets& facets, const World& world, const Place& aim, const Float3& eye) {
  const Float3 dir = minus(rounded(aim.point), eye);
  const Facet& f = facets[aim.id];
  const Real t = dot(f.a - V(eye), f.normal()) / dot(V(dir), f.normal());
  const oracle::Ray ray{eye, dir};
  return {{ray.point(t), aim.normal, aim.id}, spot(world, aim.id, eye, dir, static_cast<float>(t))};
}

/// Adds a ray that leaves for `to`, or a shadow ray to a light there. Its required hit is computed
/// from the exact place.
void leave_for(Trial& trial, const Facets& facets, const Left& from, const Float3& to, bool light) {
  const Float3 d = minus(to, from.spot.point);
  if (undecided(d, from.spot.normal))
    return;
  const Float3 start = from.spot.start(d);
  const Float3 dir = light ? minus(to, start) : d;
  const V exact = light ? V(to) - from.place.point : V(d);
  const Real end = light ? 1 : 1e300L;
  // A start is within an ulp of the point, and 4 ulp of it away.
  const Real coarse = 16 * oracle::kEps * largest_of(from.place.point);
  trial.add(start,
            dir,
            facets.wanted({from.place.point, exact}, coarse, end, from.place.id),
            light ? 1 : kInf);
}

/// Rays and shadow rays from a floor to a lid .001 to .02 above it, and to lights on either side of
/// the lid.
template <bool kLight>
void lids(Random& random, std::size_t rays, const Sink& sink) {
  on_grounds(random, rays, {1e2, 1e3, 1e4, 1e5, 1e6}, [&](Ground& g, std::size_t count) {
    const double reach = random.chance(.5) ? 10 : .5 * g.half();
    // If floats hardly resolve .02, the lid hangs a few hundred float steps up.
    const double gap = std::max(random.log_in(1e-3, .02), 200 * 6e-8 * reach);
    const double size = std::max(random.log_in(1, 5), 30 * gap);
    const Place foot = g.place(random, reach, size);
    const double turn = random.in(0, 6);
    const auto corner = [&](double a) {
      return rounded(foot.point + Real(gap) * foot.normal +
                     g.offset(3 * size * std::cos(a), 3 * size * std::sin(a)));
    };
    g.facets.add(corner(turn), corner(turn + 2), corner(turn + 4));
    Trial trial;
    trial.scene = g.facets.scene;
    const World world(trial.scene, {.grid = false});
    for (std::size_t i = 0; i < count; ++i) {
      Place aim = foot;
      aim.point = foot.point + g.slide(random, .2 * size);
      const Left from = left_from(g.facets, world, aim, g.eye(random, aim, size));
      const double height =
          kLight ? random.chance(.5) ? random.in(.3, .7) : random.log_in(1.5, 100) : 1;
      const V above = from.place.point + Real(height * gap) * foot.normal;
      leave_for(
          trial, g.facets, from, rounded(above + g.slide(random, random.in(0, 10) * gap)), kLight);
    }
    sink(trial);
  });
}

/// A spike of three sides on a floor.
void add_spike(Facets& facets, const Ground& g, const Place& foot, double radius, double height) {
  const Float3 tip = rounded(foot.point + Real(height) * foot.normal);
  const auto corner = [&](int i) {
    return rounded(foot.point + g.offset(radius * std::cos(2.1 * i), radius * std::sin(2.1 * i)));
  };
  for (int i = 0; i < 3; ++i)
    facets.add(corner(i), corner((i + 1) % 3), tip);
}

/// Rays and shadow rays past a twig, from the floor it stands on and from the twig itself.
template <bool kLight>
void twigs(Random& random, std::size_t rays, const Sink& sink) {
  on_grounds(random, rays, {1e2, 1e3, 1e4, 1e5, 1e6}, [&](Ground& g, std::size_t count) {
    const Place foot = g.place(random, 10, 3);
    const double radius = random.log_in(.003, .05);
    const double height = random.log_in(.2, 2);
    add_spike(g.facets, g, foot, radius, height);
    Trial trial;
    trial.scene = g.facets.scene;
    const World world(trial.scene, {.grid = false});
    const auto near_twig = [&](double up, double far) {
      return foot.point + Real(up * height) * foot.normal + g.slide(random, far);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const bool at_twig = random.chance(.3);
      const V aim = at_twig ? near_twig(random.unit(), radius * random.unit())
                            : near_twig(0, random.log_in(.01, 2));
      Place about = foot;
      about.point = aim;
      const Float3 eye = g.eye(random, about, 10);
      Place met = foot;
      if (!g.facets.first({eye, minus(rounded(aim), eye)}, met))
        continue;
      const Left from = left_from(g.facets, world, {aim, met.normal, met.id}, eye);
      const V by = near_twig(random.in(0, 1.3), 3 * radius * random.unit());
      const V to =
          from.place.point + Real(kLight ? random.log_in(.5, 50) : 1) * (by - from.place.point);
      leave_for(trial, g.facets, from, rounded(to), kLight);
    }
    sink(trial);
  });
}

/// The lower half of a ball of radius 1 about `middle`, of some 3000 triangles.
void add_bowl(Facets& facets, const Ground& g, const V& middle, const V& up) {
  constexpr int kAround = 64;
  constexpr int kRings = 24;
  constexpr double kTurn = 6.283185307;
  const auto corner = [&](int ring, int i) {
    const double down = kTurn / 4 * ring / kRings;
    const double turn = kTurn * (i % kAround) / kAround;
    const V out = g.offset(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn));
    return rounded(middle + out - Real(std::cos(down)) * up);
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      facets.add(corner(ring, i), corner(ring + 1, i), corner(ring + 1, i + 1));
      if (ring > 0)
        facets.add(corner(ring, i), corner(ring + 1, i + 1), corner(ring, i + 1));
    }
}

/// Mirror rays from what is hit in a bowl just above a ground 4000 wide, and from the ground beside
/// it.
void bowls(Random& random, std::size_t rays, const Sink& sink) {
  on_grounds(random, rays, {2e3}, [&](Ground& g, std::size_t count) {
    const Place foot = g.place(random, 10, 5);
    const V middle = foot.point + Real(1 + random.log_in(1e-3, .02)) * foot.normal;
    add_bowl(g.facets, g, middle, foot.normal);
    Trial trial;
    trial.scene = g.facets.scene;
    const World world(trial.scene, {.grid = false});
    for (std::size_t i = 0; i < count; ++i) {
      const V eye_at =
          middle + Real(random.in(.5, 4)) * foot.normal + g.slide(random, random.in(0, 2));
      const V aim =
          middle - Real(random.in(0, 1)) * foot.normal + g.slide(random, random.in(0, 1.2));
      const Float3 eye = rounded(eye_at);
      const Float3 dir = minus(rounded(aim), eye);
      Place met = foot;
      if (!g.facets.first({eye, dir}, met))
        continue;
      const Left from = left_from(g.facets, world, {aim, met.normal, met.id}, eye);
      const V mirrored = V(dir) - 2 * dot(V(dir), met.normal) * met.normal;
      leave_for(trial, g.facets, from, rounded(from.place.point + mirrored), false);
    }
    sink(trial);
  });
}

}  // namespace

std::vector<Row> floor_rows() {
  const char* const close = "t within 16u of long double";
  const char* const exact = "brute force in long double from the exact point";
  return {
      {"floor of half side 1e1",
       "two triangles, level and tilted; eye 1 to 2 above, all angles; t to 16u",
       close,
       floors<1>},
      {"floor of half side 1e3", "the same", close, floors<3>},
      {"floor of half side 1e4", "the same", close, floors<4>},
      {"floor of half side 1e5", "the same", close, floors<5>},
      {"floor of half side 1e6", "the same", close, floors<6>},
      {"lids over floors",
       "rays to a lid .001 to .02 above floors of half side 1e2 to 1e6",
       exact,
       lids<false>},
      {"lights at lids over floors",
       "shadow rays to lights before and behind such lids",
       exact,
       lids<true>},
      {"twigs on floors",
       "rays to and past a spike .003 to .05 wide on such floors",
       exact,
       twigs<false>},
      {"lights behind twigs on floors", "shadow rays to and past such spikes", exact, twigs<true>},
      {"mirror rays in a bowl on a ground",
       "a bowl of 3000 triangles, 2 wide, .001 to .02 above a ground 4000 wide",
       exact,
       bowls},
  };
}

}  // namespace grelha::stability
