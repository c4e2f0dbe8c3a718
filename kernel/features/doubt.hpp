#pragma once
// What may hide from samples: whether the light that comes along a beam is known to be plain, or a
// feature may be in it that no sample has met. A function of the beam and the scene alone, not of
// grids or packets. docs/sampling.md says what it is for.
//
// Genetti, Gordon, Williams, "Adaptive Supersampling in Object Space Using Pyramidal Rays", 1998,
// move the decision from colours to objects; here the objects only say where to go on sampling.

#include "kernel/features/beam_search.hpp"
#include "kernel/features/closed_sheet.hpp"
#include "kernel/scene/refraction.hpp"

namespace grelha::GRELHA_ISA {

/// The weight, 0 to 1, of what may hide: `inside`, where something was met that no corner sees;
/// `around`, where the corners differ, or the beam cannot tell: what hides then shows in the pixels
/// around as well, whose colours bound it.
struct Doubt {
  float inside = 0;
  float around = 0;
  bool none() const { return inside == 0 && around == 0; }
};
inline Doubt around(float weight) {
  return {0, weight};
}
inline Doubt operator+(const Doubt& a, const Doubt& b) {
  return {greater(a.inside, b.inside), greater(a.around, b.around)};
}

/// The surfaces that a beam's corners met.
using CornerSurfaces = Surface<float>[kCorners];

/// How often a beam is still followed.
struct ToFollow {
  int mirrors;
  int clears;  ///< surfaces that it passes through
};

class Watcher {
 public:
  Watcher(const SceneView& scene, const ShadingView& shading, Counters& counters)
      : scene_(scene), shading_(shading), n_(counters) {}

  /// What may hide in the light that comes along the beam with `weight`. None: it is plain, one
  /// smooth surface under light that is whole or wholly blocked, and so in mirrors and behind clear
  /// surfaces, as far as they are followed. `whole`: only what is sure of each part of the beam
  /// counts, which is a surface that is one convex primitive, or a nearly flat patch of a mesh.
  Doubt doubt(const Beam& beam,
              bool whole,
              ToFollow follow,
              float weight,
              std::uint32_t mirror_id = kNoPrimitive) {
    BeamFrame f;
    if (!frame_of(beam, f))
      return around(weight);
    Sight sight;
    trace_corners(scene_, beam, sight, n_);
    const bool differ = corners_differ(sight.id, whole);
    if (whole && differ)
      return around(weight);
    const bool mesh = is_triangle(scene_.geometry, sight.id[0]);
    Met met;
    if (!collect(scene_, f, farthest_hit(f, beam, sight), sight.id, whole && !mesh, met, n_))
      return around(weight);
    if (whole && !is_patch(met, sight.id[0]))
      return around(weight);
    if (const Doubt found = hidden(f, met, sight.id, mirror_id, weight); !whole && !found.none())
      return found;
    if (differ || !closed(scene_.geometry, f, met, sight.id))
      return around(weight);
    if (sight.id[0] == kNoPrimitive)
      return {};
    CornerSurfaces s;
    bool within = false;
    if (!find_surfaces(beam, sight, s, within))
      return around(weight);
    const Doubt found = uneven_lights({s, sight.id, met, whole}, weight);
    const Way way{beam, s, sight.id[0], whole, follow, weight};
    if (field(s[0], kTransmission) > 0)
      return whole ? around(weight) : found + in_glass(way, within, found.inside);
    return found + in_mirror(way, largest(color(s[0], kMirrorR)), found.inside);
  }

 private:
  /// A beam that met a surface, and how far it is to be followed.
  struct Way {
    const Beam& beam;
    const CornerSurfaces& s;
    std::uint32_t id;  ///< of the surface
    bool whole;
    ToFollow follow;
    float weight;
  };

  /// What a beam's corners met: one surface.
  struct Patch {
    const CornerSurfaces& s;
    const std::uint32_t (&on)[kCorners];
    const Met& met;  ///< what else reaches into the beam
    bool whole;

    bool holds(std::uint32_t id) const {
      for (int i = 0; i < met.size; ++i)
        if (met.id[i] == id)
          return true;
      return any_of(on, [id](std::uint32_t corner) { return corner == id; });
    }
  };

  /// Whether corners met different surfaces, or, if `whole`, neither one convex primitive nor
  /// triangles that lie nearly in one plane.
  bool corners_differ(const std::uint32_t (&id)[kCorners], bool whole) const {
    const GeometryView& g = scene_.geometry;
    if (!whole)
      return !one_surface(g, id);
    return any_of(id, [&](std::uint32_t i) {
      return g.ids.has(PrimitiveKind::kCone, i) || !alike(g, id[0], i, kOnePatchSquared);
    });
  }

  /// Whether all that was met lies nearly in the plane of a triangle.
  bool is_patch(const Met& met, std::uint32_t front) const {
    for (int i = 0; i < met.size; ++i)
      if (!alike(scene_.geometry, front, met.id[i], kOnePatchSquared))
        return false;
    return true;
  }

