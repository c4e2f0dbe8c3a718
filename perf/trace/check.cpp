#include "perf/trace/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernel/world/world_impl.hpp"
#include "perf/trace/modes.hpp"
#include "tests/reference/reference.hpp"
#include "tests/support/oracle.hpp"

namespace grelha::perf {
namespace {

/// share of rays that may hit something else in Embree: grazed edges
constexpr double kDisagree = .005;
constexpr double kClose = 1e-5;  ///< relative difference of t of one and the same place
/// On cones t alone tells little: a ray that starts beside one has a t as small as what its start
/// was rounded by, and one that grazes it may be anywhere along the touch. There a point also is
/// the same place where it lies on the side within what kernel/shapes/cone.hpp promises, in eps
/// (|org - base| + height + wider radius).
constexpr double kConeUnits = 32;
constexpr std::size_t kSampled = 16384;  ///< rays that the reference walk traces, or some more

/// A set of rays, and what Grelha's packets answer.
struct Judge {
  const Place& place;
  const RayBuffer& rays;
  bool any;
  Answers truth;

  bool on_its_cone(std::size_t i, std::uint32_t id, float t) const;
  bool past_the_planes(std::size_t i) const;
  bool something_else(const Answers& a, std::size_t i) const;
  double share(std::size_t part) const {
    return static_cast<double>(part) / static_cast<double>(rays.size());
  }
};

/// Returns true if primitive `id` is a cone and the point of ray i at t lies on its side.
bool Judge::on_its_cone(std::size_t i, std::uint32_t id, float t) const {
  const std::uint32_t first = place.world.impl().view.geometry.ids.begin(PrimitiveKind::kCone);
  const Cones& c = place.file.scene.geometry.cones;
  if (id < first || id - first >= c.size())
    return false;
  const std::size_t k = id - first;
  const test::oracle::V base = Float3{c.base_x[k], c.base_y[k], c.base_z[k]};
  const test::oracle::V apex = Float3{c.apex_x[k], c.apex_y[k], c.apex_z[k]};
  const test::oracle::Frustum side{base, apex, c.base_radius[k], c.apex_radius[k]};
  const test::oracle::Ray ray{Float3{rays.ox[i], rays.oy[i], rays.oz[i]},
                              Float3{rays.dx[i], rays.dy[i], rays.dz[i]}};
  const auto wider = std::max(std::abs(side.r0), std::abs(side.r1));
  const auto unit = test::oracle::kEps * (length(ray.org - base) + side.height() + wider);
  return side.distance(ray.point(t)) <= kConeUnits * unit;
}

/// Returns true if Grelha hit a plane outside the triangles that replace it in Embree.
bool Judge::past_the_planes(std::size_t i) const {
  const SceneView& scene = place.world.impl().view;
  if (!scene.geometry.ids.has(PrimitiveKind::kPlane, truth.id[i]))
    return false;
  const float org[] = {rays.ox[i], rays.oy[i], rays.oz[i]};
  const float dir[] = {rays.dx[i], rays.dy[i], rays.dz[i]};
  double width = 0, away = 0;
  for (int k = 0; k < 3; ++k) {
    width = std::max(width, double(scene.box_hi[k]) - scene.box_lo[k]);
    const double d =
        org[k] + double(truth.t[i]) * dir[k] - .5 * (double(scene.box_hi[k]) + scene.box_lo[k]);
    away += d * d;
  }
  return std::sqrt(away) > .99 * kPlaneReach * width;
}

/// Returns true if Embree and Grelha disagree about ray i.
bool Judge::something_else(const Answers& a, std::size_t i) const {
  if (any)
    return a.met(i) != truth.met(i);
  if (a.id[i] == kNoPrimitive || truth.id[i] == kNoPrimitive)
    return a.id[i] != truth.id[i] && !past_the_planes(i);
  // one of two that meet or overlap there is no error
  const bool close = std::abs(a.t[i] - truth.t[i]) <= static_cast<float>(kClose) * truth.t[i];
  return !close && !on_its_cone(i, a.id[i], a.t[i]);
}

std::string compare_modes(const Judge& judge) {
  for (const GrelhaMode& mode : kModes) {
    Answers again;
    TraceCounts unused;
    const Rays rays = judge.rays.view();
    trace(judge.place.world, best_variant(), mode.settings, rays, judge.any, again, unused);
    for (std::size_t i = 0; i < judge.rays.size(); ++i)
      if (!again.same(i, judge.truth, i))
        return std::string("wrong hits: ") + mode.name + " against " + kModes[0].name;
  }
  return "";
}

std::string compare_reference(const Judge& judge) {
  const RayBuffer& rays = judge.rays;
  RayBuffer some;
  const std::size_t step = std::max<std::size_t>(1, rays.size() / kSampled);
  for (std::size_t i = 0; i < rays.size(); i += step)
    some.add(
        {rays.ox[i], rays.oy[i], rays.oz[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}, rays.t_max[i]);
  Answers again;
  TraceCounts unused;
  trace(judge.place.world, reference_walk(), {}, some.view(), judge.any, again, unused);
  for (std::size_t i = 0; i < some.size(); ++i)
    if (!again.same(i, judge.truth, i * step))
      return "wrong hits: packets against the reference walk";
  return "";
}

double hit_share(const Judge& judge) {
  std::size_t hits = 0;
  for (std::size_t i = 0; i < judge.rays.size(); ++i)
    hits += judge.truth.met(i);
  return judge.share(hits);
}

/// Returns the fraction of rays whose answer differs in Embree, in one of its modes.
double disagreement(const Judge& judge, EmbreeScene& embree, const EmbreeMode& mode) {
  embree.trace(judge.rays, judge.any, mode);
  const Answers a = embree.answers();
  std::size_t other = 0;
  for (std::size_t i = 0; i < judge.rays.size(); ++i)
    other += judge.something_else(a, i);
  return judge.share(other);
}

std::string compare_embree(const Judge& judge, Cell& cell) {
  const Place& place = judge.place;
  for (EmbreeScene* const e : {place.robust.get(), place.fast.get()})
    for (const EmbreeMode& mode : e ? embree_modes() : std::vector<EmbreeMode>{}) {
      const double share = disagreement(judge, *e, mode);
      if (e == place.robust.get())
        cell.disagree = std::max(cell.disagree, share);
      if (share <= kDisagree)
        continue;
      char text[160];
      std::snprintf(text,
                    sizeof text,
                    "Embree %s, %s: %.2f %% of rays meet something else",
                    e == place.robust.get() ? "robust" : "fast",
                    mode.name,
                    100 * share);
      return text;
    }
  return "";
}

}  // namespace

std::string check(const Place& place, const RayBuffer& rays, bool any, Cell& cell) {
  Judge judge{place, rays, any, {}};
  TraceCounts unused;
  const TraceOptions& settings = kModes[0].settings;
  trace(place.world, best_variant(), settings, rays.view(), any, judge.truth, unused);
  if (const std::string wrong = compare_modes(judge); !wrong.empty())
    return wrong;
  if (const std::string wrong = compare_reference(judge); !wrong.empty())
    return wrong;
  cell.hit_share = hit_share(judge);
  return compare_embree(judge, cell);
}

}  // namespace grelha::perf
