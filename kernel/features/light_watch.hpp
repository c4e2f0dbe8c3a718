#pragma once
// Whether lights shine evenly on what a beam's corners met.

#include "kernel/features/beam_search.hpp"
#include "kernel/features/closed_sheet.hpp"
#include "kernel/features/corner_field.hpp"
#include "kernel/features/what_hides.hpp"

namespace grelha::GRELHA_ISA {

/// What a beam's corners met: one surface.
struct Patch {
  const FieldSquare& square;
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

/// Looks from lights.
class LightWatch {
 public:
  /// Light that weighs less than `least` is left out.
  LightWatch(const SceneView& scene, const ShadingView& shading, float least, Counters& counters)
      : scene_(scene), shading_(shading), least_(least), n_(counters) {}

  /// Doubt whether the lights of some bits are even between the corners.
  Doubt uneven_lights(const Patch& patch, std::uint64_t lights, float weight) {
    const auto row = [&](MaterialField red) {
      return material_color(shading_.materials, patch.s[0].material, red);
    };
    const Vec3f answer = row(kDiffuseR) + row(kSpecularR);
    Doubt most;
    for (int l = 0; lights != 0 && l < shading_.light_count; ++l) {
      if (!(lights >> l % kLightBits & 1))
        continue;
      const float* const light = shading_.lights + kLightFloats * l;
      const Vec3f sent = answer * Vec3f{light[3], light[4], light[5]};
      const float part = lesser(largest(sent), 1.f) * weight;
      if (part > most.inside && part >= least_)
        most = most + uneven_light(l, patch, part);
    }
    return most;
  }

 private:
  /// The beam from a light to a patch.
  struct LightBeam {
    Beam beam;
    Sight sight;
    float length[kCorners];
    int facing = 0;  ///< corners of the patch that face the light
  };
  static LightBeam light_beam(int l, const Patch& patch) {
    const LightRays& rays = patch.square.field.from_light(l, patch.square.at);
    LightBeam b;
    b.beam.growth = patch.square.growth;
    for (int i = 0; i < kCorners; ++i) {
      const int at = patch.square.at[i];
      b.length[i] = rays.length[at];
      b.beam.org[i] = rays.org[at];
      b.beam.dir[i] = rays.dir[at];
      b.sight.id[i] = rays.id[at];
      b.sight.t[i] = rays.t[at];
      b.facing += dot(rays.dir[at], patch.s[i].normal) < 0;
    }
    return b;
  }

  /// Corners of a patch that the light reaches.
  int lit_corners(const LightBeam& b, const std::uint32_t (&on)[kCorners]) const {
    int lit = 0;
    for (int i = 0; i < kCorners; ++i)
      lit += !(b.sight.t[i] < b.length[i] * kBeforeSurface) || touches_any(on, b.sight.id[i]);
    return lit;
  }
  bool touches_any(const std::uint32_t (&on)[kCorners], std::uint32_t id) const {
    return any_of(on, [&](std::uint32_t own) { return touch(scene_.geometry, own, id); });
  }

  /// Whether a light has no area.
  bool is_point(const float* light) const {
    for (int k = 6; shading_.area && k < kLightFloats; ++k)
      if (light[k] != 0)
        return false;
    return true;
  }

  /// Doubt whether the light, of weight `part`, reaches all of the patch between four points, or
  /// none of it.
  Doubt uneven_light(int l, const Patch& patch, float part) {
    const LightBeam b = light_beam(l, patch);
    if (b.facing == 0)
      return {};
    BeamFrame f;
    if (!frame_of(b.beam, f))
      return around(part);
    const int lit = lit_corners(b, patch.on);
    if (lit == 0)
      return blocked(f, b, patch.whole) ? Doubt{} : around(part);
    if (lit < kCorners)
      return around(part);
    return shadows(f, b, patch, is_point(shading_.lights + kLightFloats * l), part);
  }

  /// Whether all of a beam whose corners are dark is: one solid, or one closed sheet stands in it.
  /// Of a sheet no more is looked at than as far behind what the corner rays met as that is deep.
  bool blocked(const BeamFrame& f, const LightBeam& b, bool whole) {
    const GeometryView& g = scene_.geometry;
    const auto& id = b.sight.id;
    const bool one = id[0] == id[1] && id[0] == id[2] && id[0] == id[3];
    if (one && id[0] < g.ids.begin(PrimitiveKind::kCone))
      return true;
    if (whole || !one_surface(g, id))
      return false;
    CornerSurfaces s;
    float before = kInfinity;
    float end = 0;
    for (int i = 0; i < kCorners; ++i) {
      s[i] =
          surface_of<float>(g, id[i], b.beam.org[i], b.beam.dir[i], b.sight.t[i], shading_.smooth);
      before = lesser(place(f, s[i].point).w, before);
      end = greater(b.length[i], end);
    }
    const float behind = farthest_hit(f, s);
    const float far = lesser(behind + (behind - before), end);
    Met shade;
    return collect(scene_, f, far, id, false, shade, n_) && closed(g, f, shade, id);
  }

  /// Doubt of a patch that is lit at its corners: whatever stands between throws its shadow inside.
  /// Only that of a point lies where the beam says.
  Doubt shadows(
      const BeamFrame& f, const LightBeam& b, const Patch& patch, bool point, float part) {
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
        found.add(part, point ? met.part[i].box : BeamBox::all());
      found.around = part;
    }
    return found;
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  const float least_;
  Counters& n_;
};

}  // namespace grelha::GRELHA_ISA
