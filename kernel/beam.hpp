#pragma once
// What a beam of four rays can see: whether the light that comes along it is known to be plain, or a feature may hide in it that
// no sample has met. A beam walks the grids as a packet does; whatever primitive reaches into it is then asked for one point
// inside, and a ray is sent there. So the answer is a function of the beam and the scene alone, not of grids or packets.
//
// Genetti, Gordon, Williams, "Adaptive Supersampling in Object Space Using Pyramidal Rays", 1998, move the decision from colours
// to objects; here the objects only say where to go on sampling.

#include "kernel/surface.hpp"
#include "kernel/trace.hpp"

namespace grelha::GRELHA_ISA {

inline constexpr int kCorners = 4, kMostMet = 48;
/// Corner rays of a beam lie within this cosine of its axis: wider ones would walk half the scene.
inline constexpr float kNarrow = .998f;

struct Beam {
  Vec3<float> org[kCorners], dir[kCorners];  ///< around the beam, in order; unit directions
};

/// A beam as a pyramid over a parallelogram: its rays seem to come from the apex, and a point apex + w (axis + x right + y up) lies
/// inside when |x| and |y| are at most 1.
struct BeamFrame {
  Vec3<float> apex, axis, right, up;
  Vec3<float> to_x, to_y;  ///< x = dot(p, to_x) / dot(p, unit), p from the apex; y likewise
  Vec3<float> unit;        ///< the axis without what right and up add to it: w = dot(p, unit)
  float depth;             ///< w from which the whole beam is on its way: of its farthest origin
};

struct Sight {
  std::uint32_t id[kCorners];
  float t[kCorners];
};

inline Vec3<float> middle(const Vec3<float> (&p)[kCorners]) { return .25f * ((p[0] + p[1]) + (p[2] + p[3])); }

/// False when the rays spread too far to be a beam.
inline bool frame_of(const Beam& b, BeamFrame& f) {
  const Vec3<float> org = middle(b.org);
  f.unit = normalize(middle(b.dir));
  if (!(f.unit.x == f.unit.x)) return false;
  float offset = 0, growth = 0;
  for (int i = 0; i < kCorners; ++i) {
    const float along = dot(b.dir[i], f.unit);
    if (!(along > kNarrow)) return false;
    const Vec3<float> o = b.org[i] - org, d = (1 / along) * b.dir[i] - f.unit;
    offset += length(o), growth += dot(o, d) > 0 || dot(o, o) == 0 ? length(d) : 0 - length(d);
  }
  // Rays that run together or keep apart have no apex behind them: one far away stands for it.
  f.depth = offset == 0 ? 0.f : growth > 1e-4f * offset ? lesser(offset / growth, 1e4f * offset) : 1e4f * offset;
  f.apex = org - f.depth * f.unit;
  Vec3<float> c[kCorners];  // where the corner rays pierce w = 1
  for (int i = 0; i < kCorners; ++i) {
    const Vec3<float> at = b.org[i] + (f.depth > 0 ? 0.f : 1.f) * b.dir[i] - f.apex;  // any place on a ray from the apex will do
    c[i] = (1 / dot(at, f.unit)) * at;
  }
  f.axis = middle(c);
  f.right = .25f * ((c[1] - c[0]) + (c[2] - c[3])), f.up = .25f * ((c[3] - c[0]) + (c[2] - c[1]));
  const Vec3<float> n = cross(f.right, f.up);  // along the axis: x = det(p, up, axis) / det(right, up, axis), over w
  const float det = dot(n, f.axis);
  if (!(det * det > 0)) return false;
  f.to_x = (1 / det) * cross(f.up, f.axis), f.to_y = (1 / det) * cross(f.axis, f.right);
  if (f.depth == 0) return true;
  float first = kInfinity, last = 0;
  for (int i = 0; i < kCorners; ++i) {
    const float w = dot(b.org[i] - f.apex, f.unit);
    first = lesser(w, first), last = greater(w, last);
  }
  f.depth = last + .1f * (last - first);  // a slanting mirror: its corners are the ends, but for the rounding
  return true;
}

/// Place in the beam, see BeamFrame.
struct Place {
  float x, y, w;
};
inline Place place(const BeamFrame& f, const Vec3<float>& p) {
  const Vec3<float> d = p - f.apex;
  const float w = dot(d, f.unit);
  return {dot(d, f.to_x) / w, dot(d, f.to_y) / w, w};
}
/// How far out: at most 1 inside.
inline float outness(float x, float y) { return greater(magnitude(x), magnitude(y)); }

/// Point of least outness of the stretch between two points: least at an end, on a diagonal or where it crosses an axis.
inline Place innermost(const Place& a, const Place& b) {
  const float dx = b.x - a.x, dy = b.y - a.y;
  const float at[6] = {0, 1, (a.y - a.x) / (dx - dy), (0 - (a.x + a.y)) / (dx + dy), (0 - a.x) / dx, (0 - a.y) / dy};
  Place best{a.x, a.y, outness(a.x, a.y)};
  for (const float t : at) {
    if (!(t >= 0) || !(t <= 1)) continue;
    const float x = a.x + t * dx, y = a.y + t * dy, out = outness(x, y);
    if (out < best.w) best = {x, y, out};
  }
  return best;  // w: the outness
}

/// Point of a ball nearest to the axis.
inline Vec3<float> ball_point(const BeamFrame& f, const Vec3<float>& c, float r) {
  const Vec3<float> d = c - f.apex, off = d - (dot(d, f.axis) / dot(f.axis, f.axis)) * f.axis;
  const float far = length(off);
  return far <= r ? c - off : c - ((.9f * r) / far) * off;
}

/// Innermost point of a triangle; false when a corner lies behind the apex.
inline bool triangle_point(const BeamFrame& f, const Vec3<float> (&c)[3], Vec3<float>& out) {
  Place q[3];
  for (int i = 0; i < 3; ++i) {
    q[i] = place(f, c[i]);
    if (!(q[i].w > 0)) return false;
  }
  int left = 0, right = 0;
  Place best{0, 0, kInfinity};
  for (int i = 0; i < 3; ++i) {
    const Place &a = q[i], &b = q[(i + 1) % 3];
    const float side = a.x * (b.y - a.y) - a.y * (b.x - a.x);
    left += side >= 0, right += side <= 0;
    const Place in = innermost(a, b);
    if (in.w < best.w) best = in;
  }
  if (left == 3 || right == 3) best = {0, 0, 0};
  const float mx = (1.f / 3) * ((q[0].x + q[1].x) + q[2].x), my = (1.f / 3) * ((q[0].y + q[1].y) + q[2].y);
  const float x = best.x + .01f * (mx - best.x), y = best.y + .01f * (my - best.y);  // off the edge
  const Vec3<float> n = cross(c[1] - c[0], c[2] - c[0]), dir = f.axis + x * f.right + y * f.up;
  const float t = dot(c[0] - f.apex, n) / dot(dir, n);
  if (!(t > 0) || !(t < kInfinity)) return false;
  out = f.apex + t * dir;
  return true;
}

struct Corners3 {
  Vec3<float> at[3];
};
inline Corners3 triangle_corners(const GeometryView& g, std::uint32_t i) {
  const std::uint32_t v[3] = {g.ta[i], g.tb[i], g.tc[i]};
  Corners3 c;
  for (int k = 0; k < 3; ++k) c.at[k] = {g.tx[v[k]], g.ty[v[k]], g.tz[v[k]]};
  return c;
}

/// A point of a primitive's surface inside the beam, nearer than w = `far`; false when it has none that this finds. The point lies
/// in a cell that lists the primitive and that the beam walks through, whatever the grid.
inline bool meets(const SceneView& scene, const BeamFrame& f, std::uint32_t id, float far, Vec3<float>& p) {
  const GeometryView& g = scene.geometry;
  if (id < scene.sphere_base) return false;  // a plane ends nowhere inside a beam: its corners see it
  if (id >= scene.triangle_base && id < scene.cone_base) {
    if (!triangle_point(f, triangle_corners(g, id - scene.triangle_base).at, p)) return false;
    const Place at = place(f, p);
    return at.w > f.depth && at.w < far && outness(at.x, at.y) <= 1;
  }
  Vec3<float> center, base{}, axis{};
  float radius = 0;
  if (id < scene.triangle_base) {
    const std::uint32_t i = id - scene.sphere_base;
    center = {g.sx[i], g.sy[i], g.sz[i]}, radius = magnitude(g.sr[i]);
  } else {  // the ball around the cone's axis where that passes nearest to the beam's
    const std::uint32_t i = id - scene.cone_base;
    base = {g.cone[0][i], g.cone[1][i], g.cone[2][i]}, axis = {g.cone[3][i], g.cone[4][i], g.cone[5][i]};
    const float height = g.cone[6][i];
    const Vec3<float> d = base - f.apex;
    const float ab = dot(axis, f.unit), k = 1 - ab * ab;
    float h = k > 1e-6f ? (ab * dot(d, f.unit) - dot(d, axis)) / k : .5f * height;
    h = h < 0 ? 0 : h > height ? height : h;
    center = base + h * axis, radius = g.cone[7][i] + g.cone[8][i] * h;
  }
  const Place toward = place(f, ball_point(f, center, radius));
  if (!(toward.w > 0) || !(outness(toward.x, toward.y) <= 1)) return false;
  const Vec3<float> dir = f.axis + toward.x * f.right + toward.y * f.up, org = f.apex + f.depth * dir;
  const float inv_dd = 1 / dot(dir, dir);
  float t = 0;
  bool hit;
  if (id < scene.triangle_base) {
    hit = hit_sphere<float>(org, dir, inv_dd, 0, center, g.sr[id - scene.sphere_base], t);
  } else {
    const std::uint32_t i = id - scene.cone_base;
    hit = hit_cone<float>(org, dir, inv_dd, 0, {base, axis, g.cone[6][i], g.cone[7][i], g.cone[8][i], g.cone[9][i]}, t);
  }
  p = org + t * dir;
  return hit && f.depth + t < far;
}

/// The primitives, other than those of `known`, that meet() a beam; each once.
struct Met {
  std::uint32_t id[kMostMet];
  Vec3<float> point[kMostMet];
  int size = 0;
  bool full = false;  ///< there were more
};

/// Calls see(id) for every primitive whose bounds the beam meets in this grid, some more than once.
template <class See>
inline bool walk_beam(const GridView& g, const Packet& p, int axis, const See& see, Counters& n) {
  Frustum f;
  switch (bound(g, p, f, axis)) {
    case Spread::kNothing: return true;
    case Spread::kApart: return false;
    case Spread::kTogether: break;
  }
  Mailbox mailbox;
  mailbox.clear();
  const auto once = [&](std::uint32_t id) {
    if (!mailbox.seen(id)) see(id);
  };
  const std::size_t stride[3] = {1, static_cast<std::size_t>(g.n[0]), static_cast<std::size_t>(g.n[0]) * static_cast<std::size_t>(g.n[1])};
  const int nk = g.n[f.k];
  int slice = clamp_cell(static_cast<double>(f.from - f.margin), nk);
  const int last = clamp_cell(static_cast<double>(f.to + f.margin), nk);
  for (; slice <= last; ++slice) {
    int least[2], most[2];
    if (!rectangle(g, f, slice, least, most)) continue;
    const int sk = f.flip ? nk - 1 - slice : slice;
    int nearest = 255;
    for (int v = least[1]; v <= most[1]; ++v)
      for (int u = least[0]; u <= most[0]; ++u) {
        const std::size_t cell = static_cast<std::size_t>(sk) * stride[f.k] + static_cast<std::size_t>(u) * stride[f.u] +
                                 static_cast<std::size_t>(v) * stride[f.v];
        ++n.visits;
        const int distance = g.distance[cell];
        nearest = distance < nearest ? distance : nearest;
        if (distance != 0) continue;
        if (g.lists.triangle_first)
          for (std::uint32_t b = g.lists.triangle_first[cell]; b < g.lists.triangle_first[cell + 1]; ++b)
            for (int i = 0; i < kBlock; i += kWidth<Block>)
              for (unsigned left = triangles_inside(f, g.lists.triangles[b], i); left != 0; left &= left - 1)
                once(g.lists.triangles[b].id[i + __builtin_ctz(left)]);
        if (g.lists.sphere_first)
          for (std::uint32_t i = g.lists.sphere_first[cell], end = g.lists.sphere_first[cell + 1]; i < end; i += kWidth<Block>)
            for (unsigned left = spheres_inside(f, g.lists, i, end); left != 0; left &= left - 1)
              once(g.lists.sphere_id[i + static_cast<unsigned>(__builtin_ctz(left))]);
        if (g.lists.cone_first)
          for (std::uint32_t i = g.lists.cone_first[cell], end = g.lists.cone_first[cell + 1]; i < end; i += kWidth<Block>)
            for (unsigned left = cones_inside(f, g.lists, i, end); left != 0; left &= left - 1)
              once(g.lists.cone_id[i + static_cast<unsigned>(__builtin_ctz(left))]);
      }
    if (nearest > 1) slice += f.steepest > 1 ? static_cast<int>(static_cast<float>(nearest - 1) / f.steepest) : nearest - 1;
  }
  return true;
}

/// Every primitive of the list without a grid.
template <class See>
inline void see_outside(const CellLists& lists, const See& see) {
  if (lists.triangle_first)
    for (std::uint32_t b = 0; b < lists.triangle_first[1]; ++b)
      for (int i = 0; i < kBlock && lists.triangles[b].a[0][i] == lists.triangles[b].a[0][i]; ++i) see(lists.triangles[b].id[i]);
  if (lists.sphere_first)
    for (std::uint32_t i = 0; i < lists.sphere_first[1]; ++i) see(lists.sphere_id[i]);
  if (lists.cone_first)
    for (std::uint32_t i = 0; i < lists.cone_first[1]; ++i) see(lists.cone_id[i]);
}

/// The weight, 0 to 1, of what may hide: `inside`, where something was met that no corner sees; `around`, where the corners differ,
/// or the beam cannot tell: what hides then shows in the pixels around as well, whose colours bound it.
struct Doubt {
  float inside = 0, around = 0;
  bool none() const { return inside == 0 && around == 0; }
};
inline Doubt around(float weight) { return {0, weight}; }
inline Doubt operator+(const Doubt& a, const Doubt& b) { return {greater(a.inside, b.inside), greater(a.around, b.around)}; }

class Watcher {
 public:
  Watcher(const SceneView& scene, const ShadingView& shading, Counters& counters) : scene_(scene), shading_(shading), n_(counters) {}

