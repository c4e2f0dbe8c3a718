// Rays and primitives tested in double (--precision double): the same answers and bits whatever
// finds them, as near the truth as double promises, and pictures made of them.
#include <bit>
#include <deque>
#include <functional>

#include "tests/support/closed.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr oracle::Real kEpsDouble = 0x1p-53L;

/// A copy whose closest and occluded are those in double.
const Variant& in_double(const Variant& v) {
  struct Doubled {
    VariantLoops loops;
    Variant variant;
    explicit Doubled(const Variant& of)
        : loops(of.loops), variant{of.name, of.lanes, of.runs_here, loops} {
      loops.closest = of.loops.in_double.closest;
      loops.occluded = of.loops.in_double.occluded;
    }
  };
  static std::deque<Doubled> all;
  for (const Doubled& d : all)
    if (d.variant.name == v.name)
      return d.variant;
  return all.emplace_back(v).variant;
}

class Double : public EveryVariant {
 protected:
  const Variant& tested() const { return in_double(variant()); }
};
GRELHA_FOR_EVERY_ISA(Double);

Truth truth_in_double(const Scene& scene, const RayList& rays) {
  return truth_of(scene, rays, in_double(reference_walk()));
}

void expect_truth_in_double(const Variant& tested,
                            const World& world,
                            const RayList& rays,
                            const Truth& truth,
                            const std::string& what) {
  expect_truth(tested, world, rays, truth, what, in_double(reference_walk()));
}

TEST_P(Double, OneSetOfBits) {
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    Random random(seed);
    const double scale = random.log_in(1e-4, 1e4);
    const Float3 offset = random.point(scale * random.log_in(.1, 1e3));
    const Scene scene = placed(random_mixture(seed, 150), scale, offset);
    const World world(scene, {.density = seed % 4 == 0 ? 4.f : 0.f});
    RayList rays =
        with_odd_values(random,
                        rays_about(random, offset, scale, kManyRays, seed % 3 == 0 ? 1e6 : 1e3),
                        seed % 2 ? .1 : 0);
    // packets that stay together, of rays as they are and of rays brought near
    for (const double away : {3., 1e4}) {
      const Float3 eye = at(offset, away * scale, random.direction());
      for (int i = 0; i < 256; ++i)
        rays.add(eye, minus(at(offset, scale * .2, random.point(1)), eye));
    }
    const Truth truth = truth_in_double(scene, rays);
    EXPECT_GT(hits_of(truth.closest), 300u);
    expect_truth_in_double(tested(), world, rays, truth, "seed " + std::to_string(seed));
  }
}

TEST_P(Double, FromFarAway) {
  for (const Scene& scene : {crowd_on_a_wide_plain(7, 400), mesh_in_a_vast_scene()}) {
    const World world(scene, {.density = 4});
    Random random(3);
    RayList rays;
    for (int i = 0; i < 1500; ++i) {
      const Float3 eye = at({}, random.log_in(1e4, 2e6), random.direction()), aim = random.point(1);
      rays.add({eye.x, std::abs(eye.y), eye.z}, minus(aim, {eye.x, std::abs(eye.y), eye.z}));
    }
    expect_truth_in_double(tested(), world, rays, truth_in_double(scene, rays), "far rays");
  }
}

TEST_P(Double, TiesGoToTheLowerId) {
  Scene scene = empty_scene();
  for (int copy = 0; copy < 3; ++copy)
    for (int i = 0; i < 40; ++i) {
      const float x = static_cast<float>(i % 8), z = static_cast<float>(i / 8);
      scene.geometry.spheres.add({x, 0, z}, .25f, 0);
      add_triangle(scene, {x, 0, z}, {x + 1, 0, z}, {x, 0, z + 1});
    }
  // below all of them, in no grid: met first
  add_triangle(scene, {-4, 0, -4}, {28, 0, -4}, {-4, 0, 28});
  RayList rays;
  for (int tile = 0; tile < 40; ++tile)
    for (int i = 0; i < 64; ++i) {
      const auto at = [](int whole, int eighths) {
        return static_cast<float>(whole) + .125f * static_cast<float>(eighths);
      };
      // every number is exact, and equal t are equal bits
      rays.add({at(tile % 8, i % 8), 4, at(tile / 8, i / 8)}, {0, -1, 0});
    }
  const Truth truth = truth_in_double(scene, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::uint32_t id = truth.closest.id[i];
    EXPECT_TRUE(id < 40 || (id >= 120 && id < 160) || id == 240) << id;
  }
  expect_truth_in_double(tested(), World(scene, {.density = 2}), rays, truth, "ties");
}

// ---- how far off ----

