#include "kernel/picture/sampling_round.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "grelha/geometry.hpp"
#include "kernel/picture/tolerances.hpp"
#include "kernel/shade/pixel_box.hpp"

namespace grelha {
namespace {

constexpr float kThin = 1;         ///< pixels: samples of a net hit everything wider
constexpr float kMostParts = 256;  ///< parts of a capsule
constexpr float kFarPart = 1e4f;   ///< pixels: longer parts lie beyond a picture, or nowhere
constexpr float kMostBlur = .25f;  ///< pixels: a box holds too little of an object with more blur
constexpr float kBoxTaken = .9f * kLargestBox;  ///< sides are rounded up
constexpr float kMargin = .02f;                 ///< pixels around a box, for rounding
/// Uses of two vertices of a triangle that is alone or one of a few: more are a surface, which
/// samples see.
constexpr std::uint8_t kMostUses = 2;
constexpr std::size_t kMostMirrors = 6;  ///< of a box of mirrors
constexpr float kSamePlane = 1e-4f;      ///< float corners of one polygon

/// All of an object lies within `radius` of the stretch between its ends.
struct Capsule {
  Float3 end[2];
  float radius;
  std::uint32_t material;
};

float length(Float3 a) {
  return std::sqrt(dot(a, a));
}

Float3 corner_of(const TriangleSpans& t, std::uint32_t vertex) {
  return {t.x[vertex], t.y[vertex], t.z[vertex]};
}

/// Along the longest side.
Capsule capsule_of(const TriangleSpans& t, std::size_t i) {
  Float3 a = corner_of(t, t.a[i]), b = corner_of(t, t.b[i]), c = corner_of(t, t.c[i]);
  if (length(c - b) > length(b - a))
    std::swap(a, c);
  if (length(c - a) > length(b - a))
    std::swap(b, c);
  const float side = length(b - a);
  return {{a, b}, side > 0 ? length(cross(b - a, c - a)) / side : 0, t.material[i]};
}

/// Calls visit(capsule) for spheres, cones and triangles that are no part of a surface.
template <class Visit>
void each_capsule(const GeometrySpans& g,
                  const std::vector<std::uint8_t>& uses,
                  const Visit& visit) {
  const SphereSpans& s = g.spheres;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Float3 centre{s.x[i], s.y[i], s.z[i]};
    visit(Capsule{{centre, centre}, std::abs(s.radius[i]), s.material[i]});
  }
  const ConeSpans& c = g.cones;
  for (std::size_t i = 0; i < c.size(); ++i)
    visit(
        Capsule{{{c.base_x[i], c.base_y[i], c.base_z[i]}, {c.apex_x[i], c.apex_y[i], c.apex_z[i]}},
                std::max(std::abs(c.base_radius[i]), std::abs(c.apex_radius[i])),
                c.material[i]});
  const TriangleSpans& t = g.triangles;
  for (std::size_t i = 0; i < t.size(); ++i)
    if ((uses[t.a[i]] <= kMostUses) + (uses[t.b[i]] <= kMostUses) + (uses[t.c[i]] <= kMostUses) > 1)
      visit(capsule_of(t, i));
}

/// The plane of points p with dot(normal, p) = distance.
struct MirrorPlane {
  Float3 normal;  ///< a unit vector
  float distance;