  /// What may hide in the light that comes along the beam with `weight`. None: it is plain, one smooth surface under light that is
  /// whole or wholly blocked, and so in mirrors `bounces` more times. `whole`: only a surface that is one convex primitive counts,
  /// which makes the answer sure.
  Doubt doubt(const Beam& beam, bool whole, int bounces, float weight, std::uint32_t mirror_id = kNoPrimitive) {
    BeamFrame f;
    if (!frame_of(beam, f)) return around(weight);
    Sight sight;
    trace_corners(beam, sight);
    float far = 0;
    bool differ = false;
    for (int i = 0; i < kCorners; ++i) {
      const bool hit = sight.id[i] != kNoPrimitive;
      differ |= whole ? sight.id[i] != sight.id[0] || (hit && sight.id[i] >= scene_.cone_base) : !alike(sight.id[0], sight.id[i]);
      far = greater(hit ? place(f, beam.org[i] + sight.t[i] * beam.dir[i]).w * 1.0001f : kInfinity, far);
    }
    if (whole && differ) return around(weight);
    Met met;
    if (!collect(f, far, sight.id, whole, met)) return around(weight);
    if (const Doubt found = hidden(f, met, sight.id, mirror_id, weight); !found.none()) return found;
    if (differ || !closed(f, met, sight.id)) return around(weight);
    if (sight.id[0] == kNoPrimitive) return {};

    Surface s[kCorners];
    for (int i = 0; i < kCorners; ++i) {
      const float org[3] = {beam.org[i].x, beam.org[i].y, beam.org[i].z}, dir[3] = {beam.dir[i].x, beam.dir[i].y, beam.dir[i].z};
      s[i] = surface_of(scene_, sight.id[i], org, dir, sight.t[i], shading_.smooth);
      if (dot(beam.dir[i], s[i].normal) > 0)
        s[i].normal = Vec3<float>{0, 0, 0} - s[i].normal, s[i].shading = Vec3<float>{0, 0, 0} - s[i].shading;
      if (dot(s[i].normal, s[0].normal) < .8f) return around(weight);
    }
    const auto field = [&](MaterialField k) { return shading_.materials.field[k][s[0].material]; };
    if (field(kTransmission) > 0) return around(weight);
    const auto color = [&](MaterialField k) { return Vec3<float>{field(k), field(static_cast<MaterialField>(k + 1)), field(static_cast<MaterialField>(k + 2))}; };
    const Vec3<float> answer = color(kDiffuseR) + color(kSpecularR);
    Doubt most;
    for (int l = 0; l < shading_.light_count; ++l) {
      const float* const light = shading_.lights + kLightFloats * l;
      const float part = lesser(largest(answer * Vec3<float>{light[3], light[4], light[5]}), 1.f) * weight;
      if (part > most.inside) most = most + uneven_light(light, s, sight.id, whole, part);
    }
    const float mirror = lesser(largest(color(kMirrorR)), 1.f) * weight;
    if (!(mirror > most.inside) || mirror < 1.f / 64 || field(kRoughness) > 0 || bounces == 0) return most;
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
    Packet p;
    fill(beam, p);
    trace_packet<false>(scene_, p, {16, true}, n_);
    for (int i = 0; i < kCorners; ++i) sight.id[i] = id_of(p.id[i]), sight.t[i] = p.moved ? p.best[i] + p.shift[i] : p.best[i];
  }

