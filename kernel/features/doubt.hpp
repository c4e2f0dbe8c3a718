#pragma once
// What may hide from samples: whether the light that comes along a beam is known to be plain, or a
// feature may be in it that no sample has met. A function of the beam and the scene alone, not of
// grids or packets. docs/sampling.md says what it is for.
//
// Genetti, Gordon, Williams, "Adaptive Supersampling in Object Space Using Pyramidal Rays", 1998,
// move the decision from colours to objects; here the objects only say where to go on sampling.

#include "kernel/features/beam.hpp"

namespace grelha::GRELHA_ISA {

/// The weight, 0 to 1, of what may hide: `inside`, where something was met that no corner sees;
/// `around`, where the corners differ, or the beam cannot tell: what hides then shows in the pixels
/// around as well, whose colours bound it.
struct Doubt {
  float inside = 0, around = 0;
  bool none() const { return inside == 0 && around == 0; }
};
inline Doubt around(float weight) { return {0, weight}; }
inline Doubt operator+(const Doubt& a, const Doubt& b) {
  return {greater(a.inside, b.inside), greater(a.around, b.around)};
}

class Watcher {
 public:
  Watcher(const SceneView& scene, const ShadingView& shading, Counters& counters)
      : scene_(scene), shading_(shading), n_(counters) {}

  /// What may hide in the light that comes along the beam with `weight`. None: it is plain, one
  /// smooth surface under light that is whole or wholly blocked, and so in mirrors `bounces` more
  /// times. `whole`: only a surface that is one convex primitive counts, which makes the answer
  /// sure.
  Doubt doubt(const Beam& beam,
              bool whole,
              int bounces,
              float weight,
              std::uint32_t mirror_id = kNoPrimitive) {
    BeamFrame f;
    if (!frame_of(beam, f))
      return around(weight);
    Sight sight;
    trace_corners(beam, sight);
    float far = 0;
    bool differ = false;
    for (int i = 0; i < kCorners; ++i) {
      const bool hit = sight.id[i] != kNoPrimitive;
      differ |= whole
                    ? sight.id[i] != sight.id[0] || (hit && is_a(PrimitiveKind::kCone, sight.id[i]))
                    : !alike(sight.id[0], sight.id[i]);
      far = greater(
          hit ? place(f, beam.org[i] + sight.t[i] * beam.dir[i]).w * kBehindHit : kInfinity, far);
    }
    if (whole && differ)
      return around(weight);
    Met met;
    if (!collect(f, far, sight.id, whole, met))
      return around(weight);
    if (const Doubt found = hidden(f, met, sight.id, mirror_id, weight); !found.none())
      return found;
    if (differ || !closed(f, met, sight.id))
      return around(weight);
    if (sight.id[0] == kNoPrimitive)
      return {};

    Surface<float> s[kCorners];
    for (int i = 0; i < kCorners; ++i) {
      s[i] = surface_of<float>(
          scene_.geometry, sight.id[i], beam.org[i], beam.dir[i], sight.t[i], shading_.smooth);
      if (dot(beam.dir[i], s[i].normal) > 0)
        s[i].normal = Vec3<float>{0, 0, 0} - s[i].normal,
        s[i].shading = Vec3<float>{0, 0, 0} - s[i].shading;
      if (dot(s[i].normal, s[0].normal) < kOneSurface)
        return around(weight);
    }
    const auto field = [&](MaterialField k) { return shading_.materials.field[k][s[0].material]; };
    if (field(kTransmission) > 0)
      return around(weight);
    const auto color = [&](MaterialField k) {
      return Vec3<float>{field(k),
                         field(static_cast<MaterialField>(k + 1)),
                         field(static_cast<MaterialField>(k + 2))};
    };
    const Vec3<float> answer = color(kDiffuseR) + color(kSpecularR);
    Doubt most;
    for (int l = 0; l < shading_.light_count; ++l) {
      const float* const light = shading_.lights + kLightFloats * l;
      const float part =
          lesser(largest(answer * Vec3<float>{light[3], light[4], light[5]}), 1.f) * weight;
      if (part > most.inside)
        most = most + uneven_light(light, s, sight.id, whole, part);
    }
    const float mirror = lesser(largest(color(kMirrorR)), 1.f) * weight;
    if (!(mirror > most.inside) || mirror < kLeastMirror || field(kRoughness) > 0 || bounces == 0)
      return most;
    Beam mirrored;
    for (int i = 0; i < kCorners; ++i) {
      const float across = dot(beam.dir[i], s[i].shading);
      mirrored.dir[i] = normalize(beam.dir[i] - (across + across) * s[i].shading);
      mirrored.org[i] = s[i].point + s[i].away * s[i].normal;
    }
    return most + doubt(mirrored, whole, bounces - 1, mirror, sight.id[0]);
  }

