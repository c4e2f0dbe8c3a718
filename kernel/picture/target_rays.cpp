#include "kernel/picture/target_rays.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "kernel/picture/tolerances.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/shade/pixel_box.hpp"
#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

constexpr double kThin = 1;         ///< pixels: samples of a net hit everything wider
constexpr double kMostParts = 256;  ///< parts of a capsule
constexpr int kMostClear = 6;       ///< transparent surfaces on the way to a thing
constexpr double kMostBlur = .25;   ///< pixels: a box holds too little of a thing with more blur
constexpr double kBoxTaken = .9 * static_cast<double>(kLargestBox);  ///< sides are rounded up
constexpr double kMargin = .02;  ///< pixels around a box, for rounding
constexpr std::size_t kRaysOfTurn = 256;

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

std::vector<Capsule> capsules_of(const World::Impl& world) {
  const GeometrySpans& g = world.primitives.geometry;
  std::vector<Capsule> capsules = mesh_parts(g.triangles);
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
        capsules_(capsules_of(world)) {}

  void run() {
    std::vector<Target> targets =
        targets_from_camera([](const Capsule& capsule) { return capsule; });
    each_turn_of(targets,
                 [&](TargetRays& rays, std::size_t first, std::size_t count, TraceCounts& n) {
                   look(rays, targets.data() + first, count, n);
                 });
    mark(targets);
    for (const MirrorPlane& mirror : flat_mirrors(world_))
      look_into(mirror);
    // blurred shadows are hit by samples; many lights leave little of each shadow to see
    std::size_t left = r_.box.size();
    const ShadingView& shading = setup_.shading;
    for (int l = 0; !shading.area && l < shading.light_count; ++l) {
      const float* const at = shading.lights + kLightFloats * l;
      if (left < capsules_.size())
        break;
      left -= capsules_.size();
      throw_shadows({{at[0], at[1], at[2]}});
    }
  }

 private:
  template <class Work>
  void each_turn_of(const std::vector<Target>& targets, const Work& work) {
    const std::size_t turns = (targets.size() + kRaysOfTurn - 1) / kRaysOfTurn;
    std::vector<TraceCounts> counts(turns);
    each_turn(
        turns,
        threads_,
        [] { return std::make_unique<TargetRays>(); },
        [&](std::size_t turn, const std::unique_ptr<TargetRays>& rays) {
          const std::size_t first = turn * kRaysOfTurn;
          work(*rays, first, std::min(kRaysOfTurn, targets.size() - first), counts[turn]);
        });
    for (const TraceCounts& n : counts)
      counts_ += n;
  }

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

  /// At where capsules seem to be.
  template <class Place>
  std::vector<Target> targets_from_camera(const Place& place) const {
    std::vector<ThinCapsule> thin;
    for (const Capsule& real : capsules_) {
      Capsule capsule = place(real);
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

  /// Marks where thin capsules show in a mirror.
  void look_into(const MirrorPlane& mirror) {
    std::vector<Target> targets = targets_from_camera([&](Capsule capsule) {
      for (Point3& end : capsule.end)
        end = mirror.image(end);
      return capsule;
    });
    each_turn_of(targets,
                 [&](TargetRays& rays, std::size_t first, std::size_t count, TraceCounts& n) {
                   look_by_mirror(mirror, rays, targets.data() + first, count, n);
                 });
    mark(targets);
  }

  /// Which of the images a ray from the eye arrives at by way of the mirror.
  void look_by_mirror(const MirrorPlane& mirror,
                      TargetRays& rays,
                      Target* targets,
                      std::size_t count,
                      TraceCounts& n) const {
    for (std::size_t i = 0; i < count; ++i)
      rays.set(i, to_.eye(targets[i].middle()), targets[i].middle(), 0);
    closest(rays, rays, count, n);
    for (std::size_t i = 0; i < count; ++i) {
      const Point3 image = targets[i].middle(), eye = to_.eye(image);
      const double eye_above = mirror.above(eye), all = eye_above - mirror.above(image);
      const double t = eye_above / all;  // where the way to the image crosses the mirror
      targets[i].hits_target = rays.id[i] != kNoPrimitive && t > 0 && t < 1 &&
                               std::abs(static_cast<double>(rays.t[i]) - t) <= 1e-3 * t &&
                               is_smooth_mirror(world_.shading.materials, material_of(rays.id[i]));
      Point3 at = eye;
      for (std::size_t a = 0; a < 3 && targets[i].hits_target; ++a)
        at[a] += t * (image[a] - eye[a]);
      rays.set(i, at, mirror.image(image), 1e-4);
    }
    closest(rays, rays, count, n);
    for (std::size_t i = 0; i < count; ++i) {
      Target real = targets[i];
      for (Point3& end : real.end)
        end = mirror.image(end);
      const Point3 from{{rays.org[0][i], rays.org[1][i], rays.org[2][i]}};
      targets[i].hits_target =
          targets[i].hits_target &&
          (rays.id[i] == kNoPrimitive || static_cast<double>(rays.t[i]) >= near(real, from));
    }
  }

  /// Marks where shadows of thin capsules fall, if the eye sees that.
  void throw_shadows(const Point3& light) {
    std::vector<ThinCapsule> thin;
    for (const Capsule& capsule : capsules_)
      if (const double pixel = to_.pixel(std::abs(to_(capsule.end[0]).depth));
          capsule.radius < kThin * pixel)
        thin.push_back({capsule, pixel});
    std::vector<Target> targets = parts_of(thin);
    each_turn_of(targets,
                 [&](TargetRays& rays, std::size_t first, std::size_t count, TraceCounts& n) {
                   cast_shadows(rays, light, targets.data() + first, count, n);
                 });
    mark(targets);
  }

  /// Moves things on to the surfaces behind them.
  void cast_shadows(TargetRays& rays,
                    const Point3& light,
                    Target* targets,
                    std::size_t count,
                    TraceCounts& n) const {
    for (std::size_t i = 0; i < count; ++i)
      rays.set(i, light, targets[i].middle(), 2 - near(targets[i], light));
    closest(rays, rays, count, n);
    for (std::size_t i = 0; i < count; ++i) {
      targets[i].hits_target = rays.id[i] != kNoPrimitive;
      if (!targets[i].hits_target)
        continue;
      const double t = static_cast<double>(rays.t[i]);
      for (Point3& end : targets[i].end)
        for (std::size_t a = 0; a < 3; ++a)
          end[a] = light[a] + t * (end[a] - light[a]);
      targets[i].radius *= t;
    }
    for (std::size_t i = 0; i < count; ++i)
      rays.set(i, to_.eye(targets[i].middle()), targets[i].middle(), 0);
    closest(rays, rays, count, n);
    for (std::size_t i = 0; i < count; ++i)
      targets[i].hits_target =
          targets[i].hits_target && rays.id[i] != kNoPrimitive && rays.t[i] > .999f;
  }

  /// The brightest that a thing may look, over white.
  float brightness(std::uint32_t material) const {
    float most = 1;
    for (const MaterialField c : {kEmissionR, kEmissionG, kEmissionB})
      most = std::max(most, world_.shading.materials.field[c][material]);
    return most;
  }

  void mark(const std::vector<Target>& targets) {
    for (const Target& target : targets)
      if (target.hits_target)
        mark(target);
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

std::size_t object_count(const World::Impl& world) {
  const GeometrySpans& g = world.primitives.geometry;
  return g.spheres.size() + g.cones.size() + g.triangles.size();
}

void target_small_objects(
    const World::Impl& world, const Setup& setup, int threads, Refinement& r, TraceCounts& counts) {
  TargetSearch(world, setup, threads, r, counts).run();
}

}  // namespace grelha