  static void fill(const Beam& beam, Packet& p) {
    p.size = kCorners;
    for (int i = 0; i < kCorners; ++i) {
      p.org[0][i] = beam.org[i].x, p.org[1][i] = beam.org[i].y, p.org[2][i] = beam.org[i].z;
      p.dir[0][i] = beam.dir[i].x, p.dir[1][i] = beam.dir[i].y, p.dir[2][i] = beam.dir[i].z;
      p.t_min[i] = 0, p.best[i] = kInfinity;
    }
  }

  /// Primitives that meet the beam before w = `far`, other than `known`; false when no answer can be had, or when `single` and
  /// there is one.
  bool collect(const BeamFrame& f, float far, const std::uint32_t (&known)[kCorners], bool single, Met& met) {
    const auto see = [&](std::uint32_t id) {
      if (met.full || id == known[0] || id == known[1] || id == known[2] || id == known[3]) return;
      Vec3<float> point;
      if (!meets(scene_, f, id, far, point)) return;
      for (int i = 0; i < met.size; ++i)
        if (met.id[i] == id) return;
      if (met.size == kMostMet || single) {
        met.full = true;
        return;
      }
      met.id[met.size] = id, met.point[met.size++] = point;
    };
    see_outside(scene_.outside, see);
    if (met.full) return false;
    if (scene_.grid_count == 0) return true;
    Packet p;
    p.size = kCorners;
    for (int i = 0; i < kCorners; ++i) {  // the edges of the pyramid, with w for t
      const Vec3<float> dir = f.axis + (i == 1 || i == 2 ? 1.f : -1.f) * f.right + (i >= 2 ? 1.f : -1.f) * f.up, org = f.apex + f.depth * dir;
      p.org[0][i] = org.x, p.org[1][i] = org.y, p.org[2][i] = org.z;
      p.dir[0][i] = dir.x, p.dir[1][i] = dir.y, p.dir[2][i] = dir.z;
      p.t_min[i] = 0, p.best[i] = 1.001f * (far - f.depth);
    }
    prepare(p, false);
    bring_near(scene_, p);
    const float m[3] = {magnitude(f.unit.x), magnitude(f.unit.y), magnitude(f.unit.z)};
    const int axis = m[0] >= m[1] && m[0] >= m[2] ? 0 : m[1] >= m[2] ? 1 : 2;
    for (int g = 0; g < scene_.grid_count; ++g)
      if (!walk_beam(scene_.grids[g], p, axis, see, n_) || met.full) return false;
    return true;
  }

