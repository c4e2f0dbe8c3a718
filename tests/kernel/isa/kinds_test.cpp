// Each kind of primitive, however it lies and wherever rays start, by each
// instruction set against long double: all crossings of a ray, found by walking on from each to the
// next.
#include "grelha/query.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

using oracle::V;

/// A primitive, its twins a hundredth larger and smaller, and how large it is.
struct Body {
  Scene scene = empty_scene();
  std::vector<std::function<std::optional<oracle::Crossing>(const oracle::Ray&, oracle::Real)>>
      twins;  ///< itself, the larger, the smaller: the next crossing beyond a t
  std::function<oracle::Real(const V&)> distance;
  V middle{0, 0, 0};
  double size = 1;
  V along{0, 0, 1};           ///< a direction that rays may run along
  oracle::Real prepared = 0;  ///< by how much what is tested is off, in scene units
};

template <class Shape>
void add_twins(Body& body, const Shape& itself, const Shape& larger, const Shape& smaller) {
  for (const Shape& shape : {itself, larger, smaller})
    body.twins.push_back(
        [shape](const oracle::Ray& ray, oracle::Real t_min) { return shape.first(ray, t_min); });
  body.distance = [itself](const V& p) { return itself.distance(p); };
}

Body sphere(Random& random, const Float3& center, double size) {
  Body body;
  const float radius = static_cast<float>((random.chance(.2) ? -1 : 1) * size);
  body.scene.geometry.spheres.add(center, radius, 0);
  add_twins<oracle::Ball>(
      body, {center, radius}, {center, 1.01L * radius}, {center, .99L * radius});
  return body;
}

Body triangle(Random& random, const Float3& center, double size) {
  Body body;
  const Float3 corner[3] = {at(center, size, random.direction()),
                            at(center, size, random.direction()),
                            at(center, size, random.direction())};
  add_triangle(body.scene, corner[0], corner[1], corner[2]);
  const V middle = oracle::Real(1) / 3 * (V(corner[0]) + V(corner[1]) + V(corner[2]));
  const auto grown = [&](oracle::Real by) {
    const auto moved = [&](const V& v) { return middle + by * (v - middle); };
    return oracle::Facet{moved(corner[0]), moved(corner[1]), moved(corner[2])};
  };
  add_twins<oracle::Facet>(body, grown(1), grown(1.01L), grown(.99L));
  return body;
}

/// Cylinders, tips, frusta and flat collars, one in five along an axis of coordinates.
Body cone(Random& random, const Float3& center, double size) {
  Body body;
  const Float3 axis = random.chance(.2) ? Float3{0, 0, 1} : random.direction();
  const double height = size * random.log_in(.05, 4);
  const int form = static_cast<int>(random.below(3));
  const float r0 = static_cast<float>(size);
  const float r1 = form == 0 ? r0 : form == 1 ? 0 : static_cast<float>(size * random.unit());
  const Float3 apex = at(center, height, axis);
  const float side = random.chance(.2) ? -1.f : 1.f;
  body.scene.geometry.cones.add(center, side * r0, apex, side * r1, 0);
  const V a(center), b(apex);
  const auto grown = [&](oracle::Real by) {
    const oracle::Real longer = by * std::min<oracle::Real>(1, size / height);
    const V more = longer * (b - a);
    return oracle::Frustum{a - more, b + more, side * (r0 + by * size), side * (r1 + by * size)};
  };
  add_twins<oracle::Frustum>(body, grown(0), grown(.01L), {a, b, side * r0, side * r1});
  body.along = V(axis);
  body.prepared = 8 * oracle::kEps * (height + size);
  return body;
}

Body plane(Random& random, const Float3& center, double) {
  Body body;
  const Float3 normal = scaled(random.direction(), random.log_in(1e-3, 1e3));
  body.scene.geometry.planes.add(center, normal, 0);
  const oracle::Sheet sheet{center, normal};
  add_twins<oracle::Sheet>(body, sheet, sheet, sheet);
  return body;
}

/// Crossings of a ray from t_min on; none where the twins do not agree or one is hard to tell.
std::optional<std::vector<oracle::Crossing>> crossings(const Body& body,
                                                       const oracle::Ray& ray,
                                                       oracle::Real t_min) {
  std::vector<oracle::Crossing> all[3];
  for (std::size_t twin = 0; twin < 3; ++twin) {
    oracle::Real from = t_min;
    while (const auto next = body.twins[twin](ray, from)) {
      if (next->cosine < .05L || all[twin].size() == 2)
        return {};
      all[twin].push_back(*next);
      from = next->t * (1 + 1e-16L);
    }
  }
  if (all[0].size() != all[1].size() || all[0].size() != all[2].size())
    return {};
  return all[0];
}

struct KindCase {
  const char* name;
  Body (*make)(Random&, const Float3&, double);
  double units;       ///< u of the largest way that surrounds a hit, which is what it may be off by
  int fewest_second;  ///< rays that hit it twice
};