  /// Sends rays to points first, first + 1, ... that were met, at most a packet of 16.
  void trace_points(const BeamFrame& f, const Met& met, int first, Packet<InFloat>& p) {
    p.size = met.size - first < 16 ? met.size - first : 16;
    for (int i = 0; i < p.size; ++i) {
      const Vec3f to = normalize(met.part[first + i].point - f.apex);
      const Vec3f start = f.apex + (f.depth / dot(to, f.unit)) * to;
      set_ray(p, i, start, to, kInfinity);
    }
    trace_packet<false>(scene_, p, {16, true}, n_);
  }

  /// Sends a ray to each point met. Where all of them end on what passes for a surface that the
  /// corners see, nothing hides; where one ends on another side of their mesh, that shows around as
  /// well.
  Doubt hidden(const BeamFrame& f,
               const Met& met,
               const std::uint32_t (&front)[kCorners],
               std::uint32_t mirror_id,
               float weight) {
    const GeometryView& g = scene_.geometry;
    Doubt found;
    for (int first = 0; first < met.size; first += 16) {
      Packet<InFloat> p;
      trace_points(f, met, first, p);
      for (int i = 0; i < p.size; ++i) {
        const std::uint32_t id = id_of(p.id[i]);
        if (any_of(front, [&](std::uint32_t seen) { return alike(g, seen, id); }))
          continue;
        if (!is_own_mirror(id, mirror_id) &&
            !any_of(front, [&](std::uint32_t seen) { return kin(g, seen, id); }))
          return {weight, weight};
        found = around(weight);
      }
    }
    return found;
  }

  /// Whether a bulging mirror stands in its own way.
  bool is_own_mirror(std::uint32_t id, std::uint32_t mirror_id) const {
    return mirror_id != kNoPrimitive && (id == mirror_id || kin(scene_.geometry, id, mirror_id));
  }

  /// The surfaces at the corners, their normals towards the beam, and whether it comes from
  /// `within`; false when they turn too far.
  bool find_surfaces(const Beam& beam, const Sight& sight, CornerSurfaces& s, bool& within) const {
    const Vec3f zero{0, 0, 0};
    for (int i = 0; i < kCorners; ++i) {
      s[i] = surface_of<float>(
          scene_.geometry, sight.id[i], beam.org[i], beam.dir[i], sight.t[i], shading_.smooth);
      const bool behind = dot(beam.dir[i], s[i].normal) > 0;
      if (behind) {
        s[i].normal = zero - s[i].normal;
        s[i].shading = zero - s[i].shading;
      }
      if (i == 0)
        within = behind;
      if (behind != within || dot(s[i].normal, s[0].normal) < kOneSurface)
        return false;
    }
    return true;
  }

  float field(const Surface<float>& s, MaterialField k) const {
    return shading_.materials.field[k][s.material];
  }
  Vec3f color(const Surface<float>& s, MaterialField red) const {
    return {field(s, red),
            field(s, static_cast<MaterialField>(red + 1)),
            field(s, static_cast<MaterialField>(red + 2))};
  }

  /// Doubt whether the lights are even between the corners.
  Doubt uneven_lights(const Patch& patch, float weight) {
    const Vec3f answer = color(patch.s[0], kDiffuseR) + color(patch.s[0], kSpecularR);
    Doubt most;
    for (int l = 0; l < shading_.light_count; ++l) {
      const float* const light = shading_.lights + kLightFloats * l;
      const Vec3f sent = answer * Vec3f{light[3], light[4], light[5]};
      const float part = lesser(largest(sent), 1.f) * weight;
      if (part > most.inside)
        most = most + uneven_light({light[0], light[1], light[2]}, patch, part);
    }
    return most;
  }

  /// What hides in the mirror that the corners met, of which `share` of the light comes. Mirrors
  /// that weigh little are not followed, nor those in which no more could hide than `found`.
  Doubt in_mirror(const Way& way, float share, float found) {
    const float mirror = lesser(share, 1.f) * way.weight;
    if (!(mirror > found) || mirror < kLeastMirror || field(way.s[0], kRoughness) > 0 ||
        way.follow.mirrors == 0)
      return {};
    Beam mirrored;
    for (int i = 0; i < kCorners; ++i) {
      const Surface<float>& s = way.s[i];
      const float across = dot(way.beam.dir[i], s.shading);
      mirrored.dir[i] = normalize(way.beam.dir[i] - (across + across) * s.shading);
      mirrored.org[i] = s.point + s.away * s.normal;
    }
    const ToFollow left{way.follow.mirrors - 1, way.follow.clears};
    return doubt(mirrored, way.whole, left, mirror, way.id);
  }

