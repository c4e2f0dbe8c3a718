// The kernel's own surfaces and samples, in their scalar form: only the making of rays is done with
// it, never the timing.
#define GRELHA_ISA scalar
#include "perf/ray_sets.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "frontend/input/effects.hpp"
#include "kernel/scene/shading_view.hpp"
#include "kernel/shade/strip.hpp"
#include "kernel/shade/sampling.hpp"
#include "kernel/shapes/surface.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha::perf {

using namespace grelha::scalar;
using V = Vec3<float>;

namespace {

constexpr int kSamples = 16, kSide = 4;
constexpr int kStrip = 4;         ///< tiles side by side
constexpr int kMostAcross = 512;  ///< pixels with rays, in a row of the picture
constexpr float kRoughness = .1f;
/// Rays start this many times as far from their surface as Grelha's own bound of its errors asks
/// for, so that no timed ray hits the surface that it left.
constexpr float kClearance = 8;
/// times the scene's width: error of the large triangles that replace planes in Embree
constexpr float kPlaneClearance = 4e-5f;

void add(RayBuffer& rays, const V& org, const V& dir, float t_end) {
  rays.add({org.x, org.y, org.z}, {dir.x, dir.y, dir.z}, t_end);
}

/// Uniform in [0, 1), the same numbers everywhere.
struct Random {
  std::mt19937 bits{1};
  float operator()() { return unit_float(static_cast<std::uint32_t>(bits())); }
  /// In field i of the square of kSide x kSide.
  Pair jittered(int i) {
    const float u = (static_cast<float>(i % kSide) + (*this)()) / kSide;
    const float v = (static_cast<float>(i / kSide) + (*this)()) / kSide;
    return {u, v};
  }
};

}  // namespace

struct FirstHit {
  V point, normal, mirror;  ///< normal: geometric, unit, towards the viewer; mirror: unit
  float offset;
  V start() const { return point + offset * normal; }
};

RayMaker::RayMaker(const SceneFile& file, const World& world, int size) : world_(world) {
  SceneFile own;
  own.camera = file.camera;
  own.lens = file.lens;
  own.scene.lights = file.scene.lights;
  Effects effects;
  effects.samples = kSamples;
  if (!(file.lens.present && file.lens.aperture > 0))
    effects.lens = Effects::Lens{.aperture = 12};
  if (!own.scene.lights.empty()) {
    const Float3 p = own.scene.lights[0].position, at = own.camera.at;
    effects.shadows =
        Effects::Shadows{.size = .1f * std::hypot(p.x - at.x, p.y - at.y, p.z - at.z)};
  }
  RenderOptions unused;
  apply_effects(effects, own, unused);
  if ((lit_ = !own.scene.lights.empty()))
    light_ = own.scene.lights[0];
  Camera camera = own.camera;
  camera.width = camera.height = size;
  lens_ = make_frame(camera);
  camera.aperture = 0;
  pinhole_ = make_frame(camera);
}

RayBuffer RayMaker::through_pixels(const FrameView& f, int samples, bool few) const {
  SamplePlan plan;
  plan.on = samples > 1;
  plan.samples = samples;
  plan.lens = 2;
  const auto batch = std::make_unique<Batch>();
  RayBuffer rays;
  // Strips, of each block of strips one: what a render has in a packet of 256.
  const int block = std::max(1, f.width / kMostAcross) * (few ? kSide : 1),
            strip = std::min(kStrip, f.width / kTile / block);
  for (int by = 0; by < f.width / (kTile * block); ++by)
    for (int bx = 0; bx < f.width / (strip * kTile * block); ++bx) {
      const auto pick = scatter(static_cast<std::uint32_t>(bx), static_cast<std::uint32_t>(by));
      const int x0 =
          (bx * block + static_cast<int>(pick % static_cast<unsigned>(block))) * strip * kTile;
      const int y0 =
          (by * block + static_cast<int>(pick / 64 % static_cast<unsigned>(block))) * kTile;
      for (int k = 0; k < strip * kTile * kTile; ++k) {
        const int in = k % (kTile * kTile), x = x0 + k / (kTile * kTile) * kTile + tile_x(in),
                  y = y0 + tile_y(in);
        for (int i = 0; i < samples; ++i) {
          batch->rays.org.x[i] = static_cast<float>(x);
          batch->rays.org.y[i] = static_cast<float>(y);
          batch->rays.pixel[i] = static_cast<std::uint32_t>(y * f.width + x);
          batch->rays.sample[i] = static_cast<std::uint32_t>(i);
        }
        scalar::camera_rays(f, {.batch = batch.get(), .plan = plan}, samples, true);
        for (int i = 0; i < samples; ++i)
          rays.add({batch->rays.org.x[i], batch->rays.org.y[i], batch->rays.org.z[i]},
                   {batch->rays.dir.x[i], batch->rays.dir.y[i], batch->rays.dir.z[i]},
                   kInfinity);
      }
    }
  return rays;
}

std::vector<FirstHit> RayMaker::first_hits(bool few) const {
  return hits_of(through_pixels(pinhole_, 1, few));
}

