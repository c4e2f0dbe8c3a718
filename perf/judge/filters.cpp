#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "kernel/shapes/triangle.hpp"
#include "perf/judge/hard_rays.hpp"

namespace grelha::perf {
namespace {

/// Rays for which some triangle up to the first hit is not decided by floats, by doubles; and those
/// whose first two hits only exact numbers put in order.
struct Leaving {
  std::size_t rays = 0, floats = 0, doubles = 0, order = 0;
};

struct Candidate {
  double lo, hi;
  bool by_floats, by_doubles, hit;
};

ExactRay exact(const Ray& r) {
  return {{r.org.x, r.org.y, r.org.z}, {r.dir.x, r.dir.y, r.dir.z}, r.t_min, r.t_max};
}

/// Every triangle tested by one ray; from afar in a frame of the mesh, as grids do.
class AllTests {
 public:
  AllTests(const MovedMesh& m, const Ray& ray)
      : ray_(exact(ray)), k_(scalar::largest_axis(ray.dir.x, ray.dir.y, ray.dir.z)) {
    enter(m);
    dir_ = turned(ray_.dir);
    shear_ = {dir_.x / dir_.z, dir_.y / dir_.z, 1 / dir_.z, frame_error_};
    const Triangles& t = m.scene.geometry.triangles;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const std::uint32_t v[3] = {t.a[i], t.b[i], t.c[i]};
      float corner[3][3];
      for (int k = 0; k < 3; ++k) {
        corner[k][0] = t.x[v[k]];
        corner[k][1] = t.y[v[k]];
        corner[k][2] = t.z[v[k]];
      }
      add(corner);
    }
  }

  void count(Leaving& sum) const {
    double first = std::numeric_limits<double>::infinity();
    for (const Candidate& c : candidates_)
      first = c.hit ? std::min(first, c.hi) : first;
    bool floats = false, doubles = false;
    int near = 0;
    for (const Candidate& c : candidates_) {
      if (c.lo > first)
        continue;
      floats |= !c.by_floats;
      doubles |= !c.by_doubles;
      near += c.hit;
    }
    ++sum.rays;
    sum.floats += floats;
    sum.doubles += doubles;
    sum.order += near > 1;
  }

 private:
  /// A ray from afar starts a diagonal before the middle of the mesh.
  void enter(const MovedMesh& m) {
    const double middle[3] = {m.middle.x, m.middle.y, m.middle.z};
    double along = 0, squares = 0;
    for (int a = 0; a < 3; ++a) {
      along += (middle[a] - ray_.org[a]) * ray_.dir[a];
      squares += ray_.dir[a] * ray_.dir[a];
    }
    const double t = along / squares - m.diagonal / std::sqrt(squares);
    double org[3] = {ray_.org[0], ray_.org[1], ray_.org[2]};
    if (t * std::sqrt(squares) > m.diagonal) {
      shift_ = t;
      frame_error_ = static_cast<float>(8 * 0x1p-24 * m.diagonal);
      for (int a = 0; a < 3; ++a) {
        base_[a] = static_cast<float>(middle[a]);
        org[a] += t * ray_.dir[a] - base_[a];
      }
    }
    org_ = turned(org);
  }

  template <class T>
  scalar::Vec3<float> turned(const T& v) const {
    return {static_cast<float>(v[scalar::kNextAxis[k_]]),
            static_cast<float>(v[scalar::kPreviousAxis[k_]]),
            static_cast<float>(v[k_])};
  }

  void add(const float (&corner)[3][3]) {
    const scalar::RayAndTriangle<float> from{
        org_, dir_, {turned(corner[0]), turned(corner[1]), turned(corner[2])}};
    const auto by_floats =
        scalar::bound_triangle<float>(from, shear_, 0.f, std::numeric_limits<float>::infinity());
    if (!by_floats.some)
      return;
    Candidate c{by_floats.lo, by_floats.hi, by_floats.sure, true, true};
    if (!by_floats.sure) {
      const auto by_doubles = scalar::bound_triangle(ray_, corner);
      c.by_doubles = by_doubles.sure || !by_doubles.some;
      const CrossingSpan span = triangle_span(ray_, corner, shift_);
      c.hit = span.hi == span.hi;
      if (c.hit) {
        c.lo = span.lo;
        c.hi = span.hi;
      }
    }
    candidates_.push_back(c);
  }

  ExactRay ray_;
  int k_;
  double shift_ = 0;  ///< t from the ray's origin to the frame's
  float base_[3] = {}, frame_error_ = 0;
  scalar::Vec3<float> org_, dir_;
  scalar::Shear<float> shear_;
  std::vector<Candidate> candidates_;
};

Leaving leaving(const MovedMesh& m, int kind, double away, std::size_t count) {
  Leaving sum;
  test::Random random(7 + static_cast<std::uint64_t>(kind));
  for (std::size_t i = 0; i < count; ++i)
    AllTests(m, ray_of(m, kind, away, random)).count(sum);
  return sum;
}

/// A mesh and its place among the rows.
struct Row {
  const char* mesh;
  double moved, away, scale;
};

void tell(const Row& row, const char* kind, const Leaving& l) {
  const auto share = [&](std::size_t n) {
    return 100 * static_cast<double>(n) / static_cast<double>(l.rays);
  };
  std::printf("%s,%g,%g,%g,%s,%.2f,%.2f,%.2f\n",
              row.mesh,
              row.scale,
              row.moved,
              row.away,
              kind,
              share(l.floats),
              share(l.doubles),
              share(l.order));
  std::fflush(stdout);
}

Scene scaled(Scene s, double by) {
  Triangles& t = s.geometry.triangles;
  for (auto* axis : {&t.x, &t.y, &t.z})
    for (float& x : *axis)
      x = static_cast<float>(x * by);
  return s;
}

}  // namespace

std::size_t count_filters(const JudgeOptions& options) {
  std::printf("# %zu rays a row\n", options.count);
  std::printf("mesh,scale,moved,eye,kind,floats,doubles,order\n");
  constexpr Row kPlaces[] = {{"", 0, .8, 1},
                             {"", 0, 1e4, 1},
                             {"", 1e3, .8, 1},
                             {"", 1e6, .8, 1},
                             {"", 0, .8, 1e-15},
                             {"", 0, .8, 1e15}};
  for (const Mesh& mesh : hard_meshes(options))
    for (Row row : kPlaces) {
      row.mesh = mesh.name.c_str();
      const MovedMesh m = moved(scaled(mesh.scene, row.scale), row.moved);
      for (int kind = 0; kind < kKindCount; ++kind)
        tell(row, kKinds[kind], leaving(m, kind, row.away, options.count));
    }
  return 0;
}

}  // namespace grelha::perf
