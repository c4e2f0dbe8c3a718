#include "kernel/marks/small_things.hpp"

#include <atomic>
#include <mutex>
#include <span>

#include "kernel/marks/mesh_rims.hpp"
#include "kernel/marks/mesh_thickness.hpp"
#include "kernel/marks/thin_shadows.hpp"
#include "kernel/scene/pixel_box.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

/// Share of a pixel that beams are wider than pixels, and what rounding may move.
constexpr double kMargin = .1;
/// Where planes have no end: pixels are looked at that are so much wider than those at the farthest
/// of all else (a choice).
constexpr double kBeyond = 8;
/// A flat mirror shows nothing from farther away than so many times the farthest corner of the
/// scene: the way to the mirror, and once across.
constexpr double kByMirror = 3;
/// Things in front of whose shadows every pixel is asked: as many as pixels over this.
constexpr std::size_t kPixelsAThing = 2;
constexpr std::size_t kThingsOfTurn = 1024;

/// What a rod shows to the eye; what of it lies behind that is cut off.
class SeenThings {
 public:
  SeenThings(const ToPicture& to, const Marks& marks) : to_(to), marks_(marks) {}

  /// The width below which a rod looks thin.
  double thin(const Rod& rod) const {
    return kThin * to_.pixel(std::max({to_(rod.end[0]).depth, to_(rod.end[1]).depth, 0.}));
  }
  /// Whether a thin one is marked already.
  bool is_known(const Rod& rod) const {
    const Way w = way_of(rod);
    return is_way_marked(w.a, w.b, w.reach + kMargin, marks_.thin) &&
           (!w.small || is_way_marked(w.a, w.b, w.reach + kMargin, marks_.small));
  }
  void add(const Rod& rod) {
    const Way w = way_of(rod);
    mark_way(w.a, w.b, w.reach + kMargin, marks_.thin);
    if (w.small)
      mark_way(w.a, w.b, w.reach + kMargin, marks_.small);
  }

 private:
  struct Way {
    ToPicture::Spot a, b;
    double reach = 0;
    bool small = false;
  };
  Way way_of(Rod rod) const {
    cut_behind(to_, rod);
    Way w{.a = to_(rod.end[0]), .b = to_(rod.end[1])};
    w.reach = to_.reach(rod.aside, std::min(w.a.depth, w.b.depth));
    w.small = std::max(std::abs(w.a.x - w.b.x), std::abs(w.a.y - w.b.y)) + 2 * w.reach < kThin;
    return w;
  }

  const ToPicture& to_;
  const Marks marks_;
};

/// Marks what small things there are.
class Marker {
 public:
  Marker(const World::Impl& world,
         const Setup& setup,
         int threads,
         SmallThings& things,
         TraceCounts& counts)
      : world_(world),
        setup_(setup),
        g_(world.primitives.geometry),
        threads_(threads),
        to_(setup.frame),
        widest_(kThin * widest_pixel()),
        thickness_(world, setup),
        things_(things),
        counts_(counts) {}

  void run() {
    mark_things_seen();
    things_.mirrored = has_loner(kThin * kByMirror * to_.pixel(farthest()));
    for (int l = 0; l < world_.shading.light_count; ++l) {
      PixelMarks& shadows = things_.shadows[static_cast<std::size_t>(l % kLightBits)];
      mark_shadows(world_.shading.lights + kLightFloats * l, {shadows, things_.small});
    }
  }

 private:
  /// Of all pixels that anything finite is seen in.
  double widest_pixel() const {
    const SceneView& v = world_.view;
    double most = 0;
    for (int k = 0; k < 8; ++k) {
      const Place3 corner = {k & 1 ? v.box_hi[0] : v.box_lo[0],
                             k & 2 ? v.box_hi[1] : v.box_lo[1],
                             k & 4 ? v.box_hi[2] : v.box_lo[2]};
      most = std::max(most, to_(corner).depth);
    }
    return to_.pixel(most) * (g_.planes.size() > 0 ? kBeyond : 1);
  }

