// Truth by long double, and the comparison of a tracer's answers with it.
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {

using test::oracle::Ball;
using test::oracle::Facet;
using test::oracle::Ray;
using test::oracle::Real;
using test::oracle::V;

namespace {

constexpr Real kU = test::oracle::kEps;

Facet facet(const Scene& s, std::size_t i) {
  const Triangles& t = s.geometry.triangles;
  return {test::vertex(s, t.a[i]), test::vertex(s, t.b[i]), test::vertex(s, t.c[i])};
}
Ball ball(const Scene& s, std::size_t i) {
  const Spheres& b = s.geometry.spheres;
  return {V{b.x[i], b.y[i], b.z[i]}, b.radius[i]};
}

Real farthest(const Facet& f, const V& p) {
  return std::max({length(f.a - p), length(f.b - p), length(f.c - p)});
}
Real farthest(const Ball& b, const V& p) {
  return length(b.center - p) + std::abs(b.radius);
}

/// Gathers what may be hit and what must be.
class HitInterval {
 public:
  HitInterval(Real end) : end_(end) {}
  void operator()(Real from, Real to, bool certain) {
    const Real slack = 4 * kU * std::max(std::abs(from), std::abs(to));
    from -= slack;
    to += slack;
    if (to <= 0 || from >= end_)
      return;
    possible_ = true;
    earliest_ = std::min(earliest_, std::max(from, Real(0)));
    if (certain && from > 0 && to < end_) {
      certain_ = true;
      latest_ = std::min(latest_, to);
    }
  }
  Expected wanted() const {
    Expected w;
    w.hit = certain_;
    w.miss = !possible_;
    w.earliest = static_cast<double>(earliest_);
    w.latest = certain_ ? static_cast<double>(latest_) : double{test::kInf};
    return w;
  }

 private:
  Real end_, earliest_ = 1e300L, latest_ = 1e300L;
  bool possible_ = false, certain_ = false;
};

void meet(const Ball& b, const Ray& ray, Real margin, HitInterval& found) {
  const Real dd = dot(ray.dir, ray.dir), scale = std::sqrt(dd),
             foot = dot(b.center - ray.org, ray.dir) / dd;
  const Real miss = length(cross(ray.dir, b.center - ray.org)) / scale, r = std::abs(b.radius);
  const Real out = r + margin, in = r - margin;
  if (miss >= out)
    return;
  const Real outer = std::sqrt((out - miss) * (out + miss)) / scale;
  if (miss >= in)
    return found(foot - outer, foot + outer, false);
  const Real inner = std::sqrt((in - miss) * (in + miss)) / scale;
  found(foot - outer, foot - inner, true);
  found(foot + inner, foot + outer, true);
}

void meet(const Facet& f, const Ray& ray, Real margin, HitInterval& found) {
  const Real dd = dot(ray.dir, ray.dir), scale = std::sqrt(dd);
  const V middle = (Real(1) / 3) * (f.a + f.b + f.c);
  const Real radius = farthest(f, middle) + margin, foot = dot(middle - ray.org, ray.dir) / dd;
  const Real miss = length(cross(ray.dir, middle - ray.org)) / scale;
  if (miss > radius)
    return;
  const V n = f.normal();
  const Real nn = length(n), along = dot(ray.dir, n),
             half = std::sqrt((radius - miss) * (radius + miss)) / scale;
  if (std::abs(f.clearance(ray)) <= margin) {  // near an edge
    if (nn > 0 && std::abs(along) * radius > nn * scale * 4 * margin) {
      const Real t = dot(f.a - ray.org, n) / along, off = 2 * margin * nn / std::abs(along);
      return found(std::max(t - off, foot - half), std::min(t + off, foot + half), false);
    }
    return found(foot - half, foot + half, false);
  }
  if (f.clearance(ray) < 0)
    return;
  const Real t = dot(f.a - ray.org, n) / along, off = margin * nn / std::abs(along);
  found(std::max(t - off, foot - half), std::min(t + off, foot + half), true);
}

/// How far a reported hit lies beside the primitive it names, beyond what is allowed.
Real beyond(const Trial& trial, const Size& size, std::size_t i, float t, std::uint32_t id) {
  const Ray ray{trial.rays.org(i), trial.rays.dir(i)};
  const V p = ray.point(t);
  const std::size_t planes = trial.scene.geometry.planes.size(),
                    spheres = trial.scene.geometry.spheres.size();
  // planes are plane_test's
  if (id < planes || id - planes >= spheres + trial.scene.geometry.triangles.size())
    return 0;
  id -= static_cast<std::uint32_t>(planes);
  const auto excess = [&](const auto& shape) {
    return shape.distance(p) - allowed(farthest(shape, ray.org), size.diagonal, size.largest);
  };
  return id < spheres ? excess(ball(trial.scene, id)) : excess(facet(trial.scene, id - spheres));
}

enum class Verdict { kRight, kLost, kFalse, kSelf };

Verdict verdict_closest(const Trial& trial, const Size& size, std::size_t i, const Answers& a) {
  const Expected& w = trial.wanted[i];
  const float t = a.t[i];
  const std::uint32_t id = a.id[i];
  if (id == kNoPrimitive)
    return w.hit ? Verdict::kLost : Verdict::kRight;
  if (id == w.left)
    return Verdict::kSelf;
  if (w.miss || !w.traces)
    return Verdict::kFalse;
  if (!(t <= w.latest))
    return Verdict::kLost;
  if (!(t >= w.earliest) || beyond(trial, size, i, t, id) > 0)
    return Verdict::kFalse;
  return Verdict::kRight;
}

Verdict verdict_occluded(const Trial& trial, std::size_t i, const Answers& a) {
  const Expected& w = trial.wanted[i];
  const bool met = a.id[i] != kNoPrimitive;
  if (!met)
    return w.hit ? Verdict::kLost : Verdict::kRight;
  return w.miss || !w.traces ? w.left != kNoPrimitive ? Verdict::kSelf : Verdict::kFalse
                             : Verdict::kRight;
}

const char* name_of(Verdict v) {
  switch (v) {
    case Verdict::kLost:
      return "lost, ";
    case Verdict::kFalse:
      return "false, ";
    default:
      return "self-hit, ";
  }
}

/// A tracer's answers to a trial, by one of its ways.
struct Verdicts {
  const Trial& trial;
  const Size& size;
  const Answers& answers;
  bool any;

  Verdict of(std::size_t i) const {
    return any ? verdict_occluded(trial, i, answers) : verdict_closest(trial, size, i, answers);
  }
  std::string describe(std::size_t i, Verdict v) const;
  Counts count(const std::string& way) const;
};

std::string Verdicts::describe(std::size_t i, Verdict v) const {
  const Expected& w = trial.wanted[i];
  const float t = answers.t[i];
  const std::uint32_t id = answers.id[i];
  std::ostringstream s;
  s << (any ? ", occluded: " : ", closest: ") << name_of(v) << trial.rays.describe(i)
    << std::defaultfloat << "; t " << t << " id " << static_cast<std::int32_t>(id) << ", expected "
    << (w.hit    ? "hit"
        : w.miss ? "miss"
                 : "either")
    << " in [" << w.earliest << ", " << w.latest << "]";
  if (!any && id != kNoPrimitive)
    s << ", beside it by " << static_cast<double>(beyond(trial, size, i, t, id)) << " too much";
  return s.str();
}

Counts Verdicts::count(const std::string& way) const {
  Counts counts;
  counts.answers = trial.rays.size();
  for (std::size_t i = 0; i < trial.rays.size(); ++i) {
    const Verdict v = of(i);
    if (v == Verdict::kRight)
      continue;
    ++(v == Verdict::kLost ? counts.lost : v == Verdict::kFalse ? counts.false_ : counts.self);
    if (counts.first.empty())
      counts.first = way + describe(i, v);
  }
  return counts;
}

}  // namespace

Real allowed(Real distance, Real diagonal, Real largest) {
  return 64 * kU * std::min(distance, 4 * diagonal) + 2 * kU * distance +
         (distance > diagonal ? 8 * kU * largest : 0);
}

Size size_of(const Scene& scene) {
  const Spheres& s = scene.geometry.spheres;
  const Triangles& t = scene.geometry.triangles;
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  const auto add = [&](double x, double y, double z, double r) {
    const double p[3] = {x, y, z};
    if (!std::isfinite(x + y + z))
      return;
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a] - r);
      hi[a] = std::max(hi[a], p[a] + r);
    }
  };
  for (std::size_t i = 0; i < s.size(); ++i)
    add(s.x[i], s.y[i], s.z[i], std::abs(s.radius[i]));
  for (std::size_t i = 0; i < t.vertex_count(); ++i)
    add(t.x[i], t.y[i], t.z[i], 0);
  Size out;
  if (lo[0] > hi[0])
    return out;
  for (int a = 0; a < 3; ++a)
    out.largest = std::max({out.largest, std::abs(lo[a]), std::abs(hi[a])});
  out.diagonal = std::hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
  return out;
}