void PrintTo(const KindCase& kind, std::ostream* out) {
  *out << kind.name;
}

class Kinds : public testing::TestWithParam<std::tuple<const Variant*, KindCase>> {
 protected:
  const Variant& variant() const { return *std::get<0>(GetParam()); }
  const KindCase& kind() const { return std::get<1>(GetParam()); }
  void SetUp() override {
    if (!variant().is_supported())
      GTEST_SKIP() << "this processor lacks " << variant().name;
  }
  /// Returns t of the first hit beyond t_min; NaN without a hit.
  float next_hit(const World& world, const Ray& ray) const {
    const Hit hit = variant().loops.closest_one(world.impl().view, ray, nullptr);
    return hit ? hit.t : kNaN;
  }
};

/// Rays at a body, from outside and inside, from next to it, along its axis and nearly so; of
/// lengths from 1e-18 to 1e18.
Ray ray_at(Random& random, const Body& body) {
  const auto point = [&](const V& v) {
    return Float3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  const Float3 middle = point(body.middle);
  const Float3 aim = at(middle, body.size * random.in(0, 1.2), random.direction());
  Float3 dir = random.direction();
  const double away = random.chance(.3) ? 1 + random.log_in(1e-3, .1) : random.log_in(.1, 1.5);
  Ray ray{at(middle, body.size * away, random.direction()), {}};
  dir = minus(aim, ray.org);
  if (random.chance(.2)) {
    const double aside = random.chance(.5) ? 0 : random.log_in(1e-30, 1e-2);
    dir = at(point(body.along), aside, random.direction());
    ray.org = at(aim, -body.size * away, point(body.along));
  }
  const auto length = static_cast<double>(oracle::length(dir));
  const double way = body.size * random.log_in(1e-21, 1e17);  // so that t is a normal float
  ray.dir = scaled(dir, std::clamp(way, 1e-18, 1e18) / length);
  return ray;
}

std::string describe(std::uint64_t seed, int i, const Ray& ray) {
  std::ostringstream s;
  s << "seed " << seed << ", ray " << i << std::hexfloat;
  for (const float x :
       {ray.org.x, ray.org.y, ray.org.z, ray.dir.x, ray.dir.y, ray.dir.z, ray.t_min})
    s << ' ' << x;
  s << ": ";
  return s.str();
}

TEST_P(Kinds, AreMetAtEachCrossing) {
  int judged = 0, second = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    const double size = random.log_in(1e-22, 1e15);
    const Float3 center =
        random.chance(.5) ? Float3{} : at({}, size * random.log_in(.1, 1e3), random.direction());
    Body body = kind().make(random, center, size);
    body.middle = V(center);
    body.size = size;
    const World world(body.scene, {});
    for (int i = 0; i < 50; ++i) {
      Ray ray = ray_at(random, body);
      const oracle::Ray line{ray.org, ray.dir};
      const oracle::Real extent = length(line.org - body.middle) + 4 * size;
      const oracle::Real unit = oracle::kEps;
      // planes' and triangles' own numbers are taken as they are, those of cones once rounded
      const oracle::Real error = kind().units * unit * extent + body.prepared;
      const auto expected = crossings(body, line, 0);
      if (!expected || body.distance(line.org) < 100 * oracle::kEps * extent + error)
        continue;
      ++judged;
      second += expected->size() == 2;
      for (const oracle::Crossing& truth : *expected) {
        const float found = next_hit(world, ray);
        ASSERT_LE(std::abs(found - truth.t) * length(line.dir),
                  error / truth.cosine + unit * truth.t * length(line.dir))
            << describe(seed, i, ray) << "found " << found << ", expected "
            << static_cast<double>(truth.t);
        ray.t_min = std::nextafter(found, kInf);
      }
      const float t = next_hit(world, ray);
      ASSERT_TRUE(std::isnan(t)) << "seed " << seed << ", ray " << i << " meets something at " << t
                                 << " after " << expected->size();
    }
  }
  EXPECT_GT(judged, 4000);
  EXPECT_GE(second, kind().fewest_second);
}

const auto kVariants = testing::ValuesIn(variants().begin(), variants().end());
const auto kKinds = testing::Values(KindCase{"sphere", sphere, 8, 4000},
                                    KindCase{"triangle", triangle, 46, 0},
                                    KindCase{"cone", cone, 34, 200},
                                    KindCase{"plane", plane, 24, 0});
std::string name_of(const testing::TestParamInfo<Kinds::ParamType>& p) {
  return std::string(std::get<0>(p.param)->name) + "_" + std::get<1>(p.param).name;
}
INSTANTIATE_TEST_SUITE_P(Isa, Kinds, testing::Combine(kVariants, kKinds), name_of);

}  // namespace
}  // namespace grelha::test
