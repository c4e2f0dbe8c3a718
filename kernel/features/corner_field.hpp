#pragma once
// Rays through the corners of a tile's pixels, and what becomes of them in mirrors, behind clear
// surfaces and on the way from lights. Beams side by side share corners, and a ray takes a third of
// the time when a field of them is traced together.

#include <memory>

#include "kernel/features/same_surface.hpp"
#include "kernel/scene/pixel_box.hpp"
#include "kernel/scene/refraction.hpp"
#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

/// Corners of the pixels of a tile: of its rows, and of all.
inline constexpr int kCornersARow = kTile + 1;
inline constexpr int kTileCorners = kCornersARow * kCornersARow;

/// Whether a primitive sends on enough light to be followed: `least` by a mirror.
inline bool is_bent(const SceneView& scene,
                    const ShadingView& shading,
                    std::uint32_t id,
                    float least = kLeastMirror) {
  const std::uint32_t m = material_of_any(scene.geometry, id);
  return shading.materials.field[kTransmission][m] > 0 ||
         largest(material_color(shading.materials, m, kMirrorR)) >= least;
}

/// A ray to be traced.
struct StartedRay {
  Vec3f org, dir;
};

/// The ray in the mirror of a surface.
inline StartedRay mirrored_ray(const Vec3f& dir, const Surface<float>& s) {
  const float across = dot(dir, s.shading);
  return {s.point + s.away * s.normal, normalize(dir - (across + across) * s.shading)};
}

/// What light does at a clear surface, seen along `dir`.
inline Refraction<float> refraction_at(const Vec3f& dir,
                                       const Surface<float>& s,
                                       float ior,
                                       bool within) {
  return snell(ior, within, 0 - dot(s.shading, dir));
}

/// The ray that it lets through.
inline StartedRay passed_ray(const Vec3f& dir,
                             const Surface<float>& s,
                             const Refraction<float>& refraction) {
  return {s.point - s.away * s.normal,
          normalize(passed_on(refraction, s.shading, Vec3f{0, 0, 0} - dir))};
}

/// A surface that a ray met, its normals towards where the ray came from.
struct FacedSurface {
  Surface<float> surface;
  bool within;  ///< the ray came from inside
};

/// Four corners around a square, in order.
struct SquareCorners {
  int at[kCorners];

  int operator[](int i) const { return at[i]; }
};

/// Rays of some corners, and their nearest hits.
struct CornerRays {
  bool there[kTileCorners] = {};
  Vec3f org[kTileCorners], dir[kTileCorners];
  std::uint32_t id[kTileCorners];
  float t[kTileCorners];

  void set(int at, const StartedRay& ray) {
    there[at] = true;
    org[at] = ray.org;
    dir[at] = ray.dir;
  }

  void trace(const SceneView& scene, Counters& n) {
    int places[kTileCorners];
    int count = 0;
    for (int at = 0; at < kTileCorners; ++at)
      if (there[at])
        places[count++] = at;
    for (int first = 0; first < count; first += kTile * kTile)
      trace(scene, places + first, lesser(count - first, kTile * kTile), n);
  }

 private:
  static int lesser(int a, int b) { return a < b ? a : b; }

  void trace(const SceneView& scene, const int* places, int count, Counters& n) {
    Packet<InFloat> p;
    p.size = count;
    for (int i = 0; i < count; ++i)
      set_ray(p, i, org[places[i]], dir[places[i]], kInfinity);
    trace_packet<false>(scene, p, {kTile * kTile, true}, n);
    for (int i = 0; i < count; ++i) {
      id[places[i]] = id_of(p.id[i]);
      t[places[i]] = t_of(p, i);
    }
  }
};

/// Rays from a light to what the corners met.
struct LightRays : CornerRays {
  float length[kTileCorners];
};

/// Rays of some corners of a tile. What comes of them is found when it is first asked for, of all
/// of them at once.
class CornerField {
 public:
  CornerField(const SceneView& scene, const ShadingView& shading, Counters& counters)
      : scene_(scene), shading_(shading), n_(counters) {}

  /// Adds a ray; call trace() after the last. `lights`: bits of those it may be asked about.
  void set(int at, const StartedRay& ray, std::uint64_t lights) {
    rays_.set(at, ray);
    lights_of_[at] = lights;
  }
  void trace() { rays_.trace(scene_, n_); }

  std::uint32_t id(int at) const { return rays_.id[at]; }
  const CornerRays& rays() const { return rays_; }