  float above(Float3 p) const { return dot(normal, p) - distance; }
  Float3 image(Float3 p) const { return p - 2 * above(p) * normal; }
};

/// Planes of smooth mirrors, each once; none if there are more than a few, as in a curved mirror.
std::vector<MirrorPlane> flat_mirrors(const World::Impl& world) {
  std::vector<MirrorPlane> planes;
  const MaterialView& materials = world.shading.materials;
  const auto add = [&](std::uint32_t m, Float3 point, Float3 normal) {
    const bool mirrors = std::max({materials.field[kMirrorR][m],
                                   materials.field[kMirrorG][m],
                                   materials.field[kMirrorB][m]}) > 0 &&
                         materials.field[kRoughness][m] == 0;
    if (!mirrors || !(length(normal) > 0) || planes.size() > kMostMirrors)
      return;
    MirrorPlane plane{normalized(normal), 0};
    plane.distance = dot(plane.normal, point);
    for (const MirrorPlane& other : planes)
      if (std::abs(dot(plane.normal, other.normal)) > 1 - kSamePlane &&
          std::abs(other.above(point)) <= kSamePlane * (1 + std::abs(plane.distance)))
        return;
    planes.push_back(plane);
  };
  const GeometrySpans& g = world.primitives.geometry;
  for (std::size_t i = 0; world.shading.reflects && i < g.planes.size(); ++i)
    add(g.planes.material[i],
        {g.planes.x[i], g.planes.y[i], g.planes.z[i]},
        {g.planes.nx[i], g.planes.ny[i], g.planes.nz[i]});
  const TriangleSpans& t = g.triangles;
  for (std::size_t i = 0; world.shading.reflects && i < t.size(); ++i) {
    const Float3 a = corner_of(t, t.a[i]);
    add(t.material[i], a, cross(corner_of(t, t.b[i]) - a, corner_of(t, t.c[i]) - a));
  }
  if (planes.size() > kMostMirrors)
    planes.clear();
  return planes;
}

class SmallObjects {
 public:
  SmallObjects(const World::Impl& world, const FrameView& frame, Refinement& r)
      : world_(world), f_(frame), r_(r), bright_(r.box.size()) {
    for (std::size_t a = 0; a < 3; ++a) {
      ff_ += f_.forward[a] * f_.forward[a];
      rr_ += f_.right[a] * f_.right[a];
      uu_ += f_.up[a] * f_.up[a];
    }
  }

  void run() {
    const GeometrySpans& g = world_.primitives.geometry;
    std::vector<std::uint8_t> uses(g.triangles.vertex_count());
    for (std::size_t i = 0; i < g.triangles.size(); ++i)
      for (const std::uint32_t v : {g.triangles.a[i], g.triangles.b[i], g.triangles.c[i]})
        uses[v] = static_cast<std::uint8_t>(std::min(uses[v] + 1, 255));
    each_capsule(g, uses, [&](const Capsule& capsule) { mark(capsule); });
    const Float3 eye{f_.eye[0], f_.eye[1], f_.eye[2]};
    for (const MirrorPlane& mirror : flat_mirrors(world_))
      each_capsule(g, uses, [&](Capsule capsule) {
        if (mirror.above(capsule.end[0]) * mirror.above(eye) <= 0)
          return;
        for (Float3& end : capsule.end)
          end = mirror.image(end);
        mark(capsule);
      });
    expect_hits();
  }

 private:
  struct Spot {
    float x, y;   ///< pixels
    float depth;  ///< in lengths of `forward`
  };
  static float along(const float* axis, Float3 d) {
    return d.x * axis[0] + d.y * axis[1] + d.z * axis[2];
  }
  Spot project(Float3 p) const {
    const Float3 d = p - Float3{f_.eye[0], f_.eye[1], f_.eye[2]};
    const float depth = along(f_.forward, d) / ff_, shrink = f_.parallel ? 1 : depth;
    return {.5f * static_cast<float>(f_.width) + along(f_.right, d) / (rr_ * shrink),
            .5f * static_cast<float>(f_.height) - along(f_.up, d) / (uu_ * shrink),
            depth};
  }
  /// How wide a pixel is.
  float pixel(float depth) const { return (f_.parallel ? 1 : depth) * std::sqrt(rr_); }
  /// Radius of the disc that a point shows as, in pixels.
  float blur(float depth) const {
    if (!f_.lens)
      return 0;
    const Float3 right{f_.lens_right[0], f_.lens_right[1], f_.lens_right[2]};
    const float ratio = f_.parallel ? depth / f_.focus : f_.focus / depth;
    return std::abs(ratio - 1) * length(right) / pixel(f_.focus);
  }