  /// Distance of the farthest corner of all that is finite, in lengths of `forward`.
  double farthest() const {
    const SceneView& v = world_.view;
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      const double most = std::max(std::abs(static_cast<double>(v.box_lo[a]) - to_.eye[a]),
                                   std::abs(static_cast<double>(v.box_hi[a]) - to_.eye[a]));
      square += most * most;
    }
    return to_.depth_of(std::sqrt(square));
  }

  /// Whether anything that is no part of a larger mesh is thinner than that.
  bool has_loner(double width) const {
    for (std::size_t i = 0; i < g_.spheres.size(); ++i)
      if (rod_of(g_.spheres, i).width < width)
        return true;
    for (std::size_t i = 0; i < g_.cones.size(); ++i)
      if (rod_of(g_.cones, i).width < width)
        return true;
    for (std::size_t i = 0; i < g_.triangles.size(); ++i)
      if (rims_->stands_alone(i) && rod_of(g_.triangles, i, to_.eye).width < width)
        return true;
    return false;
  }

  void look_from(const Place3& point) {
    if (g_.triangles.size() == 0)
      return;
    if (!rims_)
      rims_ = std::make_unique<MeshRims>(g_.triangles, threads_);
    rims_->look_from(point);
  }

  std::size_t turns() const {
    return (g_.spheres.size() + g_.cones.size() + g_.triangles.size() + kThingsOfTurn - 1) /
           kThingsOfTurn;
  }

  Rod rod_at(std::size_t i, const Place3& from) const {
    const std::size_t cones = g_.spheres.size();
    const std::size_t triangles = cones + g_.cones.size();
    return i < cones       ? rod_of(g_.spheres, i)
           : i < triangles ? rod_of(g_.cones, i - cones)
                           : rod_of(g_.triangles, i - triangles, from);
  }

  /// Adds the things of a turn that are thin as seen from a point. Returns whether any of them is
  /// no part of a larger mesh.
  template <class Things>
  bool add_things(std::size_t turn, const Place3& from, Things& things, TraceCounts& counts) const {
    const std::size_t triangles = g_.spheres.size() + g_.cones.size();
    const std::size_t end = std::min((turn + 1) * kThingsOfTurn, triangles + g_.triangles.size());
    Outlines outlines;
    bool any_alone = false;
    for (std::size_t i = turn * kThingsOfTurn; i < end; ++i) {
      const std::size_t triangle = i - triangles;
      if (i >= triangles && !rims_->has(triangle))
        continue;
      const Rod rod = rod_at(i, from);
      const double thin = things.thin(rod);
      if (!(rod.width < thin))
        continue;
      any_alone |= i < triangles || rims_->stands_alone(triangle);
      if (things.is_known(rod))
        continue;
      if (i < triangles || rims_->ends_at(triangle))
        things.add(rod);
      else
        outlines.add(triangle, thin);
    }
    add_outlines(outlines, from, things, counts);
    return any_alone;
  }

  /// Triangles inside of meshes, each with the width below which it is thin.
  struct Outlines {
    std::uint32_t triangle[kThingsOfTurn];
    double thin[kThingsOfTurn];
    std::size_t count = 0;

    void add(std::size_t i, double width) {
      triangle[count] = static_cast<std::uint32_t>(i);
      thin[count++] = width;
    }
  };

  /// They are as thick as their meshes are there at least.
  template <class Things>
  void add_outlines(const Outlines& outlines,
                    const Place3& from,
                    Things& things,
                    TraceCounts& counts) const {
    double thickness[kThingsOfTurn];
    const std::size_t count = outlines.count;
    thickness_.measure({outlines.triangle, count}, {outlines.thin, count}, thickness, counts);
    for (std::size_t k = 0; k < count; ++k) {
      if (!(thickness[k] < outlines.thin[k]))
        continue;
      Rod rod = rod_of(g_.triangles, outlines.triangle[k], from);
      rod.width = std::max(rod.width, thickness[k]);
      things.add(rod);
    }
  }

  void mark_things_seen() {
    look_from(to_.eye);
    std::atomic<bool> stand_alone = false;
    each_turn(turns(), threads_, [&](std::size_t turn) {
      TraceCounts counts;
      SeenThings seen(to_, {things_.thin, things_.small});
      if (add_things(turn, to_.eye, seen, counts))
        stand_alone = true;
      add(counts);
    });
    things_.stand_alone = stand_alone;
  }

  void mark_shadows(const float* light, const Marks& marks) {
    const Place3 from = {light[0], light[1], light[2]};
    look_from(from);
    const std::size_t pixels = static_cast<std::size_t>(setup_.frame.width) *
                               static_cast<std::size_t>(setup_.frame.height);
    ShadowCaster caster{light, widest_, marks, pixels / kPixelsAThing};
    each_turn(turns(), threads_, [&](std::size_t turn) {
      if (caster.is_anywhere())
        return;
      TraceCounts counts;
      ThinShadows shadows(world_, setup_, to_, caster, counts);
      add_things(turn, from, shadows, counts);
      shadows.follow();
      add(counts);
    });
    if (caster.is_anywhere()) {
      marks.thin.mark_all();
      marks.small.mark_all();
    }
  }

  void add(const TraceCounts& counts) {
    const std::lock_guard lock(sum_);
    counts_ += counts;
  }

  const World::Impl& world_;
  const Setup& setup_;
  const GeometrySpans& g_;
  const int threads_;
  const ToPicture to_;
  const double widest_;
  const MeshThickness thickness_;
  SmallThings& things_;
  TraceCounts& counts_;
  std::mutex sum_;
  std::unique_ptr<MeshRims> rims_;
};

}  // namespace

SmallThings::SmallThings(const World::Impl& world,
                         const Setup& setup,
                         int threads,
                         TraceCounts& counts)
    : thin(setup.frame.width, setup.frame.height), small(setup.frame.width, setup.frame.height) {
  for (int l = 0; l < std::min(world.shading.light_count, kLightBits); ++l)
    shadows.emplace_back(setup.frame.width, setup.frame.height);
  Marker marker(world, setup, threads, *this, counts);
  marker.run();
}

std::uint64_t SmallThings::lights(int x, int y) const {
  std::uint64_t bits = 0;
  for (std::size_t l = 0; l < shadows.size(); ++l)
    bits |= std::uint64_t{shadows[l].has(x, y)} << l;
  return bits;
}

}  // namespace grelha