  /// What a corner's ray met; it has met something.
  const FacedSurface& faced(int at) {
    if (!known_[at]) {
      known_[at] = true;
      faced_[at] = face(at);
    }
    return faced_[at];
  }

  /// In the mirrors that corners met: where there is none, rays are missing.
  CornerField& mirrored() {
    if (!mirrored_)
      mirrored_ = child([&](int at, StartedRay& ray) {
        ray = mirrored_ray(rays_.dir[at], faced(at).surface);
        return field(at, kTransmission) > 0 || largest(mirror(at)) > 0;
      });
    return *mirrored_;
  }

  /// Behind the clear surfaces that corners met: where there is none, or light is reflected as a
  /// whole, rays are missing.
  CornerField& passed() {
    if (!passed_)
      passed_ = child([&](int at, StartedRay& ray) {
        const auto& [s, within] = faced(at);
        const Refraction<float> r = refraction_at(rays_.dir[at], s, field(at, kIor), within);
        ray = passed_ray(rays_.dir[at], s, r);
        return field(at, kTransmission) > 0 && r.passes;
      });
    return *passed_;
  }

  /// From light l to what corners met that may be asked about it; of lights without a bit of their
  /// own, to these four alone.
  const LightRays& from_light(int l, const SquareCorners& corners) {
    std::unique_ptr<LightRays>& rays = from_lights_[l < kLightBits ? l : kLightBits];
    if (rays && l < kLightBits)
      return *rays;
    rays = std::make_unique_for_overwrite<LightRays>();
    if (l < kLightBits)
      for (int at = 0; at < kTileCorners; ++at)
        set_from(l, at, *rays);
    else
      for (const int at : corners.at)
        set_from(l, at, *rays);
    rays->trace(scene_, n_);
    return *rays;
  }

 private:
  FacedSurface face(int at) const {
    const Vec3f zero{0, 0, 0};
    const Vec3f dir = rays_.dir[at];
    Surface<float> s = surface_of<float>(
        scene_.geometry, rays_.id[at], rays_.org[at], dir, rays_.t[at], shading_.smooth);
    const bool within = dot(dir, s.normal) > 0;
    if (within) {
      s.normal = zero - s.normal;
      s.shading = zero - s.shading;
    }
    return {s, within};
  }

  float field(int at, MaterialField k) {
    return shading_.materials.field[k][faced(at).surface.material];
  }
  Vec3f mirror(int at) {
    return material_color(shading_.materials, faced(at).surface.material, kMirrorR);
  }

  /// The rays that go on as `make` says, if it does.
  template <class Make>
  std::unique_ptr<CornerField> child(const Make& make) {
    auto of = std::make_unique<CornerField>(scene_, shading_, n_);
    StartedRay ray;
    for (int at = 0; at < kTileCorners; ++at)
      if (rays_.there[at] && rays_.id[at] != kNoPrimitive && make(at, ray))
        of->set(at, ray, ~std::uint64_t{0});
    of->trace();
    return of;
  }

  /// Adds the ray from a light to what a corner met, if it may be asked for.
  void set_from(int l, int at, LightRays& to) {
    if (!rays_.there[at] || rays_.id[at] == kNoPrimitive || !(lights_of_[at] >> l % kLightBits & 1))
      return;
    const float* const light = shading_.lights + kLightFloats * l;
    const Vec3f from{light[0], light[1], light[2]};
    const Surface<float>& s = faced(at).surface;
    const Vec3f way = s.point + s.away * s.normal - from;
    to.length[at] = length(way);
    to.set(at, {from, (1 / to.length[at]) * way});
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  Counters& n_;
  CornerRays rays_;
  std::uint64_t lights_of_[kTileCorners];
  bool known_[kTileCorners] = {};
  FacedSurface faced_[kTileCorners];
  std::unique_ptr<CornerField> mirrored_, passed_;
  std::unique_ptr<LightRays> from_lights_[kLightBits + 1];
};

/// A square of a field: a beam through its corners.
struct FieldSquare {
  CornerField& field;
  SquareCorners at;
  float growth;

  Beam beam() const {
    Beam b;
    for (int i = 0; i < kCorners; ++i) {
      b.org[i] = field.rays().org[at[i]];
      b.dir[i] = field.rays().dir[at[i]];
    }
    b.growth = growth;
    return b;
  }
};

}  // namespace grelha::GRELHA_ISA