/// The derivations of sphere.hpp, plane.hpp and triangle.hpp count roundings, whatever their size:
/// in double the same multiples of 2^-53. Here t is judged, of rays that meet a surface at a cosine
/// of at least .1: along the ray the point is off by ten times that at most. From D away 46 eps D
/// is the largest, hence 460; twice that for a scene some of whose far sides lie twice as far as
/// its middle. Rounded to float such a t is off by half a unit, and by what is left of a millionth
/// of a unit.
TEST_P(Double, IsOffByRoundingAlone) {
  Random random(5);
  Scene scene = random_spheres(5, 60);
  add_triangles(scene, random, 60, 1, .01, 1);
  scene.geometry.planes.add({0, -1.5f, 0}, {.1f, 1, .2f}, 0);
  const World world(scene, {.density = 2});
  const RayList rays = rays_about(random, {}, 1, 20000, 100);
  const SceneView& view = world.impl().view;
  const GeometryView& g = view.geometry;
  const auto three = [](const float* const(&of)[3], std::uint32_t i) {
    return Float3{of[0][i], of[1][i], of[2][i]};
  };
  const auto& planes = g.of<Plane>().fields;
  const auto& spheres = g.of<Sphere>().fields;
  const auto& triangles = g.of<Triangle>();
  const auto corner = [&](std::uint32_t i) { return three(triangles.vertex, i); };
  for (const TraceOptions& settings : {TraceOptions{256, true}, TraceOptions{1, true}}) {
    const Answers a = trace(tested(), world, rays, settings, Query::kClosest);
    int judged = 0, wrongly_rounded = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (a.id[i] == kNoPrimitive)
        continue;
      const oracle::Ray ray{rays.org(i), rays.dir(i)};
      const auto [kind, k] = view.geometry.ids.primitive(a.id[i]);
      std::optional<oracle::Crossing> truth;
      if (kind == PrimitiveKind::kPlane)
        truth = oracle::Sheet{three(planes.point, k), three(planes.normal, k)}.first(ray,
                                                                                     rays.t_min[i]);
      else if (kind == PrimitiveKind::kSphere) {
        truth = oracle::Ball{three(spheres.center, k), spheres.radius[k]}.first(ray, rays.t_min[i]);
      } else if (kind == PrimitiveKind::kTriangle) {
        truth = oracle::Facet{corner(triangles.corner[0][k]),
                              corner(triangles.corner[1][k]),
                              corner(triangles.corner[2][k])}
                    .first(ray, rays.t_min[i]);
      }
      if (!truth || truth->cosine < .1L)
        continue;
      ++judged;
      const oracle::Real reach = (length(ray.org) + 4) / length(ray.dir);
      ASSERT_LE(std::abs(a.t_double[i] - truth->t), 920 * kEpsDouble * reach)
          << rays.describe(i) << " id " << a.id[i];
      wrongly_rounded += a.t[i] != static_cast<float>(truth->t);
    }
    EXPECT_GT(judged, 5000);
    // a true t within 1e-13 of the middle of two floats, 1e-6 units: of 20,000 hardly one
    EXPECT_LE(wrongly_rounded, 2);
  }
}

// ---- leaks ----

TEST_P(Double, ClosedMeshesAreTight) {
  for (const bool torus : {false, true})
    for (const double scale : {1., 1e-6, 1e6}) {
      const Scene unit = torus ? torus_mesh(24, 12, kTube) : ball_mesh(24, 12, .15);
      const Float3 offset = scale == 1 ? Float3{1e3f, 10, -1.5e3f} : Float3{};
      const Scene scene = placed(unit, scale, offset);
      Random random(17);
      RayList rays;
      const Aims aims = aims_at(unit, random);
      for (const auto* some : {&aims.vertices, &aims.middles, &aims.along})
        for (const Float3& aim : *some) {
          const Float3 org = at(offset, scale, inside(random, aim, torus));
          rays.add(org, minus(at(offset, scale, aim), org));
        }
      const World world(scene, {});
      for (const Way& way : every_way()) {
        EXPECT_EQ(hits_of(trace(tested(), world, rays, way.settings, Query::kClosest)), rays.size())
            << way.name << ", scale " << scale;
        EXPECT_EQ(hits_of(trace(tested(), world, rays, way.settings, Query::kOccluded)),
                  rays.size())
            << way.name << ", scale " << scale;
      }
    }
}

// ---- pictures ----

Image picture(const World& world,
              const Camera& camera,
              RenderOptions o,
              Precision precision = Precision::kDouble) {
  o.precision = precision;
  o.threads = 2;
  RenderStats stats;
  return render(world, camera, o, stats);
}

std::size_t differing(const Image& a, const Image& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    n += std::bit_cast<std::uint32_t>(a.rgb[i]) != std::bit_cast<std::uint32_t>(b.rgb[i]);
  return n;
}

TEST_P(Double, MakesOnePicture) {
  Scene scene = random_mixture(12, 200);
  scene.materials[0].mirror = {.5f, .4f, .3f};
  scene.lights = {{{3, 4, 5}, {.6f, .6f, .6f}}, {{-4, 2, 1}, {.3f, .1f, .2f}}};
  Camera camera;
  camera.eye = {.3f, .5f, 3.5f};
  camera.at = {0, 0, 0};
  camera.width = 67;
  camera.height = 43;
  const World world(scene, {}), plain(scene, {.grid = false});
  RenderOptions plainest;
  plainest.isa = "scalar";
  plainest.packet = 1;
  plainest.mailbox = false;
  const Image wanted = picture(plain, camera, plainest);
  for (const int packet : {1, 16, 64, 256}) {
    RenderOptions o;
    o.isa = variant().name;
    o.packet = packet;
    EXPECT_EQ(differing(picture(world, camera, o), wanted), 0u) << packet;
  }
}

