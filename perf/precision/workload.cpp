#include "perf/precision/workload.hpp"

#include <cmath>

namespace grelha::perf {
namespace {

__extension__ typedef __float128 Quad;

/// Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double unit() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  double between(double a, double b) { return a + (b - a) * unit(); }
  int below(int n) { return static_cast<int>(unit() * n); }

 private:
  std::uint64_t state_;
};

struct V {
  double x[3];
};
V operator+(const V& a, const V& b) {
  return {{a.x[0] + b.x[0], a.x[1] + b.x[1], a.x[2] + b.x[2]}};
}
V operator-(const V& a, const V& b) {
  return {{a.x[0] - b.x[0], a.x[1] - b.x[1], a.x[2] - b.x[2]}};
}
V operator*(double s, const V& a) {
  return {{s * a.x[0], s * a.x[1], s * a.x[2]}};
}
V rounded(const V& a) {
  return {{double(float(a.x[0])), double(float(a.x[1])), double(float(a.x[2]))}};
}
V direction(Random& r) {
  for (;;) {
    const V v{{r.between(-1, 1), r.between(-1, 1), r.between(-1, 1)}};
    const double d = v.x[0] * v.x[0] + v.x[1] * v.x[1] + v.x[2] * v.x[2];
    if (d > .01 && d <= 1)
      return 1 / std::sqrt(d) * v;
  }
}
int major(const V& v) {
  const double a[3] = {std::abs(v.x[0]), std::abs(v.x[1]), std::abs(v.x[2])};
  return a[0] >= a[1] && a[0] >= a[2] ? 0 : a[1] >= a[2] ? 1 : 2;
}

void add(std::vector<float> (&to)[3], const V& v) {
  for (int a = 0; a < 3; ++a)
    to[a].push_back(static_cast<float>(v.x[a]));
}

struct Corners {
  V a, b, c;
};

/// As long as twice the size, and `thin` times that wide.
Corners triangle_at(const V& at, double size, double thin, Random& r) {
  const V along = direction(r);
  const V a = rounded(at + size * along), b = rounded(at - size * along);
  return {a, b, rounded(at + size * thin * direction(r))};
}

/// Sixteen triangles, their sizes between .001 and 1 of their distance and up to `longest` times as
/// long as wide, each with a ray aimed at a point within it.
void add_random_group(Pairs& p, Random& r, double longest) {
  const V eye = std::exp2(r.between(-3, 3)) * direction(r);
  const int axis = r.below(3);
  for (int i = 0; i < kGroup;) {
    const V way = direction(r);
    const double far = std::exp2(r.between(-4, 4)), size = far * std::exp2(r.between(-10, 0)),
                 thin = std::exp2(-r.between(0, std::log2(longest)));
    const Corners k = triangle_at(eye + far * way, size, thin, r);
    double u = r.between(.01, .99), v = r.between(.01, .99);
    if (u + v > .99) {
      u = 1 - u;
      v = 1 - v;
    }
    if (u + v > .99)
      continue;
    const V place = k.a + u * (k.b - k.a) + v * (k.c - k.a);
    const V dir = rounded((1 / far) * (place - rounded(eye)));
    if (major(dir) != axis)
      continue;
    add(p.org, eye);
    add(p.dir, dir);
    add(p.a, k.a);
    add(p.b, k.b);
    add(p.c, k.c);
    ++i;
  }
  p.axis.push_back(static_cast<std::uint8_t>(axis));
}

/// A double pyramid of eight corners, and a place within.
struct Hull {
  V ring[8], top, bottom, eye;
};

Hull hull_of(Random& r) {
  const double size = std::exp2(r.between(-6, 6));
  const V middle = std::exp2(r.between(-3, 3)) * direction(r);
  Hull h;
  h.top = rounded(middle + size * V{{r.between(-.1, .1), r.between(-.1, .1), r.between(.5, 1)}});
  h.bottom = rounded(middle - size * V{{r.between(-.1, .1), r.between(-.1, .1), r.between(.5, 1)}});
  for (int i = 0; i < 8; ++i) {
    const double angle = (i + r.between(-.2, .2)) * .78539816, wide = size * r.between(.7, 1);
    h.ring[i] = rounded(
        middle + V{{wide * std::cos(angle), wide * std::sin(angle), size * r.between(-.2, .2)}});
  }
  h.eye = rounded(middle + size * r.between(0, .1) * direction(r));
  return h;
}

/// A corner, or a point of an edge.
V aim_at(const Hull& h, Random& r) {
  const int n = r.below(8);
  const V& tip = r.below(2) == 0 ? h.top : h.bottom;
  const V& a = h.ring[n];
  const V& b = r.below(2) == 0 ? tip : h.ring[(n + 1) % 8];
  const int kind = r.below(3);
  const double s = kind == 0 ? 0 : kind == 1 ? .5 : r.unit();
  return a + s * (b - a);
}

/// A hull around the rays' origin, and sixteen rays at its corners and points of its edges.
void add_hull_group(Pairs& p, Random& r) {
  const Hull h = hull_of(r);
  const int axis = r.below(3);
  for (int i = 0; i < kGroup;) {
    const V dir = rounded(aim_at(h, r) - h.eye);
    if (major(dir) != axis)
      continue;
    add(p.org, h.eye);
    add(p.dir, dir);
    ++i;
  }
  for (int i = 0; i < 8; ++i)
    for (const V& tip : {h.top, h.bottom}) {
      add(p.a, h.ring[i]);
      add(p.b, h.ring[(i + 1) % 8]);
      add(p.c, tip);
    }
  p.axis.push_back(static_cast<std::uint8_t>(axis));
}

struct Q {
  Quad x[3];
};
Q difference(const std::vector<float> (&a)[3],
             std::size_t i,
             const std::vector<float> (&b)[3],
             std::size_t j) {
  return {{Quad(a[0][i]) - b[0][j], Quad(a[1][i]) - b[1][j], Quad(a[2][i]) - b[2][j]}};
}
Quad volume(const Q& a, const Q& b, const Q& c) {
  return a.x[0] * (b.x[1] * c.x[2] - b.x[2] * c.x[1]) +
         a.x[1] * (b.x[2] * c.x[0] - b.x[0] * c.x[2]) +
         a.x[2] * (b.x[0] * c.x[1] - b.x[1] * c.x[0]);
}

/// Exact: t at which ray i crosses triangle j, edges included; negative: it does not.
double crossing(const Pairs& p, std::size_t i, std::size_t j) {
  const Q d{{p.dir[0][i], p.dir[1][i], p.dir[2][i]}};
  const Q a = difference(p.a, j, p.org, i);
  const Q b = difference(p.b, j, p.org, i);
  const Q c = difference(p.c, j, p.org, i);
  const Quad u = volume(d, b, c), v = volume(d, c, a), w = volume(d, a, b), det = u + v + w;
  if (det == 0 || ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)))
    return -1;
  return static_cast<double>(volume(a, b, c) / det);
}

Truth truth_of(const Pairs& p) {
  Truth out;
  for (std::size_t i = 0; i < p.org[0].size(); ++i) {
    double t = 1e30;
    int which = -1;
    for (int k = 0; k < kGroup; ++k)
      if (const double here = crossing(p, i, i / kGroup * kGroup + static_cast<std::size_t>(k));
          here > 0 && here < t) {
        t = here;
        which = k;
      }
    out.t.push_back(t);
    out.triangle.push_back(which);
  }
  return out;
}

}  // namespace

Workload::Workload(int groups) {
  Random r(1);
  for (int i = 0; i < groups; ++i) {
    add_random_group(random, r, 1000);
    add_hull_group(hulls, r);
    add_random_group(timed, r, 4);
  }
  truth = truth_of(random);
}

}  // namespace grelha::perf
