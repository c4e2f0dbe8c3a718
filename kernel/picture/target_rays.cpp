#include "kernel/picture/target_rays.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "grelha/scene_spans.hpp"
#include "kernel/base/parallel_for.hpp"
#include "kernel/picture/tolerances.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/shade/pixel_box.hpp"

namespace grelha {
namespace {

constexpr double kThin = 1;         ///< pixels: samples of a net hit everything wider
constexpr double kMostParts = 256;  ///< parts of a capsule
constexpr int kMostClear = 6;       ///< transparent surfaces on the way to a thing
constexpr double kMostBlur = .25;   ///< pixels: a box holds too little of a thing with more blur
constexpr double kBoxTaken = .9 * static_cast<double>(kLargestBox);  ///< sides are rounded up
constexpr double kMargin = .02;  ///< pixels around a box, for rounding
constexpr std::size_t kRaysOfTurn = 256;

struct Point3 {
  double at[3];
  double operator[](std::size_t a) const { return at[a]; }
  double& operator[](std::size_t a) { return at[a]; }
};
Point3 operator-(const Point3& a, const Point3& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
double dot(const Point3& a, const Point3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// All of an object lies within `radius` of the stretch between its ends.
struct Capsule {
  Point3 end[2];
  double radius;
  std::uint32_t material;

  double length() const { return std::sqrt(dot(end[1] - end[0], end[1] - end[0])); }
};

Capsule capsule_of(const SphereSpans& s, std::size_t i) {
  const Point3 centre{{s.x[i], s.y[i], s.z[i]}};
  return {{centre, centre}, std::abs(static_cast<double>(s.radius[i])), s.material[i]};
}

Capsule capsule_of(const ConeSpans& c, std::size_t i) {
  return {{{{c.base_x[i], c.base_y[i], c.base_z[i]}}, {{c.apex_x[i], c.apex_y[i], c.apex_z[i]}}},
          std::max(std::abs(static_cast<double>(c.base_radius[i])),
                   std::abs(static_cast<double>(c.apex_radius[i]))),
          c.material[i]};
}

/// A camera in double precision.
class ToPicture {
 public:
  explicit ToPicture(const FrameView& f) : f_(f) {
    for (std::size_t a = 0; a < 3; ++a) {
      eye_[a] = f.eye[a];
      ff_ += square(f.forward[a]);
      rr_ += square(f.right[a]);
      uu_ += square(f.up[a]);
    }
  }
  struct Spot {
    double x, y;   ///< pixels
    double depth;  ///< in lengths of `forward`
  };
  Spot operator()(const Point3& p) const {
    double z = 0;
    double x = 0;
    double y = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double d = p[a] - eye_[a];
      z += d * f_.forward[a];
      x += d * f_.right[a];
      y += d * f_.up[a];
    }
    z /= ff_;
    const double shrink = f_.parallel ? 1 : z;
    return {.5 * f_.width + x / (rr_ * shrink), .5 * f_.height - y / (uu_ * shrink), z};
  }
  /// Where a ray that sees a point starts.
  Point3 eye(const Point3& p) const {
    if (!f_.parallel)
      return eye_;
    const double depth = (*this)(p).depth;
    Point3 at = p;
    for (std::size_t a = 0; a < 3; ++a)
      at[a] -= depth * f_.forward[a];
    return at;
  }
  /// How wide a pixel is.
  double pixel(double depth) const { return (f_.parallel ? 1 : depth) * std::sqrt(rr_); }
  /// Pixels that a ball of a radius reaches from its middle at most, anywhere in the picture: balls
  /// look longer in its corners.
  double half_width(double radius, double depth) const {
    const double corner =
        f_.parallel ? 0 : square(.5 * f_.width) * rr_ + square(.5 * f_.height) * uu_;
    return radius / pixel(depth) * std::sqrt(1 + corner / ff_);
  }

 private:
  static double square(double x) { return x * x; }
  const FrameView& f_;
  Point3 eye_;
  double ff_ = 0;
  double rr_ = 0;
  double uu_ = 0;
};

/// Cuts off what of a capsule lies behind the eye, or nearly so; false: nothing is left.
bool cut_behind(const ToPicture& to, Capsule& capsule) {
  const double z[2] = {to(capsule.end[0]).depth, to(capsule.end[1]).depth};
  const double least = 1e-3 * std::max(z[0], z[1]);
  if (!(least > 0))
    return false;
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t a = 0; z[k] < least && a < 3; ++a)
      capsule.end[k][a] +=
          (least - z[k]) / (z[1 - k] - z[k]) * (capsule.end[1 - k][a] - capsule.end[k][a]);
  return true;
}

/// A part of a capsule, the target of one ray.
struct Target : Capsule {
  bool hits_target = false;