Expected brute_force(
    const Scene& scene, const Size& size, const Float3& org, const Float3& dir, float end) {
  const Ray ray{org, dir};
  HitInterval found(end);
  for (std::size_t i = 0; i < scene.geometry.spheres.size(); ++i) {
    const Ball b = ball(scene, i);
    meet(b, ray, allowed(farthest(b, ray.org), size.diagonal, size.largest), found);
  }
  for (std::size_t i = 0; i < scene.geometry.triangles.size(); ++i) {
    const Facet f = facet(scene, i);
    meet(f, ray, allowed(farthest(f, ray.org), size.diagonal, size.largest), found);
  }
  return found.wanted();
}

Counts judge(Tracer& tracer, const Trial& trial) {
  Counts counts;
  const Size size = size_of(trial.scene);
  tracer.build(trial);
  for (int way = 0; way < tracer.ways(); ++way)
    for (int any = 0; any < (trial.occlusion ? 2 : 1); ++any) {
      const Answers a = any ? tracer.occluded(trial.rays, way) : tracer.closest(trial.rays, way);
      const Verdicts all{trial, size, a, any != 0};
      counts += all.count(tracer.way_name(way));
    }
  return counts;
}

Counts run(const Row& row, Tracer& tracer, std::size_t rays, std::uint64_t seed) {
  Counts counts;
  Random random(seed);
  row.make(random, rays, [&](const Trial& trial) { counts += judge(tracer, trial); });
  return counts;
}

std::vector<Row> all_rows() {
  std::vector<Row> all;
  for (const auto& part :
       {mesh_rows(), sphere_rows(), floor_rows(), walk_rows(), contact_rows(), point_light_rows()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace grelha::stability