 private:
  /// Nearest hits of the corner rays.
  void trace_corners(const Beam& beam, Sight& sight) {
    Packet<InFloat> p;
    fill(beam, p);
    trace_packet<false>(scene_, p, {16, true}, n_);
    for (int i = 0; i < kCorners; ++i) {
      sight.id[i] = id_of(p.id[i]);
      sight.t[i] = t_of(p, i);
    }
  }

  static void fill(const Beam& beam, WalkingRays& p) {
    p.size = kCorners;
    for (int i = 0; i < kCorners; ++i) {
      p.org[0][i] = beam.org[i].x;
      p.org[1][i] = beam.org[i].y;
      p.org[2][i] = beam.org[i].z;
      p.dir[0][i] = beam.dir[i].x;
      p.dir[1][i] = beam.dir[i].y;
      p.dir[2][i] = beam.dir[i].z;
      p.t_min[i] = p.start[i] = 0;
      p.best[i] = kInfinity;
    }
  }

  /// Primitives that meet the beam before w = `far`, other than `known`; false when no answer can
  /// be had, or when `single` and there is one.
  bool collect(const BeamFrame& f,
               float far,
               const std::uint32_t (&known)[kCorners],
               bool single,
               Met& met) {
    const auto see = [&](std::uint32_t id) {
      if (met.full || id == known[0] || id == known[1] || id == known[2] || id == known[3])
        return;
      Vec3<float> point;
      if (!meets(scene_, f, id, far, point))
        return;
      for (int i = 0; i < met.size; ++i)
        if (met.id[i] == id)
          return;
      if (met.size == kMostMet || single) {
        met.full = true;
        return;
      }
      met.id[met.size] = id;
      met.point[met.size++] = point;
    };
    see_outside(scene_.outside, see);
    if (met.full)
      return false;
    if (scene_.grid_count == 0)
      return true;
    Packet<InFloat> p;
    p.size = kCorners;
    for (int i = 0; i < kCorners; ++i) {  // the edges of the pyramid, with w for t
      const Vec3<float> dir = f.axis + (i == 1 || i == 2 ? 1.f : -1.f) * f.right +
                              (i >= 2 ? 1.f : -1.f) * f.up,
                        org = f.apex + f.depth * dir;
      p.org[0][i] = org.x;
      p.org[1][i] = org.y;
      p.org[2][i] = org.z;
      p.dir[0][i] = dir.x;
      p.dir[1][i] = dir.y;
      p.dir[2][i] = dir.z;
      p.t_min[i] = p.start[i] = 0;
      p.best[i] = kBehindHit * far - f.depth;
    }
    prepare(p, false);
    bring_near(scene_, p);
    const float m[3] = {magnitude(f.unit.x), magnitude(f.unit.y), magnitude(f.unit.z)};
    const int axis = m[0] >= m[1] && m[0] >= m[2] ? 0 : m[1] >= m[2] ? 1 : 2;
    for (int g = 0; g < scene_.grid_count; ++g)
      if (for_beam(scene_.grids[g], p) &&
          (!walk_beam(scene_.grids[g], p, axis, see, n_) || met.full))
        return false;
    return true;
  }

  /// A beam goes where all of its edges go: the grid of rays that start far away holds for those
  /// that start near as well.
  static bool for_beam(const GridView& g, const WalkingRays& p) {
    bool all = true, some = false;
    for (int i = 0; i < kCorners; ++i) {
      const bool served = serves(g, {p.org[0][i], p.org[1][i], p.org[2][i]});
      all &= served;
      some |= served;
    }
    return g.serves == Serves::kNear ? all : some;
  }

  bool is_a(PrimitiveKind kind, std::uint32_t id) const {
    return scene_.geometry.ids.has(kind, id);
  }
  bool is_triangle(std::uint32_t id) const { return is_a(PrimitiveKind::kTriangle, id); }
  /// Which triangle an id is.
  std::uint32_t triangle(std::uint32_t id) const {
    return id - scene_.geometry.ids.begin(PrimitiveKind::kTriangle);
  }

  Vec3<float> flat_normal(std::uint32_t i) const {
    const Corners3 c = triangle_corners(scene_.geometry.of<Triangle>(), i);
    return cross(c.at[1] - c.at[0], c.at[2] - c.at[0]);
  }

  /// Whether two primitives pass for one surface: triangles of one material that face nearly one
  /// way. Where one hides the other and both are lit alike, nobody can tell.
  bool alike(std::uint32_t a, std::uint32_t b) const {
    if (a == b)
      return true;
    if (!is_triangle(a) || !is_triangle(b))
      return false;
    const std::uint32_t i = triangle(a), j = triangle(b);
    if (scene_.geometry.of<Triangle>().material[i] != scene_.geometry.of<Triangle>().material[j])
      return false;
    const Vec3<float> n = flat_normal(i), m = flat_normal(j);
    const float d = dot(n, m);
    return d * d > kOneSurfaceSquared * (dot(n, n) * dot(m, m));
  }