  Point3 middle() const {
    Point3 m;
    for (std::size_t a = 0; a < 3; ++a)
      m[a] = .5 * (end[0][a] + end[1][a]);
    return m;
  }
};

std::vector<Capsule> capsules_of(const GeometrySpans& g) {
  std::vector<Capsule> capsules;
  for (std::size_t i = 0; i < g.spheres.size(); ++i)
    capsules.push_back(capsule_of(g.spheres, i));
  for (std::size_t i = 0; i < g.cones.size(); ++i)
    capsules.push_back(capsule_of(g.cones, i));
  return capsules;
}

/// Rays of one turn, from one point each.
struct TargetRays {
  float org[3][kRaysOfTurn], dir[3][kRaysOfTurn], t_min[kRaysOfTurn], t[kRaysOfTurn];
  std::uint32_t id[kRaysOfTurn];

  void set(std::size_t i, const Point3& from, const Point3& to, double least) {
    for (std::size_t a = 0; a < 3; ++a) {
      org[a][i] = static_cast<float>(from[a]);
      dir[a][i] = static_cast<float>(to[a] - from[a]);
    }
    t_min[i] = static_cast<float>(least);
  }
};

class TargetSearch {
 public:
  TargetSearch(
      const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& n)
      : world_(world),
        setup_(setup),
        threads_(threads),
        to_(setup.frame),
        r_(r),
        counts_(n),
        capsules_(capsules_of(world.primitives.geometry)) {}

  void run() {
    std::vector<Target> targets = thin_parts();
    const std::size_t turns = (targets.size() + kRaysOfTurn - 1) / kRaysOfTurn;
    std::vector<TraceCounts> counts(turns);
    each_turn(
        turns,
        threads_,
        [] { return std::make_unique<TargetRays>(); },
        [&](std::size_t turn, const std::unique_ptr<TargetRays>& rays) {
          const std::size_t first = turn * kRaysOfTurn;
          const std::size_t count = std::min(kRaysOfTurn, targets.size() - first);
          look(*rays, targets.data() + first, count, counts[turn]);
        });
    for (const TraceCounts& n : counts)
      counts_ += n;
    for (const Target& target : targets)
      if (target.hits_target)
        mark(target);
  }

 private:
  /// Radius of the disc that a point shows as, in pixels.
  double blur(double depth) const {
    const FrameView& f = setup_.frame;
    if (!f.lens)
      return 0;
    const Point3 right{{f.lens_right[0], f.lens_right[1], f.lens_right[2]}};
    const double focus = static_cast<double>(f.focus);
    const double ratio = f.parallel ? depth / focus : focus / depth;
    return std::abs(ratio - 1) * std::sqrt(dot(right, right)) / to_.pixel(focus);
  }

  static double parts_of(const Capsule& capsule, double step) {
    return std::clamp(std::ceil(capsule.length() / step), 1., kMostParts);
  }
  static void add_parts(const Capsule& capsule, double step, std::vector<Target>& targets) {
    const double parts = parts_of(capsule, step);
    for (double k = 0; k < parts; ++k) {
      Target target{capsule};
      for (std::size_t e = 0; e < 2; ++e)
        for (std::size_t a = 0; a < 3; ++a)
          target.end[e][a] = capsule.end[0][a] + (k + static_cast<double>(e)) / parts *
                                                     (capsule.end[1][a] - capsule.end[0][a]);
      targets.push_back(target);
    }
  }

  /// A capsule that looks thin, and how wide a pixel is there.
  struct ThinCapsule {
    Capsule capsule;
    double pixel;
  };

  /// Parts a pixel long; longer ones where there would be more than pixels of the picture.
  std::vector<Target> parts_of(const std::vector<ThinCapsule>& thin) const {
    const auto count = [&](double pixels) {
      double sum = 0;
      for (const ThinCapsule& t : thin)
        sum += parts_of(t.capsule, pixels * t.pixel);
      return sum;
    };
    const auto most = static_cast<double>(r_.box.size());
    double pixels = 1;
    while (pixels < kMostParts && count(pixels) > most)
      pixels *= 2;
    std::vector<Target> targets;
    for (const ThinCapsule& t : thin)
      add_parts(t.capsule, pixels * t.pixel, targets);
    return targets;
  }

  /// Of all capsules that look thin.
  std::vector<Target> thin_parts() const {
    std::vector<ThinCapsule> thin;
    for (Capsule capsule : capsules_) {
      if (!cut_behind(to_, capsule))
        continue;
      const double pixel =
          to_.pixel(std::min(to_(capsule.end[0]).depth, to_(capsule.end[1]).depth));
      if (2 * capsule.radius < kThin * pixel)
        thin.push_back({capsule, pixel});
    }
    return parts_of(thin);
  }

  void closest(const TargetRays& rays, TargetRays& hits, std::size_t count, TraceCounts& n) const {
    const Rays in{.org = {rays.org[0], rays.org[1], rays.org[2]},
                  .dir = {rays.dir[0], rays.dir[1], rays.dir[2]},
                  .t_min = rays.t_min,
                  .count = count};
    setup_.variant.loops.closest(world_.view, in, {.t = hits.t, .id = hits.id}, {}, n);
  }