  bool is_triangle(std::uint32_t id) const { return id >= scene_.triangle_base && id < scene_.cone_base; }

  Vec3<float> flat_normal(std::uint32_t i) const {
    const Corners3 c = triangle_corners(scene_.geometry, i);
    return cross(c.at[1] - c.at[0], c.at[2] - c.at[0]);
  }

  /// Whether two primitives pass for one surface: triangles of one material that face nearly one way. Where one hides the other
  /// and both are lit alike, nobody can tell.
  bool alike(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return true;
    if (!is_triangle(a) || !is_triangle(b)) return false;
    const std::uint32_t i = a - scene_.triangle_base, j = b - scene_.triangle_base;
    if (scene_.geometry.triangle_material[i] != scene_.geometry.triangle_material[j]) return false;
    const Vec3<float> n = flat_normal(i), m = flat_normal(j);
    const float d = dot(n, m);
    return d * d > .64f * (dot(n, n) * dot(m, m));
  }

  bool one_surface(const std::uint32_t (&id)[kCorners]) const { return alike(id[0], id[1]) && alike(id[0], id[2]) && alike(id[0], id[3]); }

  bool touch(std::uint32_t a, std::uint32_t b) const {
    if (!is_triangle(a) || !is_triangle(b)) return a == b;
    const Corners3 p = triangle_corners(scene_.geometry, a - scene_.triangle_base), q = triangle_corners(scene_.geometry, b - scene_.triangle_base);
    bool found = false;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) found |= p.at[k].x == q.at[l].x && p.at[k].y == q.at[l].y && p.at[k].z == q.at[l].z;
    return found;
  }
  /// Triangles of one material: pieces of one mesh, most likely.
  bool kin(std::uint32_t a, std::uint32_t b) const {
    return is_triangle(a) && is_triangle(b) &&
           scene_.geometry.triangle_material[a - scene_.triangle_base] == scene_.geometry.triangle_material[b - scene_.triangle_base];
  }
  template <class Test>
  static bool any_of(const std::uint32_t (&id)[kCorners], const Test& test) {
    return test(id[0]) || test(id[1]) || test(id[2]) || test(id[3]);
  }