  bool one_surface(const std::uint32_t (&id)[kCorners]) const {
    return alike(id[0], id[1]) && alike(id[0], id[2]) && alike(id[0], id[3]);
  }

  bool touch(std::uint32_t a, std::uint32_t b) const {
    if (!is_triangle(a) || !is_triangle(b))
      return a == b;
    const Corners3 p = triangle_corners(scene_.geometry.of<Triangle>(), triangle(a)),
                   q = triangle_corners(scene_.geometry.of<Triangle>(), triangle(b));
    bool found = false;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        found |= p.at[k].x == q.at[l].x && p.at[k].y == q.at[l].y && p.at[k].z == q.at[l].z;
    return found;
  }
  /// Triangles of one material: pieces of one mesh, most likely.
  bool kin(std::uint32_t a, std::uint32_t b) const {
    return is_triangle(a) && is_triangle(b) &&
           scene_.geometry.of<Triangle>().material[triangle(a)] ==
               scene_.geometry.of<Triangle>().material[triangle(b)];
  }
  template <class Test>
  static bool any_of(const std::uint32_t (&id)[kCorners], const Test& test) {
    return test(id[0]) || test(id[1]) || test(id[2]) || test(id[3]);
  }

  /// Sends a ray to each point met. Where all of them end on what passes for a surface that the
  /// corners see, nothing hides; where one ends on another side of their mesh, that shows around as
  /// well.
  Doubt hidden(const BeamFrame& f,
               const Met& met,
               const std::uint32_t (&front)[kCorners],
               std::uint32_t mirror_id,
               float weight) {
    Doubt found;
    for (int first = 0; first < met.size; first += 16) {
      Packet<InFloat> p;
      p.size = met.size - first < 16 ? met.size - first : 16;
      for (int i = 0; i < p.size; ++i) {
        const Vec3<float> to = normalize(met.point[first + i] - f.apex),
                          start = f.apex + (f.depth / dot(to, f.unit)) * to;
        p.org[0][i] = start.x;
        p.org[1][i] = start.y;
        p.org[2][i] = start.z;
        p.dir[0][i] = to.x;
        p.dir[1][i] = to.y;
        p.dir[2][i] = to.z;
        p.t_min[i] = p.start[i] = 0;
        p.best[i] = kInfinity;
      }
      trace_packet<false>(scene_, p, {16, true}, n_);
      for (int i = 0; i < p.size; ++i) {
        const std::uint32_t id = id_of(p.id[i]);
        if (any_of(front, [&](std::uint32_t seen) { return alike(seen, id); }))
          continue;
        // a bulging mirror in its own way
        const bool own = mirror_id != kNoPrimitive && (id == mirror_id || kin(id, mirror_id));
        if (!own && !any_of(front, [&](std::uint32_t seen) { return kin(seen, id); }))
          return {weight, weight};
        found = around(weight);
      }
    }
    return found;
  }

  /// Whether the triangles that pass for one surface leave no gap in the beam: each edge inside it
  /// belongs to two of them.
  bool closed(const BeamFrame& f, const Met& met, const std::uint32_t (&front)[kCorners]) const {
    if (!is_triangle(front[0]))
      return true;
    std::uint32_t sheet[kMostMet + kCorners];
    int size = 0;
    const auto add = [&](std::uint32_t id) {
      for (int i = 0; i < size; ++i)
        if (sheet[i] == id)
          return;
      sheet[size++] = id;
    };
    for (const std::uint32_t id : front)
      add(id);
    for (int i = 0; i < met.size; ++i)
      if (alike(front[0], met.id[i]))
        add(met.id[i]);
    if (size == 1)
      return true;
    Corners3 c[kMostMet + kCorners];
    for (int i = 0; i < size; ++i)
      c[i] = triangle_corners(scene_.geometry.of<Triangle>(), triangle(sheet[i]));
    const auto same = [](const Vec3<float>& a, const Vec3<float>& b) {
      return a.x == b.x && a.y == b.y && a.z == b.z;
    };
    const auto has = [&](const Corners3& t, const Vec3<float>& p) {
      return same(t.at[0], p) || same(t.at[1], p) || same(t.at[2], p);
    };
    for (int i = 0; i < size; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3<float>&a = c[i].at[k], &b = c[i].at[(k + 1) % 3];
        // its other triangle may lie just outside
        if (innermost(place(f, a), place(f, b)).w > kEdgeInside)
          continue;
        bool shared = false;
        for (int j = 0; j < size && !shared; ++j)
          shared = j != i && has(c[j], a) && has(c[j], b);
        if (!shared)
          return false;
      }
    return true;
  }

