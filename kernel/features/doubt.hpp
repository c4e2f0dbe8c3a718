#pragma once
// What may hide from samples: whether the light that comes along a beam is known to be plain, or a
// feature may be in it that no sample has met. A function of the beam and the scene alone, not of
// grids or packets. docs/sampling.md says what it is for.
//
// Genetti, Gordon, Williams, "Adaptive Supersampling in Object Space Using Pyramidal Rays", 1998,
// move the decision from colours to objects; here the objects only say where to go on sampling.

#include "kernel/features/light_watch.hpp"

namespace grelha::GRELHA_ISA {

/// How often a beam is still followed.
struct ToFollow {
  int mirrors;
  int clears;  ///< surfaces that it passes through
};

/// What is looked for on the first surface. What a mirror shows is looked for wherever there is
/// one.
struct LookFor {
  bool things = true;                        ///< that corners miss
  std::uint64_t lights = ~std::uint64_t{0};  ///< that may be uneven: bits, see kLightBits
};

class Watcher {
 public:
  /// Light that weighs less than `least` is not followed.
  Watcher(const SceneView& scene, const ShadingView& shading, float least, Counters& counters)
      : scene_(scene),
        shading_(shading),
        least_(least),
        least_sent_(greater(kLeastMirror, least / greater(1.f, shading.brightest))),
        n_(counters) {}

  /// Weight of the faintest mirror that is followed.
  float least_sent() const { return least_sent_; }

  /// What may hide in the light that comes through a square with `weight`. None: it is plain, one
  /// smooth surface under light that is whole or wholly blocked, and so in mirrors and behind clear
  /// surfaces, as far as they are followed. `whole`: only what is sure of each part of the beam
  /// counts, which is a surface that is one convex primitive, or a nearly flat patch of a mesh.
  Doubt doubt(const FieldSquare& square,
              bool whole,
              ToFollow follow,
              float weight,
              LookFor look = {},
              std::uint32_t mirror_id = kNoPrimitive) {
    const Beam beam = square.beam();
    BeamFrame f;
    if (!frame_of(beam, f))
      return around(weight);
    const Seen seen = see(square);
    const bool differ = corners_differ(seen.id, whole);
    if (whole && differ)
      return around(weight);
    const float far = seen.all ? farthest_hit(f, seen.s) : kInfinity;
    Met met;
    if (whole) {
      if (!holds_patch(f, seen.id, far, met))
        return around(weight);
    } else if (look.things || look.lights != 0 || differ) {
      const Doubt found = met_inside(f, seen.id, far, differ, mirror_id, weight, met);
      if (!found.none())
        return found;
    }
    if (differ)
      return at_edge(beam, seen, follow, weight);
    if (look.things && !closed(scene_.geometry, f, met, seen.id))
      return around(weight);
    if (seen.id[0] == kNoPrimitive)
      return {};
    return on_surface(square, seen, met, {whole, look.lights, follow}, weight);
  }

 private:
  /// What the corners of a square met.
  struct Seen {
    std::uint32_t id[kCorners];
    CornerSurfaces s;  ///< of those that met something
    bool within[kCorners];
    bool all = true;  ///< met something
  };

  static Seen see(const FieldSquare& square) {
    Seen seen;
    for (int i = 0; i < kCorners; ++i) {
      seen.id[i] = square.field.id(square.at[i]);
      if (seen.id[i] == kNoPrimitive) {
        seen.all = false;
        continue;
      }
      const FacedSurface& faced = square.field.faced(square.at[i]);
      seen.s[i] = faced.surface;
      seen.within[i] = faced.within;
    }
    return seen;
  }

  /// What to do on a surface.
  struct OnSurface {
    bool whole;
    std::uint64_t lights;
    ToFollow follow;
  };

  /// A beam that met a surface, and how far it is to be followed.
  struct Way {
    const Beam& beam;
    const FieldSquare* square;  ///< null: the surface is a plane that is taken to go on
    const CornerSurfaces& s;
    std::uint32_t id;  ///< of the surface
    bool whole;
    ToFollow follow;
    float weight;
  };

  /// Whether corners met different surfaces, or, if `whole`, neither one convex primitive nor
  /// triangles side by side that lie nearly in one plane: of more there are too many to look at.
  bool corners_differ(const std::uint32_t (&id)[kCorners], bool whole) const {
    const GeometryView& g = scene_.geometry;
    if (!whole)
      return !one_surface(g, id);
    return any_of(id, [&](std::uint32_t i) {
      return g.ids.has(PrimitiveKind::kCone, i) ||
             (i != id[0] && !(touch(g, id[0], i) && alike(g, id[0], i, kOnePatchSquared)));
    });
  }

  /// Whether there is nothing else, or all that is met lies nearly in the plane of the triangle
  /// that a corner met.
  bool holds_patch(const BeamFrame& f,
                   const std::uint32_t (&front)[kCorners],
                   float far,
                   Met& met) {
    const GeometryView& g = scene_.geometry;
    if (!collect(scene_, f, far, front, !is_triangle(g, front[0]), met, n_))
      return false;
    for (int i = 0; i < met.size; ++i)
      if (!alike(g, front[0], met.id[i], kOnePatchSquared))
        return false;
    return true;
  }