  /// Marks the pixels of a capsule that looks thin, part by part, each a pixel long.
  void mark(const Capsule& capsule) {
    const Spot a = project(capsule.end[0]), b = project(capsule.end[1]);
    const float depth = std::min(a.depth, b.depth);
    if (!(depth > 0) || !(2 * capsule.radius < kThin * pixel(depth)) || !(blur(depth) <= kMostBlur))
      return;
    // balls look longer in the corners of a picture
    const float corner = f_.parallel ? 0
                                     : .25f * (static_cast<float>(f_.width * f_.width) * rr_ +
                                               static_cast<float>(f_.height * f_.height) * uu_);
    const float reach =
        capsule.radius / pixel(depth) * std::sqrt(1 + corner / ff_) + blur(depth) + kMargin;
    const float parts =
        std::clamp(std::ceil(std::max(std::abs(a.x - b.x), std::abs(a.y - b.y))), 1.f, kMostParts);
    const float dx = (b.x - a.x) / parts, dy = (b.y - a.y) / parts;
    if (!(std::abs(dx) + std::abs(dy) < kFarPart))
      return;
    for (float k = 0; k < parts; ++k)
      mark_part(a.x + (k + .5f) * dx,
                a.y + (k + .5f) * dy,
                .5f * std::abs(dx) + reach,
                .5f * std::abs(dy) + reach,
                brightness(capsule.material));
  }

  /// `wide`, `high`: half of the part.
  void mark_part(float x, float y, float wide, float high, float bright) {
    // an object too large for a box is hit as surely by samples of its middle
    if (const float shrink = std::sqrt(kBoxTaken / (4 * wide * high)); shrink < 1) {
      wide *= shrink;
      high *= shrink;
    }
    const auto within = [](float v, int size) {
      return static_cast<int>(std::clamp(v, 0.f, static_cast<float>(size)));
    };
    const float x0 = x - wide, x1 = x + wide, y0 = y - high, y1 = y + high;
    for (int j = within(y0, r_.height); j < within(y1 + 1, r_.height); ++j)
      for (int i = within(x0, r_.width); i < within(x1 + 1, r_.width); ++i) {
        const auto fi = static_cast<float>(i), fj = static_cast<float>(j);
        add_box(static_cast<std::size_t>(j) * static_cast<std::size_t>(r_.width) +
                    static_cast<std::size_t>(i),
                {side(x0 - fi), side(y0 - fj), side(x1 - fi), side(y1 - fj)},
                bright);
      }
  }
  static float side(float v) { return std::clamp(v, 0.f, 1.f); }

  /// A negative brightness: the pixel's objects need no box.
  void add_box(std::size_t p, PixelBox box, float bright) {
    if (bright_[p] < 0)
      return;
    if (r_.box[p] != 0) {
      const PixelBox other = unpacked(r_.box[p]);
      box = {std::min(box.x0, other.x0),
             std::min(box.y0, other.y0),
             std::max(box.x1, other.x1),
             std::max(box.y1, other.y1)};
    }
    const std::uint32_t word = packed(box);
    const bool fits = word != 0 && unpacked(word).area() <= kLargestBox;
    r_.box[p] = fits ? word : 0;
    bright_[p] = fits ? std::max(bright_[p], bright) : -1;
  }

  /// The brightest that an object may look, over white.
  float brightness(std::uint32_t material) const {
    float most = 1;
    for (const MaterialField c : {kEmissionR, kEmissionG, kEmissionB})
      most = std::max(most, world_.shading.materials.field[c][material]);
    return most;
  }

  /// Until samples tell, a disc in each box counts as missed, as though it were black or white.
  void expect_hits() {
    const Blocks blocks = r_.blocks();
    for (std::size_t p = 0; p < r_.box.size(); ++p) {
      if (r_.box[p] == 0)
        continue;
      const float most = std::min(1.f, kDiscInBox * unpacked(r_.box[p]).area() * bright_[p]);
      const std::size_t b = blocks.of_pixel(p);
      r_.missed[b] += most * most / static_cast<float>(blocks.pixels(b));
    }
  }

  const World::Impl& world_;
  const FrameView& f_;
  Refinement& r_;
  std::vector<float> bright_;  ///< [pixels] of the objects in its box
  float ff_ = 0, rr_ = 0, uu_ = 0;
};

}  // namespace

void mark_small_objects(const World::Impl& world, const FrameView& frame, Refinement& r) {
  SmallObjects(world, frame, r).run();
}

}  // namespace grelha