  /// Sends a ray to each point met. Where all of them end on what passes for a surface that the corners see, nothing hides; where
  /// one ends on another side of their mesh, that shows around as well.
  Doubt hidden(const BeamFrame& f, const Met& met, const std::uint32_t (&front)[kCorners], std::uint32_t mirror_id, float weight) {
    Doubt found;
    for (int first = 0; first < met.size; first += 16) {
      Packet p;
      p.size = met.size - first < 16 ? met.size - first : 16;
      for (int i = 0; i < p.size; ++i) {
        const Vec3<float> to = normalize(met.point[first + i] - f.apex), start = f.apex + (f.depth / dot(to, f.unit)) * to;
        p.org[0][i] = start.x, p.org[1][i] = start.y, p.org[2][i] = start.z;
        p.dir[0][i] = to.x, p.dir[1][i] = to.y, p.dir[2][i] = to.z;
        p.t_min[i] = 0, p.best[i] = kInfinity;
      }
      trace_packet<false>(scene_, p, {16, true}, n_);
      for (int i = 0; i < p.size; ++i) {
        const std::uint32_t id = id_of(p.id[i]);
        if (any_of(front, [&](std::uint32_t seen) { return alike(seen, id); })) continue;
        const bool own = mirror_id != kNoPrimitive && (id == mirror_id || kin(id, mirror_id));  // a bulging mirror in its own way
        if (!own && !any_of(front, [&](std::uint32_t seen) { return kin(seen, id); })) return {weight, weight};
        found = around(weight);
      }
    }
    return found;
  }

