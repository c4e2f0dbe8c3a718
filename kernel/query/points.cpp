#include "grelha/inside.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "grelha/distance.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/query/lists.hpp"
#include "kernel/query/streams.hpp"

namespace grelha {

/// Throws NotClosed if a rule does not take the mesh of a scene, and makes what it needs.
void prepare_insides(const World& world, InsideRule rule);

/// Tells which points lie inside: inside[i] is 1 or 0. For runs of one thread, after
/// prepare_insides().
void classify_points(const Variant& variant,
                     const World& world,
                     std::span<const Float3> points,
                     InsideRule rule,
                     std::uint8_t* inside);

namespace {

bool is_in_box(const SceneView& scene, const Float3& p) {
  return p.x >= scene.box_lo[0] && p.x <= scene.box_hi[0] && p.y >= scene.box_lo[1] &&
         p.y <= scene.box_hi[1] && p.z >= scene.box_lo[2] && p.z <= scene.box_hi[2];
}

/// Throws NotClosed if there are edges of a kind.
void expect_none(const Findings<MeshEdge>& edges, const char* wanted, const char* found) {
  if (edges.count == 0)
    return;
  const MeshEdge& first = edges.first[0];
  throw NotClosed(
      "inside: expected " + std::string(wanted) + " mesh, found " + std::to_string(edges.count) +
          ' ' + found + (edges.count == 1 ? " edge" : " edges, the first") + " from vertex " +
          std::to_string(first.from) + " to " + std::to_string(first.to) + " of triangle " +
          std::to_string(first.id) + "; the rule \"winding\" takes any mesh",
      first);
}

const WindingTreeView& winding_tree(const World& world) {
  const World::Impl& w = world.impl();
  return w.winding_tree.get([&] { return w.scene.geometry; }).view;
}

}  // namespace

void prepare_insides(const World& world, InsideRule rule) {
  if (rule == InsideRule::kClosed || rule == InsideRule::kNonzero)
    expect_none(check_mesh(world).open_edges, "a closed", "open");
  if (rule == InsideRule::kNonzero)
    expect_none(check_mesh(world).inconsistent_edges, "an oriented", "inconsistent");
  if (rule == InsideRule::kWinding)
    winding_tree(world);
}

namespace {

/// The direction of rays that tell whether points are inside: no axis, plane of a lattice or
/// diagonal of a cube, so that few meet edges.
constexpr Float3 kInsideDirection{.4375f, .8125f, .3125f};

bool is_in_sphere(const GeometryView& g, std::uint32_t id, const double (&point)[3]) {
  if (!g.ids.has(PrimitiveKind::kSphere, id))
    return false;
  const Sphere::Fields<float> sphere =
      primitive_at<Sphere>(g.of<Sphere>(), id - g.ids.begin(PrimitiveKind::kSphere));
  return is_within(point, sphere.center, sphere.radius);
}

/// Where the ray from a point leaves meshes and where it enters them, and whether the point is in a
/// sphere.
struct Surroundings {
  std::int64_t outwards = 0;  ///< triangles, less those that are crossed inwards
  bool in_sphere = false;
};
Surroundings surroundings(const SceneView& scene,
                          const ExactRay& ray,
                          std::span<const Candidate> candidates) {
  Surroundings found;
  for (const Candidate& c : candidates) {
    if (!c.block) {
      found.in_sphere = found.in_sphere || is_in_sphere(scene.geometry, c.id, ray.org);
      continue;
    }
    const Triangle::Fields<float> triangle = scalar::triangle_of(*c.block, c.index);
    if (c.sure == 0 && !crosses_perturbed(ray, triangle))
      continue;
    const int by = is_crossed_inwards(ray, triangle.corner) ? -1 : 1;
    found.outwards += by;
    for (std::uint32_t i = scene.copies.begin(c.id); scene.copies.has(i, c.id); ++i)
      found.outwards += by;
  }
  return found;
}

}  // namespace

void classify_points(const Variant& variant,
                     const World& world,
                     std::span<const Float3> points,
                     InsideRule rule,
                     std::uint8_t* inside) {
  const bool by_crossings = rule != InsideRule::kWinding;
  if (!by_crossings)
    variant.loops.sort_by_winding(winding_tree(world), points.data(), points.size(), inside);
  const World::Impl& w = world.impl();
  const bool any_spheres = w.primitives.of<Sphere>().size() > 0;
  if (!by_crossings && !any_spheres)
    return;
  // a point beside the box of closed meshes is in none; a sphere's box is rounded
  const bool by_box = (rule == InsideRule::kClosed || rule == InsideRule::kNonzero) && !any_spheres;
  std::vector<Float3> asked;
  std::vector<std::size_t> index;  // of those in `points`
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (by_box && !is_in_box(w.view, points[i])) {
      inside[i] = 0;
      continue;
    }
    asked.push_back(points[i]);
    index.push_back(i);
  }
  Rays rays = Rays::of(asked, asked);
  rays.dir_stride = 0;
  rays.dir[0] = &kInsideDirection.x;
  rays.dir[1] = &kInsideDirection.y;
  rays.dir[2] = &kInsideDirection.z;
  const auto decide = [&](std::size_t k, std::span<const Candidate> candidates) {
    const Float3& p = asked[k];
    const ExactRay ray{{p.x, p.y, p.z},
                       {kInsideDirection.x, kInsideDirection.y, kInsideDirection.z},
                       0,
                       std::numeric_limits<double>::infinity()};
    const Surroundings found = surroundings(w.view, ray, candidates);
    std::uint8_t& one = inside[index[k]];
    bool is_inside = rule == InsideRule::kWinding && one != 0;
    if (by_crossings)
      is_inside = rule == InsideRule::kNonzero ? found.outwards != 0 : found.outwards % 2 != 0;
    one = is_inside || found.in_sphere;
  };
  const Wanted wanted = any_spheres ? Wanted::kTrianglesAndSpheresAround : Wanted::kTriangles;
  visit_candidates(variant, world, rays, wanted, decide);
}

