#include "grelha/inside.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "grelha/all_hits.hpp"
#include "kernel/grid/world_impl.hpp"
#include "kernel/query/crossing_sum.hpp"
#include "kernel/query/insides.hpp"
#include "kernel/query/runs.hpp"

namespace grelha {
namespace {

/// How often the ray from a point leaves meshes, less how often it enters them.
std::int64_t winding(const World& world, Float3 point, const CrossingSum& sum) {
  if (sum.is_whole)
    return sum.outwards;
  std::int64_t outwards = 0;
  for (const Crossing& at : crossings(world, {point, scalar::kInsideDirection}))
    outwards += at.enters ? -1 : 1;
  return outwards;
}

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

/// Points that are asked by crossings, so many at a time.
struct AskedPoints {
  static constexpr std::size_t kMost = 64;
  Float3 point[kMost];
  std::size_t place[kMost];  ///< in the caller's array
  std::size_t count = 0;
  bool is_full() const { return count == kMost; }
  void add(const Float3& p, std::size_t at) {
    place[count] = at;
    point[count++] = p;
  }
};

/// Answers and forgets the points that are asked. By winding, inside has the triangles' answers.
void answer(const Variant& variant,
            const World& world,
            AskedPoints& asked,
            InsideRule rule,
            std::uint8_t* inside) {
  CrossingSum sums[AskedPoints::kMost];
  variant.loops.sum_crossings(world.impl().view, asked.point, asked.count, sums);
  for (std::size_t k = 0; k < asked.count; ++k) {
    std::uint8_t& one = inside[asked.place[k]];
    bool is_inside = rule == InsideRule::kWinding && one != 0;
    if (rule != InsideRule::kWinding) {
      const std::int64_t around = winding(world, asked.point[k], sums[k]);
      is_inside = rule == InsideRule::kNonzero ? around != 0 : around % 2 != 0;
    }
    one = is_inside || sums[k].in_sphere;
  }
  asked.count = 0;
}

}  // namespace

void find_insides(const Variant& variant,
                  const World& world,
                  std::span<const Float3> points,
                  InsideRule rule,
                  std::uint8_t* inside) {
  const bool by_crossings = rule != InsideRule::kWinding;
  if (!by_crossings)
    variant.loops.sort_by_winding(winding_tree(world), points.data(), points.size(), inside);
  const World::Impl& w = world.impl();
  if (!by_crossings && w.primitives.of<Sphere>().size() == 0)
    return;
  // a point beside the box of closed meshes is in none; a sphere's box is rounded
  const bool by_box = (rule == InsideRule::kClosed || rule == InsideRule::kNonzero) &&
                      w.primitives.of<Sphere>().size() == 0;
  AskedPoints asked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (by_box && !is_in_box(w.view, points[i]))
      inside[i] = 0;
    else
      asked.add(points[i], i);
    if (asked.is_full())
      answer(variant, world, asked, rule, inside);
  }
  if (asked.count > 0)
    answer(variant, world, asked, rule, inside);
}

bool contains(const World& world, Float3 point, InsideRule rule) {
  prepare_insides(world, rule);
  std::uint8_t inside = 0;
  find_insides(best_variant(), world, {&point, 1}, rule, &inside);
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
    find_insides(
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

}  // namespace grelha