/// A clear sheet, ball or plane a float's last place before a shining one: the refracted ray starts
/// between them. Single starts it four of its places on, behind what shines. (Single cannot tell
/// which is nearer either: the clear one has the lower id.)
TEST_P(Double, StartsBetweenWhatIsALastPlaceApart) {
  const float inner = std::nextafter(1.f, 0.f);
  const auto sheets = [&](Scene& s) {
    add_triangle(s, {-50, 1, -50}, {50, 1, -50}, {0, 1, 50}, 0);
    add_triangle(s, {-50, inner, -50}, {50, inner, -50}, {0, inner, 50}, 1);
  };
  const auto balls = [&](Scene& s) {
    s.geometry.spheres.add({0, 0, 0}, 1, 0);
    s.geometry.spheres.add({0, 0, 0}, inner, 1);
  };
  const auto planes = [&](Scene& s) {
    s.geometry.planes.add({0, 1, 0}, {0, 1, 0}, 0);
    s.geometry.planes.add({0, inner, 0}, {0, 1, 0}, 1);
  };
  for (const auto& add : {std::function<void(Scene&)>(sheets),
                          std::function<void(Scene&)>(balls),
                          std::function<void(Scene&)>(planes)}) {
    Scene scene = empty_scene();
    scene.materials[0].transmission = 1;
    scene.materials[0].ior = 1;
    scene.materials.emplace_back().emission = {1, 1, 1};
    add(scene);
    const World world(scene, {});
    Camera camera;
    camera.eye = {.1f, 4, 0};
    camera.at = {0, 0, 0};
    camera.up = {0, 0, 1};
    camera.angle_deg = 10;
    camera.width = camera.height = 32;
    RenderOptions options;
    options.isa = variant().name;
    options.depth = 2;
    const auto shining = [](const Image& image) {
      std::size_t n = 0;
      for (const float c : image.rgb)
        n += c > .99f;
      return n;
    };
    EXPECT_LT(shining(picture(world, camera, options, Precision::kSingle)), 3u * 32 * 32 * 3 / 4);
    EXPECT_EQ(shining(picture(world, camera, options)), 3u * 32 * 32);
  }
}

/// Two sheets a float's last place apart, seen from three units away: to single they are at one
/// distance, and of equals the lower id shows, which is the dark one behind. Whichever way samples
/// are spent.
TEST_P(Double, TellsApartWhatSingleCannot) {
  Scene scene = empty_scene();
  scene.materials.emplace_back().emission = {1, 1, 1};
  const float behind = std::nextafter(1.f, 0.f);
  add_triangle(scene, {-50, behind, -50}, {50, behind, -50}, {0, behind, 50}, 0);
  add_triangle(scene, {-50, 1, -50}, {50, 1, -50}, {0, 1, 50}, 1);
  const World world(scene, {});
  Camera camera;
  camera.eye = {.1f, 4, 0};
  camera.at = {0, 0, .3f};
  camera.width = camera.height = 32;
  const auto dark = [](const Image& image) {
    std::size_t n = 0;
    for (const float c : image.rgb)
      n += c < .99f;
    return n;
  };
  RenderOptions every, subdivided, refined;
  subdivided.subdivision.on = true;
  refined.refine.samples = 32 * 32 * 4;
  for (RenderOptions* const o : {&every, &subdivided, &refined}) {
    o->isa = variant().name;
    EXPECT_GT(dark(picture(world, camera, *o, Precision::kSingle)), 100u);
    EXPECT_EQ(dark(picture(world, camera, *o)), 0u);
  }
}

/// A sheet before a light by the last place of a float: shadow rays end at the light, at t = 1, and
/// to single many end at the sheet.
TEST_P(Double, SeesWhatStandsBeforeALight) {
  Scene scene = empty_scene();
  const float before = std::nextafter(2.f, 0.f);
  add_triangle(scene, {-50, 0, -50}, {50, 0, -50}, {0, 0, 50});
  add_triangle(scene, {-50, before, -50}, {50, before, -50}, {0, before, 50});
  scene.lights = {{{.1f, 2, 0}, {1, 1, 1}}};
  const World world(scene, {});
  Camera camera;
  camera.eye = {.1f, 1, 0};
  camera.at = {0, 0, .3f};
  camera.width = camera.height = 32;
  const auto lit = [](const Image& image) {
    return std::count_if(image.rgb.begin(), image.rgb.end(), [](float c) { return c > 0; });
  };
  RenderOptions o;
  o.isa = variant().name;
  EXPECT_GT(lit(picture(world, camera, o, Precision::kSingle)), 100);
  EXPECT_EQ(lit(picture(world, camera, o)), 0);
}

}  // namespace
}  // namespace grelha::test