  /// Whether the triangles that pass for one surface leave no gap in the beam: each edge inside it belongs to two of them.
  bool closed(const BeamFrame& f, const Met& met, const std::uint32_t (&front)[kCorners]) const {
    if (!is_triangle(front[0])) return true;
    std::uint32_t sheet[kMostMet + kCorners];
    int size = 0;
    const auto add = [&](std::uint32_t id) {
      for (int i = 0; i < size; ++i)
        if (sheet[i] == id) return;
      sheet[size++] = id;
    };
    for (const std::uint32_t id : front) add(id);
    for (int i = 0; i < met.size; ++i)
      if (alike(front[0], met.id[i])) add(met.id[i]);
    if (size == 1) return true;
    Corners3 c[kMostMet + kCorners];
    for (int i = 0; i < size; ++i) c[i] = triangle_corners(scene_.geometry, sheet[i] - scene_.triangle_base);
    const auto same = [](const Vec3<float>& a, const Vec3<float>& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    const auto has = [&](const Corners3& t, const Vec3<float>& p) { return same(t.at[0], p) || same(t.at[1], p) || same(t.at[2], p); };
    for (int i = 0; i < size; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3<float>&a = c[i].at[k], &b = c[i].at[(k + 1) % 3];
        if (innermost(place(f, a), place(f, b)).w > .95f) continue;  // its other triangle may lie just outside
        bool shared = false;
        for (int j = 0; j < size && !shared; ++j) shared = j != i && has(c[j], a) && has(c[j], b);
        if (!shared) return false;
      }
    return true;
  }

  /// Doubt whether the light, of weight `part`, reaches all of the patch between four points, or none of it.
  Doubt uneven_light(const float* light, const Surface (&s)[kCorners], const std::uint32_t (&on)[kCorners], bool whole, float part) {
    const Vec3<float> at{light[0], light[1], light[2]};
    Beam beam;
    float away[kCorners], far = 0;
    int facing = 0;
    for (int i = 0; i < kCorners; ++i) {
      const Vec3<float> to = s[i].point + s[i].away * s[i].normal - at;
      away[i] = length(to);
      beam.org[i] = at, beam.dir[i] = (1 / away[i]) * to;
      facing += dot(to, s[i].normal) < 0;
    }
    if (facing == 0) return {};
    BeamFrame f;
    if (!frame_of(beam, f)) return around(part);
    Sight sight;
    float least = kInfinity;
    for (int i = 0; i < kCorners; ++i) least = lesser(away[i], least), far = greater(away[i], far);
    trace_corners(beam, sight);
    int lit = 0;
    for (int i = 0; i < kCorners; ++i) lit += !(sight.t[i] < away[i] * .9999f) || any_of(on, [&](std::uint32_t own) { return touch(own, sight.id[i]); });
    if (lit != 0 && lit != kCorners) return around(part);
    if (lit == 0) {
      const bool one = sight.id[0] == sight.id[1] && sight.id[0] == sight.id[2] && sight.id[0] == sight.id[3] && sight.id[0] < scene_.cone_base;
      if (one) return {};
      Met shade;
      return !whole && one_surface(sight.id) && collect(f, far, sight.id, false, shade) && closed(f, shade, sight.id) ? Doubt{} : around(part);
    }
    // Lit at its corners: whatever stands between throws its shadow inside.
    Met met;
    if (!collect(f, least * .9999f, on, whole, met)) return around(part);
    Doubt found;
    for (int i = 0; i < met.size; ++i) {
      if (any_of(on, [&](std::uint32_t own) { return touch(own, met.id[i]); })) continue;
      if (!any_of(on, [&](std::uint32_t own) { return kin(own, met.id[i]); })) return {part, part};
      found = around(part);
    }
    return found;
  }

  const SceneView& scene_;
  const ShadingView& shading_;
  Counters& n_;
};

/// Beam through the square of `size` pixels at (x0, y0), grown a little about its centre: what only touches its edge counts as
/// well. By a quarter when a whole square is to be left out; by a sixteenth for a pixel, lest it doubts what its neighbours see.
inline Beam pixel_beam(const FrameView& f, int x0, int y0, int size) {
  const float half = .5f * static_cast<float>(size), mx = static_cast<float>(x0) + half, my = static_cast<float>(y0) + half;
  const float rx = size > 1 ? 1.25f * half : 1.0625f * half, ry = rx;
  const float sign[kCorners][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  Beam b;
  for (int i = 0; i < kCorners; ++i) {
    const float sx = (mx + sign[i][0] * rx) - .5f * static_cast<float>(f.width);
    const float sy = .5f * static_cast<float>(f.height) - (my + sign[i][1] * ry);
    b.org[i] = {f.eye[0], f.eye[1], f.eye[2]};
    b.dir[i] = normalize(Vec3<float>{(f.forward[0] + sx * f.right[0]) + sy * f.up[0], (f.forward[1] + sx * f.right[1]) + sy * f.up[1],
                                     (f.forward[2] + sx * f.right[2]) + sy * f.up[2]});
  }
  return b;
}

/// Doubt of the pixels of an 8 x 8 tile, [8 y + x], those with a bit in `asked`. Squares that are plain as a whole save their parts.
inline void tile_doubt(Watcher& watcher, const FrameView& f, int x0, int y0, int size, int bounces, std::uint64_t asked,
                       float (&inside)[kTile * kTile], float (&around)[kTile * kTile]) {
  const int first = y0 % kTile * kTile + x0 % kTile;
  const std::uint64_t row = ~std::uint64_t{0} >> (64 - size);
  std::uint64_t here = 0;
  for (int y = 0; y < size; ++y) here |= row << (first + y * kTile);
  if ((asked & here) == 0) return;
  const Doubt doubt = watcher.doubt(pixel_beam(f, x0, y0, size), size > 1, bounces, 1);
  if (size == 1 || doubt.none()) {
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) inside[first + y * kTile + x] = doubt.inside, around[first + y * kTile + x] = doubt.around;
    return;
  }
  const int h = size / 2;
  for (int i = 0; i < 4; ++i) tile_doubt(watcher, f, x0 + i % 2 * h, y0 + i / 2 * h, h, bounces, asked, inside, around);
}

}  // namespace grelha::GRELHA_ISA