  /// What hides behind the clear surface that the corners met, and in its mirror: followed as light
  /// is sent on (kernel/render/children.hpp). Where some of it is reflected as a whole, nobody can
  /// tell.
  Doubt in_glass(const Way& way, bool within, float found) {
    const float ior = field(way.s[0], kIor);
    Beam through;
    float least = 1;
    float most = 0;
    for (int i = 0; i < kCorners; ++i) {
      const Surface<float>& s = way.s[i];
      const Vec3f v = Vec3f{0, 0, 0} - way.beam.dir[i];
      const Refraction<float> f = snell(ior, within, dot(s.shading, v));
      if (!f.passes)
        return around(way.weight);
      const float mirrored = schlick(ior, f);
      least = lesser(least, mirrored);
      most = greater(most, mirrored);
      through.dir[i] = normalize(passed_on(f, s.shading, v));
      through.org[i] = s.point - s.away * s.normal;
    }
    const bool fresnel = shading_.fresnel && field(way.s[0], kFresnel) > 0;
    const Doubt up = in_mirror(way, fresnel ? most : largest(color(way.s[0], kMirrorR)), found);
    const float share = fresnel ? 1 - least : lesser(field(way.s[0], kTransmission), 1.f);
    const float passes = share * way.weight;
    if (passes < kLeastMirror || passes <= found)
      return up;
    if (way.follow.clears == 0)
      return up + around(passes);
    const ToFollow left{way.follow.mirrors, way.follow.clears - 1};
    return up + doubt(through, false, left, passes, way.id);
  }

  /// The beam from a light to a patch.
  struct LightBeam {
    Beam beam;
    float length[kCorners];
    int facing = 0;  ///< corners of the patch that face the light
  };
  static LightBeam light_beam(const Vec3f& light, const CornerSurfaces& s) {
    LightBeam b;
    for (int i = 0; i < kCorners; ++i) {
      const Vec3f to = s[i].point + s[i].away * s[i].normal - light;
      b.length[i] = length(to);
      b.beam.org[i] = light;
      b.beam.dir[i] = (1 / b.length[i]) * to;
      b.facing += dot(to, s[i].normal) < 0;
    }
    return b;
  }

  /// Corners of a patch that the light reaches.
  int lit_corners(const LightBeam& b,
                  const Sight& sight,
                  const std::uint32_t (&on)[kCorners]) const {
    int lit = 0;
    for (int i = 0; i < kCorners; ++i)
      lit += !(sight.t[i] < b.length[i] * kBeforeSurface) || touches_any(on, sight.id[i]);
    return lit;
  }
  bool touches_any(const std::uint32_t (&on)[kCorners], std::uint32_t id) const {
    return any_of(on, [&](std::uint32_t own) { return touch(scene_.geometry, own, id); });
  }

  /// Doubt whether the light, of weight `part`, reaches all of the patch between four points, or
  /// none of it.
  Doubt uneven_light(const Vec3f& light, const Patch& patch, float part) {
    const LightBeam b = light_beam(light, patch.s);
    if (b.facing == 0)
      return {};
    BeamFrame f;
    if (!frame_of(b.beam, f))
      return around(part);
    Sight sight;
    trace_corners(scene_, b.beam, sight, n_);
    const int lit = lit_corners(b, sight, patch.on);
    if (lit == 0)
      return blocked(f, b, sight.id, patch.whole) ? Doubt{} : around(part);
    return lit == kCorners ? shadows(f, b, patch, part) : around(part);
  }

  /// Whether all of a beam whose corners are dark is: one solid, or one closed sheet stands in it.
  bool blocked(const BeamFrame& f,
               const LightBeam& b,
               const std::uint32_t (&id)[kCorners],
               bool whole) {
    const GeometryView& g = scene_.geometry;
    const bool one = id[0] == id[1] && id[0] == id[2] && id[0] == id[3];
    if (one && id[0] < g.ids.begin(PrimitiveKind::kCone))
      return true;
    float far = 0;
    for (const float length : b.length)
      far = greater(length, far);
    Met shade;
    return !whole && one_surface(g, id) && collect(scene_, f, far, id, false, shade, n_) &&
           closed(g, f, shade, id);
  }

  /// Doubt of a patch that is lit at its corners: whatever stands between throws its shadow inside.
  Doubt shadows(const BeamFrame& f, const LightBeam& b, const Patch& patch, float part) {
    const auto& on = patch.on;
    float least = kInfinity;
    for (const float length : b.length)
      least = lesser(length, least);
    Met met;
    const bool mesh = is_triangle(scene_.geometry, on[0]);
    if (!collect(scene_, f, least * kBeforeSurface, on, patch.whole && !mesh, met, n_))
      return around(part);
    Doubt found;
    for (int i = 0; i < met.size; ++i) {
      if (patch.holds(met.id[i]) || touches_any(on, met.id[i]))
        continue;
      if (!any_of(on, [&](std::uint32_t own) { return kin(scene_.geometry, own, met.id[i]); }))
        return {part, part};
      found = around(part);
    }
    return found;
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  Counters& n_;
};

}  // namespace grelha::GRELHA_ISA
