// Nothing falls between two triangles: closed bodies, slivers, small triangles from afar.
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/support/closed.hpp"

namespace grelha::stability {
namespace {

using namespace test;

enum class At { kVertices, kMiddles, kAlong };

const std::vector<Float3>& pick(const Aims& aims, At at) {
  return at == At::kVertices ? aims.vertices : at == At::kMiddles ? aims.middles : aims.along;
}

struct Body {
  Scene scene;
  bool torus;
};

/// Triangles that name their own copies of the corners, in another order.
Scene unshared(const Scene& shared) {
  Scene scene = empty_scene();
  const Triangles& t = shared.geometry.triangles;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Float3 v[3] = {vertex(shared, t.a[i]), vertex(shared, t.b[i]), vertex(shared, t.c[i])};
    add_triangle(scene, v[i % 3], v[(i + 1) % 3], v[(i + 2) % 3]);
  }
  return scene;
}

const std::vector<Body>& bodies() {
  static const std::vector<Body> all{{ball_mesh(50, 25), false},
                                     {ball_mesh(16, 16, .15), false},
                                     {ball_mesh(5, 3), false},
                                     {unshared(ball_mesh(24, 12, .1)), false},
                                     {torus_mesh(40, 20, kTube), true}};
  return all;
}

/// The first wall on the way from inside is hit, and from outside no later than shortly after the
/// aim.
void closed(Random& random,
            std::size_t rays,
            const Sink& sink,
            const Body& body,
            At what,
            double scale,
            const Float3& offset) {
  const Aims aims = aims_at(body.scene, random);
  const std::vector<Float3>& targets = pick(aims, what);
  Trial trial;
  trial.scene = placed(body.scene, scale, offset);
  const auto place = [&](const Float3& p) { return at(offset, scale, p); };
  Expected w;
  w.hit = true;
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3& aim = targets[random.below(static_cast<std::uint32_t>(targets.size()))];
    const Float3 to = place(aim);
    if (i % 2 == 0) {
      const Float3 org = place(inside(random, aim, body.torus));
      const double k = random.log_in(.1, 10);
      // Bumps may stand in the way; a leak goes on to the far side of the tube or out of
      // everything.
      w.latest = 1.2 / k;
      trial.add(org, scaled(minus(to, org), k), w);
    } else {
      const Float3 eye = place(outside(random, aim, body.torus));
      w.latest = 1.2;
      trial.add(eye, minus(to, eye), w);
    }
  }
  sink(trial);
}

/// So many rays in pieces, each at another body of the list, place and size.
void closed_somewhere(Random& random,
                      std::size_t rays,
                      const Sink& sink,
                      At what,
                      double least,
                      double most,
                      double offset) {
  const std::size_t pieces = std::max<std::size_t>(bodies().size(), rays / 20000);
  for (std::size_t i = 0; i < pieces; ++i) {
    const double scale = random.log_in(least, most);
    const Float3 place = offset > 0 ? scaled({1, -.013f, 1.5f}, offset) : Float3{};
    closed(random, rays / pieces, sink, bodies()[i % bodies().size()], what, scale, place);
  }
}

template <At kWhat>
void aimed(Random& random, std::size_t rays, const Sink& sink) {
  closed_somewhere(random, rays, sink, kWhat, 1, 1, 0);
}
template <int kExponent>
void sized(Random& random, std::size_t rays, const Sink& sink) {
  const double size = std::pow(10., kExponent);
  for (const At what : {At::kVertices, At::kMiddles, At::kAlong})
    closed_somewhere(random, rays / 3, sink, what, size, size, 0);
}
template <int kExponent>
void moved(Random& random, std::size_t rays, const Sink& sink) {
  for (const At what : {At::kVertices, At::kMiddles, At::kAlong})
    closed_somewhere(random, rays / 3, sink, what, 2, 2, std::pow(10., kExponent));
}

/// A body whose triangles are a thousand times as long as wide.
void slivers(Random& random, std::size_t rays, const Sink& sink) {
  static const Body body{ball_mesh(4000, 4), false};
  for (const At what : {At::kVertices, At::kMiddles, At::kAlong})
    closed(random, rays / 3, sink, body, what, 1, {});
}