  std::uint32_t material_of(std::uint32_t id) const {
    const GeometrySpans& g = world_.primitives.geometry;
    const Primitive p = world_.primitives.ids.primitive(id);
    return p.kind == PrimitiveKind::kSphere     ? g.spheres.material[p.index]
           : p.kind == PrimitiveKind::kCone     ? g.cones.material[p.index]
           : p.kind == PrimitiveKind::kTriangle ? g.triangles.material[p.index]
                                                : g.planes.material[p.index];
  }

  /// Share of the way to its middle at which a ray has surely come to a thing.
  static double near(const Target& target, const Point3& from) {
    const Point3 d = target.middle() - from;
    return 1 - (target.radius + .5 * target.length()) / std::sqrt(dot(d, d)) - 1e-4;
  }

  /// Which of the targets a ray from the eye hits.
  void look(TargetRays& rays, Target* targets, std::size_t count, TraceCounts& n) const {
    for (std::size_t i = 0; i < count; ++i)
      rays.set(i, to_.eye(targets[i].middle()), targets[i].middle(), 0);
    closest(rays, rays, count, n);
    const auto before = [&](std::size_t i) {
      return rays.id[i] != kNoPrimitive &&
             static_cast<double>(rays.t[i]) < near(targets[i], to_.eye(targets[i].middle()));
    };
    for (int k = 0; k < kMostClear; ++k) {
      bool any = false;
      for (std::size_t i = 0; i < count; ++i)
        if (before(i) &&
            world_.shading.materials.field[kTransmission][material_of(rays.id[i])] > 0) {
          rays.t_min[i] = rays.t[i] * 1.00001f;
          any = true;
        }
      if (!any)
        break;
      closest(rays, rays, count, n);
    }
    for (std::size_t i = 0; i < count; ++i)
      targets[i].hits_target = !before(i);
  }

  /// The brightest that a thing may look, over white.
  float brightness(std::uint32_t material) const {
    float most = 1;
    for (const MaterialField c : {kEmissionR, kEmissionG, kEmissionB})
      most = std::max(most, world_.shading.materials.field[c][material]);
    return most;
  }

  void mark(const Target& target) {
    const ToPicture::Spot a = to_(target.end[0]), b = to_(target.end[1]);
    const double depth = std::min(a.depth, b.depth);
    if (!(depth > 0) || !(blur(depth) <= kMostBlur))
      return;
    const double half_width = to_.half_width(target.radius, depth) + blur(depth) + kMargin;
    double wide = .5 * std::abs(b.x - a.x) + half_width,
           high = .5 * std::abs(b.y - a.y) + half_width;
    // a thing too large for a box is hit as surely by samples of its middle
    const double area = 4 * wide * high;
    if (const double shrink = std::sqrt(kBoxTaken / area); shrink < 1) {
      wide *= shrink;
      high *= shrink;
    }
    const double x0 = .5 * (a.x + b.x) - wide, x1 = .5 * (a.x + b.x) + wide;
    const double y0 = .5 * (a.y + b.y) - high, y1 = .5 * (a.y + b.y) + high;
    const auto first = [](double least) { return static_cast<int>(std::max(0., least)); };
    const auto end = [](double most, int size) {
      return most < 0 ? 0 : static_cast<int>(std::min(most + 1, static_cast<double>(size)));
    };
    const float bright = brightness(target.material);
    for (int y = first(y0); y < end(y1, r_.height); ++y)
      for (int x = first(x0); x < end(x1, r_.width); ++x)
        add_box(x, y, {side(x0 - x), side(y0 - y), side(x1 - x), side(y1 - y)}, bright);
  }

  static float side(double v) { return static_cast<float>(std::clamp(v, 0., 1.)); }

  void add_box(int x, int y, PixelBox box, float bright) {
    std::uint32_t& word = r_.box[static_cast<std::size_t>(y) * static_cast<std::size_t>(r_.width) +
                                 static_cast<std::size_t>(x)];
    if (word != 0) {
      const PixelBox other = unpacked(word);
      box = {std::min(box.x0, other.x0),
             std::min(box.y0, other.y0),
             std::max(box.x1, other.x1),
             std::max(box.y1, other.y1)};
    }
    const std::uint32_t packed_box = packed(box);
    if (packed_box == 0 || unpacked(packed_box).area() > kLargestBox)
      return;
    word = packed_box;
    // a disc in the box that no sample hit, as though it were black or white
    const float most = std::min(1.f, kDiscInBox * unpacked(word).area() * bright);
    const Blocks blocks = r_.blocks();
    const std::size_t b = blocks.of(x, y);
    r_.missed[b] += most * most / static_cast<float>(blocks.pixels(b));
  }

  const World::Impl& world_;
  const Setup& setup_;
  const int threads_;
  const ToPicture to_;
  Refinement& r_;
  TraceCounts& counts_;
  const std::vector<Capsule> capsules_;
};

}  // namespace

void target_small_objects(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts) {
  TargetSearch(world, setup, threads, r, counts).run();
}

}  // namespace grelha