  /// Doubt whether the light, of weight `part`, reaches all of the patch between four points, or
  /// none of it.
  Doubt uneven_light(const float* light,
                     const Surface<float> (&s)[kCorners],
                     const std::uint32_t (&on)[kCorners],
                     bool whole,
                     float part) {
    const Vec3<float> at{light[0], light[1], light[2]};
    Beam beam;
    float away[kCorners], far = 0;
    int facing = 0;
    for (int i = 0; i < kCorners; ++i) {
      const Vec3<float> to = s[i].point + s[i].away * s[i].normal - at;
      away[i] = length(to);
      beam.org[i] = at;
      beam.dir[i] = (1 / away[i]) * to;
      facing += dot(to, s[i].normal) < 0;
    }
    if (facing == 0)
      return {};
    BeamFrame f;
    if (!frame_of(beam, f))
      return around(part);
    Sight sight;
    float least = kInfinity;
    for (int i = 0; i < kCorners; ++i) {
      least = lesser(away[i], least);
      far = greater(away[i], far);
    }
    trace_corners(beam, sight);
    int lit = 0;
    for (int i = 0; i < kCorners; ++i)
      lit += !(sight.t[i] < away[i] * kBeforeSurface) ||
             any_of(on, [&](std::uint32_t own) { return touch(own, sight.id[i]); });
    if (lit != 0 && lit != kCorners)
      return around(part);
    if (lit == 0) {
      const bool one = sight.id[0] == sight.id[1] && sight.id[0] == sight.id[2] &&
                       sight.id[0] == sight.id[3] &&
                       sight.id[0] < scene_.geometry.ids.begin(PrimitiveKind::kCone);
      if (one)
        return {};
      Met shade;
      return !whole && one_surface(sight.id) && collect(f, far, sight.id, false, shade) &&
                     closed(f, shade, sight.id)
                 ? Doubt{}
                 : around(part);
    }
    // Lit at its corners: whatever stands between throws its shadow inside.
    Met met;
    if (!collect(f, least * kBeforeSurface, on, whole, met))
      return around(part);
    Doubt found;
    for (int i = 0; i < met.size; ++i) {
      if (any_of(on, [&](std::uint32_t own) { return touch(own, met.id[i]); }))
        continue;
      if (!any_of(on, [&](std::uint32_t own) { return kin(own, met.id[i]); }))
        return {part, part};
      found = around(part);
    }
    return found;
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  Counters& n_;
};

/// Beam through the square of `size` pixels at (x0, y0), grown a little about its centre: what only
/// touches its edge counts as well.
inline Beam pixel_beam(const FrameView& f, int x0, int y0, int size) {
  const float half = .5f * static_cast<float>(size), mx = static_cast<float>(x0) + half,
              my = static_cast<float>(y0) + half;
  const float rx = size > 1 ? kSquareGrowth * half : kPixelGrowth * half, ry = rx;
  const float sign[kCorners][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    const float sx = (mx + sign[i][0] * rx) - .5f * static_cast<float>(f.width);
    const float sy = .5f * static_cast<float>(f.height) - (my + sign[i][1] * ry);
    b.org[i] = {f.eye[0], f.eye[1], f.eye[2]};
    b.dir[i] = normalize(Vec3<float>{(f.forward[0] + sx * f.right[0]) + sy * f.up[0],
                                     (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                                     (f.forward[2] + sx * f.right[2]) + sy * f.up[2]});
  }
  return b;
}

/// Doubt of the pixels of an 8 x 8 tile, [8 y + x], those with a bit in `asked`. Squares that are
/// plain as a whole save their parts.
inline void tile_doubt(Watcher& watcher,
                       const FrameView& f,
                       int x0,
                       int y0,
                       int size,
                       int bounces,
                       std::uint64_t asked,
                       float (&inside)[kTile * kTile],
                       float (&around)[kTile * kTile]) {
  const int first = y0 % kTile * kTile + x0 % kTile;
  const std::uint64_t row = ~std::uint64_t{0} >> (64 - size);
  std::uint64_t here = 0;
  for (int y = 0; y < size; ++y)
    here |= row << (first + y * kTile);
  if ((asked & here) == 0)
    return;
  const Doubt doubt = watcher.doubt(pixel_beam(f, x0, y0, size), size > 1, bounces, 1);
  if (size == 1 || doubt.none()) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        inside[first + y * kTile + x] = doubt.inside, around[first + y * kTile + x] = doubt.around;
    return;
  }
  const int h = size / 2;
  for (int i = 0; i < 4; ++i)
    tile_doubt(watcher, f, x0 + i % 2 * h, y0 + i / 2 * h, h, bounces, asked, inside, around);
}

}  // namespace grelha::GRELHA_ISA