std::vector<FirstHit> RayMaker::hits_of(const RayBuffer& rays) const {
  const SceneView& scene = world_.impl().view;
  Answers found;
  TraceCounts unused;
  trace(world_, *find_variant("best"), {}, rays.view(), false, found, unused);
  float extent = 0;
  for (int a = 0; a < 3 && scene.finite; ++a)
    extent = std::max(extent, scene.box_hi[a] - scene.box_lo[a]);
  std::vector<FirstHit> hits;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (found.id[i] == kNoPrimitive)
      continue;
    const V org{rays.ox[i], rays.oy[i], rays.oz[i]}, d{rays.dx[i], rays.dy[i], rays.dz[i]};
    const Surface<float> s = surface_of<float>(
        scene.geometry, found.id[i], org, d, found.t[i], world_.impl().shading.smooth);
    const float side = dot(d, s.normal) > 0 ? -1.f : 1.f;
    FirstHit h;
    h.point = s.point;
    h.normal = side * s.normal;
    const V n = side * s.shading, reflected = d - (2 * dot(d, n)) * n;
    // kept above the surface, as shading does
    h.mirror = normalize(reflected - (2 * min(dot(reflected, h.normal), 0.f)) * h.normal);
    h.offset = kClearance * s.offset;
    if (scene.geometry.ids.has(PrimitiveKind::kPlane, found.id[i]))
      h.offset += kPlaneClearance * (extent + largest(s.point));
    hits.push_back(h);
  }
  return hits;
}

namespace {

/// Rays from first hits, to a light or on.
struct Bounces {
  const Light& light;
  bool lit;
  Random random{};
  RayBuffer rays{};

  bool facing(const FirstHit& h, const Float3& at) const;
  Float3 on_light(float u, float v) const;
  void add_shadow(const FirstHit& h, const Float3& at);
  void add_area(const FirstHit& h);
  void add_glossy(const FirstHit& h);
  void add_diffuse(const FirstHit& h);
  void add_rays(RayKind kind, const FirstHit& h);
};

/// Returns true if a render would trace a shadow ray to `at`.
bool Bounces::facing(const FirstHit& h, const Float3& at) const {
  return dot(h.normal, V{at.x, at.y, at.z} - h.start()) > 0;
}

/// A place on the first light, from its middle in its edges.
Float3 Bounces::on_light(float u, float v) const {
  const Float3 &p = light.position, &e = light.edge1, &f = light.edge2;
  return {p.x + (u * e.x + v * f.x), p.y + (u * e.y + v * f.y), p.z + (u * e.z + v * f.z)};
}

void Bounces::add_shadow(const FirstHit& h, const Float3& at) {
  const V org = h.start(), dir = V{at.x, at.y, at.z} - org;
  // of unit length, as Embree's cone curves want them: with others a third of rays is wrong
  add(rays, org, normalize(dir), length(dir));
}

/// To places all over the light, where all its corners are in front.
void Bounces::add_area(const FirstHit& h) {
  bool all = lit;
  for (const float u : {-.5f, .5f})
    for (const float v : {-.5f, .5f})
      all = all && facing(h, on_light(u, v));
  for (int i = 0; all && i < kSamples; ++i) {
    const Pair at = random.jittered(i);
    add_shadow(h, on_light(at.u - .5f, at.v - .5f));
  }
}

/// About the mirrored direction, above the surface.
void Bounces::add_glossy(const FirstHit& h) {
  V u, v;
  across(h.mirror, u, v);
  for (int i = 0; i < kSamples; ++i) {
    const Pair d = disc_point(random.jittered(i));
    const V to = h.mirror + (kRoughness * d.u) * u + (kRoughness * d.v) * v;
    const V above = to - (2 * min(dot(to, h.normal), 0.f)) * h.normal;
    add(rays, h.start(), normalize(above), kInfinity);
  }
}

/// Towards a point of the disc, lifted to the half ball: density as the cosine.
void Bounces::add_diffuse(const FirstHit& h) {
  V u, v;
  across(h.normal, u, v);
  const float x = random(), y = random();
  const Pair d = disc_point(Pair{x, y});
  const float up = square_root(max(1 - (d.u * d.u + d.v * d.v), 1e-6f));
  add(rays, h.start(), normalize(d.u * u + d.v * v + up * h.normal), kInfinity);
}

void Bounces::add_rays(RayKind kind, const FirstHit& h) {
  switch (kind) {
    case RayKind::kShadow:
    case RayKind::kMirrorShadow:
      if (lit && facing(h, light.position))
        add_shadow(h, light.position);
      break;
    case RayKind::kArea:
      add_area(h);
      break;
    case RayKind::kMirror:
      add(rays, h.start(), h.mirror, kInfinity);
      break;
    case RayKind::kGlossy:
      add_glossy(h);
      break;
    default:
      add_diffuse(h);
  }
}

}  // namespace

RayBuffer RayMaker::make(RayKind kind) const {
  if (kind == RayKind::kPrimary)
    return through_pixels(pinhole_, 1, false);
  if (kind == RayKind::kLens)
    return through_pixels(lens_, kSamples, true);
  Bounces bounces{light_, lit_};
  if (kind == RayKind::kMirrorShadow) {
    for (const FirstHit& h : hits_of(make(RayKind::kMirror)))
      bounces.add_rays(kind, h);
    return bounces.rays;
  }
  for (const FirstHit& h : first_hits(kind == RayKind::kArea || kind == RayKind::kGlossy))
    bounces.add_rays(kind, h);
  return bounces.rays;
}

}  // namespace grelha::perf
