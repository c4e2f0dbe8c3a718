// Hit or miss, which triangle and t are those of rational numbers (GMP), whatever the mesh, however
// rays are aimed and from wherever they come.
#include "grelha/query.hpp"
#include "tests/support/hard_meshes.hpp"
#include "tests/support/rational.hpp"
#include "tests/support/rays.hpp"

namespace grelha::test {
namespace {

/// Triangles in three planes of whole numbers, over one another.
Scene coplanar_triangles(std::uint64_t seed, int n) {
  Random random(seed);
  Scene s = empty_scene();
  const auto whole = [&] { return static_cast<float>(random.below(9)); };
  for (int i = 0; i < n; ++i) {
    const float y = static_cast<float>(i % 3);
    add_triangle(s, {whole(), y, whole()}, {whole(), y, whole()}, {whole(), y, whole()});
  }
  return s;
}

/// Each triangle's vertices are its own, so that they are aimed at as they lie.
struct Mesh {
  const char* name;
  Scene (*make)();
  double size;  ///< half of its extent
};
void PrintTo(const Mesh& m, std::ostream* out) {
  *out << m.name;
}

const Mesh kMeshes[] = {
    {"ball", [] { return ball_mesh(24, 12, .1); }, 1.1},
    {"ball_twice", [] { return with_copies(ball_mesh(12, 8)); }, 1},
    {"coplanar", [] { return coplanar_triangles(3, 120); }, 8},
    {"lattice", [] { return lattice_patch(12); }, 12},
    {"slivers", [] { return slivers(5, 300); }, 1},
    {"soup", [] { return random_triangles(7, 300); }, 1},
    {"ball_at_1e3",
     [] {
       return placed(ball_mesh(24, 12), 1, {1000, -700, 400});
     },
     1},
    {"ball_at_1e6",
     [] {
       return placed(ball_mesh(24, 12), 1, {1e6f, -7e5f, 4e5f});
     },
     1},
    {"tiny_ball",
     [] {
       return placed(ball_mesh(24, 12), 1e-15, {0, 0, 0});
     },
     1e-15},
};

Float3 middle_of(const Scene& s) {
  const auto& t = s.geometry.triangles;
  const auto middle = [](const std::vector<float>& v) {
    const auto [lo, hi] = std::minmax_element(v.begin(), v.end());
    return .5f * *lo + .5f * *hi;
  };
  return {middle(t.x), middle(t.y), middle(t.z)};
}

/// From `away` sizes: at vertices, at edges, along edges, in planes, at anything.
RayList rays_at(const Scene& s, double size, double away, std::uint64_t seed, int count) {
  Random random(seed);
  RayList rays;
  const auto& t = s.geometry.triangles;
  const Float3 middle = middle_of(s);
  const auto corner = [&](std::uint32_t v) { return vertex(s, v); };
  for (int i = 0; i < count; ++i) {
    const std::uint32_t k = random.below(static_cast<std::uint32_t>(t.a.size()));
    const Float3 a = corner(t.a[k]), b = corner(t.b[k]), c = corner(t.c[k]);
    const Float3 inside = at(a, random.unit() * .5, minus(b, a));
    Float3 org = at(middle, size * away * random.in(.5, 1), random.direction());
    switch (i % 6) {
      case 0:
        rays.add(org, minus(a, org));
        break;
      case 1:
        rays.add(org, minus(at(a, random.unit(), minus(b, a)), org));
        break;
      case 2:  // along an edge, or close to it
        rays.add(at(a, -away * random.unit(), minus(b, a)), minus(b, a));
        break;
      case 3:  // in the plane, or close to it
        rays.add(at(a, -away, minus(at(b, .5, minus(c, b)), a)), minus(at(b, .5, minus(c, b)), a));
        break;
      case 4: {  // along an axis, through a corner
        const std::uint32_t axis = random.below(3);
        Float3 dir{0, 0, 0};
        component(dir, axis) = random.chance(.5) ? 1.f : -1.f;
        org = a;
        Float3 from = middle;
        component(org, axis) = static_cast<float>(component(from, axis) -
                                                  double{component(dir, axis)} * size * away * 2);
        rays.add(org, dir);
        break;
      }
      default:
        rays.add(org,
                 minus(at(inside, random.unit() * .5, minus(c, inside)), org),
                 0,
                 random.chance(.8) ? kInf : 1.f);
    }
  }
  return rays;
}

constexpr double kDistances[] = {.4, 3, 100, 1e4, 1e6, 1e9, 1e13};

/// Rays at a mesh, and their exact answers in rational numbers.
struct Asked {
  Scene scene;
  RayList rays;
  Answers closest, occluded;
  explicit Asked(const Mesh& mesh) : scene(mesh.make()) {
    for (const double away : kDistances)
      rays.add(rays_at(scene, mesh.size, away, 11, 240));
    const rational::FirstTriangle first_triangle(scene);
    std::vector<std::uint8_t> blocked;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const rational::First first = first_triangle(ray(i));
      const bool met = first.id != kNoPrimitive;
      closest.id.push_back(first.id);
      // rounding takes no hit to the end of its search
      const float last = std::nextafter(rays.t[i], 0.f);
      closest.t.push_back(met ? std::min(first.t, last) : rays.t[i]);
      blocked.push_back(met);
    }
    occluded.block(rays, blocked);
  }
  Ray ray(std::size_t i) const { return {rays.org(i), rays.dir(i), rays.t_min[i], rays.t[i]}; }
};

void expect_calls(const Variant& variant, const World& world, const Asked& a) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < a.rays.size(); ++i) {
    const Hit hit = variant.loops.closest_one(world.impl().view, a.ray(i), nullptr);
    const bool blocked = variant.loops.occluded_one(world.impl().view, a.ray(i), nullptr);
    const bool met = a.closest.id[i] != kNoPrimitive;
    if (hit.id == a.closest.id[i] && hit.t == a.closest.t[i] && blocked == met)
      continue;
    if (wrong++ == 0)
      ADD_FAILURE() << variant.name << ", " << a.rays.describe(i) << "\n  expected "
                    << show(a.closest.t[i], a.closest.id[i]) << "\n  got      "
                    << show(hit.t, hit.id) << (blocked ? ", blocked" : "");
  }
  EXPECT_EQ(wrong, 0u) << "one ray a call, " << variant.name;
}

class Exact : public testing::TestWithParam<Mesh> {};

TEST_P(Exact, HitsAreThoseOfRationalNumbers) {
  const Asked a(GetParam());
  EXPECT_GT(hits_of(a.closest), a.rays.size() / 5);
  for (const float density : {0.f, .1f}) {
    const World world(a.scene, {.density = density});
    for (const Variant* variant : variants()) {
      if (!variant->is_supported())
        continue;
      expect_truth(*variant, world, a.rays, {a.closest, a.occluded}, GetParam().name);
      expect_calls(*variant, world, a);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Exact, testing::ValuesIn(kMeshes), [](const auto& p) {
  return std::string(p.param.name);
});

}  // namespace
}  // namespace grelha::test
