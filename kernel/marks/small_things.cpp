#include "kernel/marks/small_things.hpp"

#include <atomic>
#include <bit>
#include <mutex>
#include <span>
#include <vector>

#include "kernel/marks/mesh_rims.hpp"
#include "kernel/marks/mesh_thickness.hpp"
#include "kernel/marks/rim_walk.hpp"
#include "kernel/marks/thin_shadows.hpp"
#include "kernel/scene/pages.hpp"
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

template <class Visit>
void each_bit(unsigned bits, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1)
    visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

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
    const double length = std::max({std::abs(w.a.x - w.b.x),
                                    std::abs(w.a.y - w.b.y),
                                    rod.whole / to_.pixel(std::max(w.a.depth, w.b.depth))});
    w.small = length + 2 * w.reach < kThin;
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
        rims_(g_.triangles, threads),
        things_(things),
        counts_(counts) {
    const Place3& eye = to_.eye;
    viewpoints_.push_back({{eye[0], eye[1], eye[2]}});
    for (int l = 0; l < world.shading.light_count; ++l) {
      const float* const at = world.shading.lights + kLightFloats * l;
      viewpoints_.push_back({{at[0], at[1], at[2]}});
    }
    if (rims_.tell())
      resize_to_fill(thick_, g_.triangles.size(), kUnknown);
  }

  void run() {
    look_from(0);
    mark_things_seen();
    things_.mirrored = has_loner(kThin * kByMirror * to_.pixel(farthest()));
    for (std::size_t v = 1; v < viewpoints_.size(); ++v) {
      look_from(v);
      const std::size_t light = v - 1;
      mark_shadows(v, {things_.shadows[light % kLightBits], things_.small});
    }
  }

 private:
  static constexpr float kUnknown = -1;

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
      if (rims_.tell() ? rims_.stands_alone(i) && is_thin_at(i, rims_.ends(i), width)
                       : rod_of(g_.triangles, i, to_.eye).width < width)
        return true;
    return false;
  }
  /// Whether a mesh that ends at some edges of a triangle is thinner than that there.
  bool is_thin_at(std::size_t i, unsigned edges, double width) const {
    const RimWalk walk = walk_from(0);
    bool thin = false;
    each_bit(edges, [&](std::size_t k) { thin |= walk.strip(i, k, width).width < width; });
    return thin;
  }

  /// Makes rims tell of a viewpoint, and of those after it.
  void look_from(std::size_t v) {
    constexpr std::size_t kMost = MeshRims::kMostViewpoints;
    if (v % kMost == 0)
      rims_.look_from(std::span(viewpoints_).subspan(v, std::min(kMost, viewpoints_.size() - v)));
  }

  std::size_t turns() const {
    return (g_.spheres.size() + g_.cones.size() + g_.triangles.size() + kThingsOfTurn - 1) /
           kThingsOfTurn;
  }

  /// Adds the things of a turn that are thin as seen from a viewpoint. Returns whether any of them
  /// is no part of a larger mesh.
  template <class Things>
  bool add_things(std::size_t turn, std::size_t v, Things& things, TraceCounts& counts) {
    const std::size_t cones = g_.spheres.size();
    const std::size_t triangles = cones + g_.cones.size();
    const std::size_t end = std::min((turn + 1) * kThingsOfTurn, triangles + g_.triangles.size());
    Outlines outlines;
    bool any_alone = false;
    for (std::size_t i = turn * kThingsOfTurn; i < end; ++i)
      any_alone |= i < cones       ? add_rod(rod_of(g_.spheres, i), things)
                   : i < triangles ? add_rod(rod_of(g_.cones, i - cones), things)
                                   : add_triangle(i - triangles, v, things, outlines);
    return add_outlines(outlines, v, things, counts) || any_alone;
  }

  /// Returns whether it is thin.
  template <class Things>
  static bool add_rod(const Rod& rod, Things& things) {
    if (!(rod.width < things.thin(rod)))
      return false;
    if (!things.is_known(rod))
      things.add(rod);
    return true;
  }

  /// Edges of triangles at which meshes turn away, each with the width below which that is thin.
  struct Outlines {
    static constexpr std::size_t kMost = 3 * kThingsOfTurn;
    std::uint32_t triangle[kMost];
    std::uint8_t edge[kMost];
    double thin[kMost];
    std::size_t count = 0;

    void add(std::size_t i, std::size_t k, double width) {
      triangle[count] = static_cast<std::uint32_t>(i);
      edge[count] = static_cast<std::uint8_t>(k);
      thin[count++] = width;
    }
  };

  RimWalk walk_from(std::size_t v) const {
    return {g_.triangles, rims_, v % MeshRims::kMostViewpoints, viewpoints_[v].at};
  }

  /// What is thin where the mesh of a triangle ends. Where it turns away it may be thick. Where
  /// rims tell nothing a triangle is a mesh. Returns whether any of it is no part of a larger one.
  template <class Things>
  bool add_triangle(std::size_t i, std::size_t v, Things& things, Outlines& outlines) const {
    if (!rims_.tell())
      return add_rod(rod_of(g_.triangles, i, viewpoints_[v].at), things);
    const unsigned rims = rims_.rims(i, v % MeshRims::kMostViewpoints);
    if (rims == 0)
      return false;
    const RimWalk walk = walk_from(v);
    bool any_thin = false;
    each_bit(rims, [&](std::size_t k) {
      const double thin = things.thin(walk.edge(i, k));
      if (!walk.may_be_thin(i, k, thin))
        return;
      if (rims_.ends(i) >> k & 1)
        any_thin |= add_rod(walk.strip(i, k, thin), things);
      else
        outlines.add(i, k, thin);
    });
    return any_thin && rims_.stands_alone(i);
  }

  /// They are as thick as their meshes are there at least. Returns the same.
  template <class Things>
  bool add_outlines(const Outlines& of, std::size_t v, Things& things, TraceCounts& counts) {
    measure(of, counts);
    const RimWalk walk = walk_from(v);
    bool any_alone = false;
    for (std::size_t j = 0; j < of.count; ++j) {
      if (!(thick_[of.triangle[j]] < of.thin[j]))
        continue;
      const Rod strip = walk.strip(of.triangle[j], of.edge[j], of.thin[j]);
      any_alone |= add_rod(strip, things) && rims_.stands_alone(of.triangle[j]);
    }
    return any_alone;
  }

  /// Each triangle is measured once, whatever sees its outline.
  void measure(const Outlines& of, TraceCounts& counts) {
    std::uint32_t unknown[Outlines::kMost];
    float thickness[Outlines::kMost];
    std::size_t count = 0;
    for (std::size_t j = 0; j < of.count; ++j) {
      const std::uint32_t i = of.triangle[j];
      if (thick_[i] == kUnknown && (count == 0 || unknown[count - 1] != i))
        unknown[count++] = i;
    }
    thickness_.measure({unknown, count}, widest_, thickness, counts);
    for (std::size_t j = 0; j < count; ++j)
      thick_[unknown[j]] = thickness[j];
  }

  void mark_things_seen() {
    std::atomic<bool> stand_alone = false;
    each_turn(turns(), threads_, [&](std::size_t turn) {
      TraceCounts counts;
      SeenThings seen(to_, {things_.thin, things_.small});
      if (add_things(turn, 0, seen, counts))
        stand_alone = true;
      add(counts);
    });
    things_.stand_alone = stand_alone;
  }

  void mark_shadows(std::size_t v, const Marks& marks) {
    const std::size_t pixels = static_cast<std::size_t>(setup_.frame.width) *
                               static_cast<std::size_t>(setup_.frame.height);
    ShadowCaster caster{viewpoints_[v].at, widest_, marks, pixels / kPixelsAThing};
    each_turn(turns(), threads_, [&](std::size_t turn) {
      if (caster.is_anywhere())
        return;
      TraceCounts counts;
      ThinShadows shadows(world_, setup_, to_, caster, counts);
      add_things(turn, v, shadows, counts);
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
  std::vector<float> thick_;  ///< [triangles] as measured, or kUnknown
  MeshRims rims_;
  SmallThings& things_;
  TraceCounts& counts_;
  std::mutex sum_;
  std::vector<SeenFrom> viewpoints_;  ///< the eye, and the middles of lights
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