  /// What is met of which corners do not tell.
  Doubt met_inside(const BeamFrame& f,
                   const std::uint32_t (&front)[kCorners],
                   float far,
                   bool differ,
                   std::uint32_t mirror_id,
                   float weight,
                   Met& met) {
    const bool all = collect(scene_, f, far, front, false, met, n_);
    if (!all)
      met.size = 0;  // some of them, and other grids would find others
    Doubt found = hidden(f, met, front, mirror_id, weight);
    if (differ)
      found = found + at_corners(f, met, front, weight);
    if (!all)
      found.around = weight;
    return found;
  }

  /// What may hide where the corners differ: also in a mirror or pane of triangles that one of them
  /// met, as though it went on.
  Doubt at_edge(const Beam& beam, const Seen& seen, ToFollow follow, float weight) {
    for (int i = 0; i < kCorners; ++i) {
      const std::uint32_t id = seen.id[i];
      CornerSurfaces s;
      if (id == kNoPrimitive || !is_triangle(scene_.geometry, id) ||
          !is_bent(scene_, shading_, id) || !go_on(beam, seen.s[i], s))
        continue;
      const Way way{beam, nullptr, s, id, false, follow, weight};
      return around(weight) + (field(s[0], kTransmission) > 0
                                   ? in_glass(way, seen.within[i], 0)
                                   : in_mirror(way, largest(color(s[0], kMirrorR)), 0));
    }
    return around(weight);
  }

  /// The plane that one corner ray met, at all of them; false: one misses it.
  static bool go_on(const Beam& beam, const Surface<float>& there, CornerSurfaces& s) {
    for (int i = 0; i < kCorners; ++i) {
      const float t = dot(there.point - beam.org[i], there.normal) / dot(beam.dir[i], there.normal);
      if (!(t > 0 && t < kInfinity))
        return false;
      s[i] = there;
      s[i].point = beam.org[i] + t * beam.dir[i];
    }
    return true;
  }

  /// What hides in the light on the surface that the corners met, in its mirror and behind it.
  Doubt on_surface(const FieldSquare& square,
                   const Seen& seen,
                   const Met& met,
                   const OnSurface& on,
                   float weight) {
    const CornerSurfaces& s = seen.s;
    for (int i = 1; i < kCorners; ++i)
      if (seen.within[i] != seen.within[0] || dot(s[i].normal, s[0].normal) < kOneSurface)
        return around(weight);
    const Doubt found = LightWatch(scene_, shading_, least_, n_)
                            .uneven_lights({square, s, seen.id, met, on.whole}, on.lights, weight);
    const Beam beam = square.beam();
    const Way way{beam, &square, s, seen.id[0], on.whole, on.follow, weight};
    if (field(s[0], kTransmission) > 0)
      return on.whole ? around(weight) : found + in_glass(way, seen.within[0], found.inside);
    return found + in_mirror(way, largest(color(s[0], kMirrorR)), found.inside);
  }

  /// Sends rays to the points of some of what was met, at most a packet of 16.
  void trace_points(const BeamFrame& f, const Met& met, const int* which, Packet<InFloat>& p) {
    for (int i = 0; i < p.size; ++i) {
      const Vec3f to = normalize(met.part[which[i]].point - f.apex);
      const Vec3f start = f.apex + (f.depth / dot(to, f.unit)) * to;
      set_ray(p, i, start, to, kInfinity);
    }
    trace_packet<false>(scene_, p, {16, true}, n_);
  }

  /// Sends a ray to each point met, but for those on what passes for a surface that the corners
  /// see. Where all of them end on such, nothing hides; where one ends on another side of their
  /// mesh, that shows around as well.
  Doubt hidden(const BeamFrame& f,
               const Met& met,
               const std::uint32_t (&front)[kCorners],
               std::uint32_t mirror_id,
               float weight) {
    const GeometryView& g = scene_.geometry;
    const auto is_front = [&](std::uint32_t id) {
      return any_of(front, [&](std::uint32_t seen) { return alike(g, seen, id); });
    };
    int which[kMostMet];
    int others = 0;
    for (int i = 0; i < met.size; ++i)
      if (!is_front(met.id[i]))
        which[others++] = i;
    Doubt found;
    for (int first = 0; first < others; first += 16) {
      Packet<InFloat> p;
      p.size = others - first < 16 ? others - first : 16;
      trace_points(f, met, which + first, p);
      for (int i = 0; i < p.size; ++i) {
        const std::uint32_t id = id_of(p.id[i]);
        if (is_front(id))
          continue;
        if (!is_own_mirror(id, mirror_id) &&
            !any_of(front, [&](std::uint32_t seen) { return kin(g, seen, id); }))
          found.add(weight * brightness(id), met.part[which[first + i]].box);
        found.around = weight;
      }
    }
    return found;
  }