/// Loose slivers of all widths among each other, hit by rays as little as a ten-thousandth of a
/// radian off their planes.
void grazed(Random& random, std::size_t rays, const Sink& sink) {
  const std::size_t pieces = std::max<std::size_t>(1, rays / 2000);
  for (std::size_t k = 0; k < pieces; ++k) {
    Trial trial;
    trial.scene = empty_scene();
    constexpr int kCount = 60;
    std::vector<Float3> middle, along, normal;
    for (int i = 0; i < kCount; ++i) {
      const Float3 a = random.point(10), d = random.direction(), e = random.direction();
      const double length = random.log_in(.1, 10), width = length * random.log_in(1e-5, .3);
      const Float3 b = at(a, length, d), c = at(at(a, length * random.unit(), d), width, e);
      add_triangle(trial.scene, a, b, c);
      middle.push_back(scaled({a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z}, 1. / 3));
      along.push_back(d);
      const oracle::V n = oracle::cross(d, e);
      const oracle::V u = oracle::unit(n);
      normal.push_back({static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)});
    }
    const Size size = size_of(trial.scene);
    for (std::size_t i = 0; i < rays / pieces; ++i) {
      const std::uint32_t s = random.below(kCount);
      const double angle = random.log_in(1e-4, 1), away = random.log_in(.1, 600),
                   turn = random.in(0, 6.283185307);
      const oracle::V other = oracle::cross(along[s], normal[s]);
      const Float3 across{
          static_cast<float>(other.x), static_cast<float>(other.y), static_cast<float>(other.z)};
      const Float3 in_plane = at(scaled(along[s], std::cos(turn)), std::sin(turn), across);
      const Float3 org = at(at(middle[s], away * std::cos(angle), in_plane),
                            away * std::sin(angle) * random.sign(),
                            normal[s]);
      const Float3 dir = minus(middle[s], org);
      trial.add(org, dir, brute_force(trial.scene, size, org, dir));
    }
    sink(trial);
  }
}

/// A rough sheet of 20,000 triangles with edges of 1, seen from up to a million away: it is hit,
/// and the triangle named lies where the exact ray comes down.
void far_small(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = empty_scene();
  constexpr int kSide = 100;
  for (int z = 0; z < kSide; ++z)
    for (int x = 0; x < kSide; ++x) {
      const float a = static_cast<float>(x - kSide / 2), b = static_cast<float>(z - kSide / 2);
      add_triangle(trial.scene, {a, 0, b}, {a + 1, 0, b}, {a + 1, 0, b + 1});
      add_triangle(trial.scene, {a, 0, b}, {a + 1, 0, b + 1}, {a, 0, b + 1});
    }
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3 aim{
        static_cast<float>(random.in(-45, 45)), 0, static_cast<float>(random.in(-45, 45))};
    Float3 up = random.direction();
    up.y = std::abs(up.y) + .5f;
    const Float3 org = at(aim, random.log_in(1, 1e6), up), dir = minus(aim, org);
    Expected w;
    w.hit = true;
    const oracle::Real t = -oracle::Real(org.y) / dir.y;  // exact but for one rounding of 64 bits
    const oracle::Real d = oracle::length(dir),
                       off = 2 * allowed(d * t, 142, 50) / std::abs(oracle::Real(dir.y));
    w.earliest = static_cast<double>(t - off);
    w.latest = static_cast<double>(t + off);
    const oracle::Ray ray{org, dir};
    const oracle::V p = ray.point(t);
    // the floats of ray and aim are too coarse to stay on the sheet
    if (std::abs(p.x) > 49 || std::abs(p.z) > 49)
      continue;
    trial.add(org, dir, w);
  }
  sink(trial);
}

}  // namespace

std::vector<Row> mesh_rows() {
  return {
      {"vertices of closed meshes",
       "rays aimed exactly at vertices, from inside and outside",
       "a wall is met no later than behind the aim",
       aimed<At::kVertices>},
      {"middles of edges", "the same, at the middles of edges", "the same", aimed<At::kMiddles>},
      {"anywhere on edges", "the same, at random points of edges", "the same", aimed<At::kAlong>},
      {"closed meshes of size 1e-6", "vertices, middles and edges", "the same", sized<-6>},
      {"closed meshes of size 1e6", "vertices, middles and edges", "the same", sized<6>},
      {"closed meshes moved by 1e3", "size 2", "the same", moved<3>},
      {"closed meshes moved by 1e4", "size 2", "the same", moved<4>},
      {"closed meshes moved by 1e5", "size 2", "the same", moved<5>},
      {"closed meshes moved by 1e6", "size 2: 32 ulp across", "the same", moved<6>},
      {"closed slivers", "triangles a thousand times as long as wide", "the same", slivers},
      {"slivers, grazed",
       "widths down to 1e-5 of the length, angles down to 1e-4",
       "brute force in long double",
       grazed},
      {"small triangles from far",
       "edges of 1 from up to 1e6 away",
       "the exact crossing of their plane",
       far_small},
  };
}

}  // namespace grelha::stability