bool contains(const World& world, Float3 point, InsideRule rule) {
  prepare_insides(world, rule);
  std::uint8_t inside = 0;
  classify_points(best_variant(), world, {&point, 1}, rule, &inside);
  return inside != 0;
}

void contains(const World& world,
              std::span<const Float3> points,
              std::span<std::uint8_t> inside,
              const QueryOptions& options) {
  expect_same_size(points.size(), inside.size(), "points");
  const Variant& variant = choose_variant(options.isa);
  prepare_insides(world, options.inside);
  const auto work = [&](std::size_t first, std::size_t end) {
    classify_points(
        variant, world, points.subspan(first, end - first), options.inside, &inside[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

double winding_number(const World& world, Float3 point, double error) {
  double number = 0;
  winding_numbers(world, {&point, 1}, {&number, 1}, error);
  return number;
}

void winding_numbers(const World& world,
                     std::span<const Float3> points,
                     std::span<double> numbers,
                     double error,
                     const QueryOptions& options) {
  expect_same_size(points.size(), numbers.size(), "points");
  if (!(error > 0))
    throw std::invalid_argument("error: expected more than 0, found " + std::to_string(error));
  const WindingLoop loop = choose_variant(options.isa).loops.winding_numbers;
  const WindingTreeView& tree = winding_tree(world);
  const auto work = [&](std::size_t first, std::size_t end) {
    loop(tree, &points[first], end - first, error, &numbers[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

namespace {

constexpr float kAnyRadius = std::numeric_limits<float>::infinity();

float signed_by(bool inside, float distance) {
  return inside ? 0 - distance : distance;  // no zero is -0
}

}  // namespace

ClosestPoint closest_point(const World& world, Float3 point, float radius) {
  ClosestPoint found;
  best_variant().loops.closest_points(world.impl().view, &point, 1, radius, &found);
  return found;
}

void closest_points(const World& world,
                    std::span<const Float3> points,
                    std::span<ClosestPoint> found,
                    float radius,
                    const QueryOptions& options) {
  expect_same_size(points.size(), found.size(), "points");
  const ClosestPointsLoop loop = choose_variant(options.isa).loops.closest_points;
  const auto work = [&](std::size_t first, std::size_t end) {
    loop(world.impl().view, &points[first], end - first, radius, &found[first]);
  };
  each_run(points.size(), options, work, kPoints);
}

float signed_distance(const World& world, Float3 point, InsideRule rule) {
  return signed_by(contains(world, point, rule), closest_point(world, point).distance);
}

void signed_distances(const World& world,
                      std::span<const Float3> points,
                      std::span<float> distances,
                      const QueryOptions& options) {
  expect_same_size(points.size(), distances.size(), "points");
  const Variant& variant = choose_variant(options.isa);
  prepare_insides(world, options.inside);
  const auto work = [&](std::size_t first, std::size_t end) {
    ClosestPoint found[kPoints.most];
    std::uint8_t inside[kPoints.most];
    for (std::size_t i = first; i < end; i += std::size(found)) {
      const std::size_t count = std::min(std::size(found), end - i);
      variant.loops.closest_points(world.impl().view, &points[i], count, kAnyRadius, found);
      classify_points(variant, world, points.subspan(i, count), options.inside, inside);
      for (std::size_t k = 0; k < count; ++k)
        distances[i + k] = signed_by(inside[k] != 0, found[k].distance);
    }
  };
  each_run(points.size(), options, work, kPoints);
}

}  // namespace grelha