  /// Small things that one corner met and no other.
  Doubt at_corners(const BeamFrame& f,
                   const Met& met,
                   const std::uint32_t (&front)[kCorners],
                   float weight) const {
    const GeometryView& g = scene_.geometry;
    Doubt found;
    for (const std::uint32_t id : front) {
      int corners = 0;
      for (const std::uint32_t other : front)
        corners += alike(g, id, other);
      PartInBeam part;
      if (id == kNoPrimitive || corners > 1 || !meets(scene_, f, id, kInfinity, part))
        continue;
      for (int i = 0; i < met.size; ++i)
        if (alike(g, id, met.id[i]))
          part.box.add(met.part[i].box);
      if (part.box.share() <= kLargestBox)
        found = found + Doubt{0, weight, weight * brightness(id), part.box};
    }
    return found;
  }

  /// The most that something sends an eye, or 1 where that is less than white: what it hides may be
  /// as bright.
  float brightness(std::uint32_t id) const {
    const std::uint32_t m = material_of_any(scene_.geometry, id);
    const auto row = [&](MaterialField red) { return material_color(shading_.materials, m, red); };
    Vec3f lights{0, 0, 0};
    for (int l = 0; l < shading_.light_count; ++l) {
      const float* const c = shading_.lights + kLightFloats * l + 3;
      lights = lights + Vec3f{c[0], c[1], c[2]};
    }
    const Vec3f own = row(kEmissionR) + (row(kDiffuseR) + row(kSpecularR)) * lights;
    const float sent_on = largest(row(kMirrorR)) + shading_.materials.field[kTransmission][m];
    return greater(1.f, largest(own) + sent_on * shading_.brightest);
  }

  /// Whether a bulging mirror stands in its own way.
  bool is_own_mirror(std::uint32_t id, std::uint32_t mirror_id) const {
    return mirror_id != kNoPrimitive && (id == mirror_id || kin(scene_.geometry, id, mirror_id));
  }

  float field(const Surface<float>& s, MaterialField k) const {
    return shading_.materials.field[k][s.material];
  }
  Vec3f color(const Surface<float>& s, MaterialField red) const {
    return material_color(shading_.materials, s.material, red);
  }

  /// What hides in the mirror that the corners met, of which `share` of the light comes. Mirrors
  /// that weigh little are not followed, nor those in which no more could hide than `found`.
  Doubt in_mirror(const Way& way, float share, float found) {
    const float mirror = lesser(share, 1.f) * way.weight;
    if (!(mirror > found) || mirror < least_sent_ || field(way.s[0], kRoughness) > 0 ||
        way.follow.mirrors == 0)
      return {};
    const auto mirrored = [&](int i) { return mirrored_ray(way.beam.dir[i], way.s[i]); };
    const ToFollow left{way.follow.mirrors - 1, way.follow.clears};
    return follow_on(way, mirrored, &CornerField::mirrored, [&](const FieldSquare& square) {
      return doubt(square, way.whole, left, mirror, {}, way.id);
    });
  }

  /// What hides behind the clear surface that the corners met, and in its mirror: followed as light
  /// is sent on (kernel/render/children.hpp). Where some of it is reflected as a whole, nobody can
  /// tell.
  Doubt in_glass(const Way& way, bool within, float found) {
    const float ior = field(way.s[0], kIor);
    Refraction<float> bent[kCorners];
    float least = 1;
    float most = 0;
    for (int i = 0; i < kCorners; ++i) {
      bent[i] = refraction_at(way.beam.dir[i], way.s[i], ior, within);
      if (!bent[i].passes)
        return around(way.weight);
      const float mirrored = schlick(ior, bent[i]);
      least = lesser(least, mirrored);
      most = greater(most, mirrored);
    }
    const bool fresnel = shading_.fresnel && field(way.s[0], kFresnel) > 0;
    const Doubt up = in_mirror(way, fresnel ? most : largest(color(way.s[0], kMirrorR)), found);
    const float share = fresnel ? 1 - least : lesser(field(way.s[0], kTransmission), 1.f);
    const float passes = share * way.weight;
    if (passes < least_sent_ || passes <= found)
      return up;
    if (way.follow.clears == 0)
      return up + around(passes);
    const auto passed = [&](int i) { return passed_ray(way.beam.dir[i], way.s[i], bent[i]); };
    const ToFollow left{way.follow.mirrors, way.follow.clears - 1};
    return up + follow_on(way, passed, &CornerField::passed, [&](const FieldSquare& square) {
             return doubt(square, false, left, passes, {}, way.id);
           });
  }

  /// What `watch` says of the four rays: in the field that the corners' own becomes, or, made by
  /// ray(i), alone.
  template <class Ray, class Watch>
  Doubt follow_on(const Way& way,
                  const Ray& ray,
                  CornerField& (CornerField::*become)(),
                  const Watch& watch) {
    if (way.square)
      return watch({(way.square->field.*become)(), way.square->at, way.beam.growth});
    CornerField own(scene_, shading_, n_);
    for (int i = 0; i < kCorners; ++i)
      own.set(i, ray(i), ~std::uint64_t{0});
    own.trace();
    return watch({own, {0, 1, 2, 3}, way.beam.growth});
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  const float least_, least_sent_;
  Counters& n_;
};

}  // namespace grelha::GRELHA_ISA
