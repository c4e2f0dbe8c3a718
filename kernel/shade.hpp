#pragma once
// Whitted shading of a batch of hits: local light with shadow rays, then the reflected and refracted rays they send on.
//
// Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn's highlight and, for materials that ask
// for it, Schlick's Fresnel term (1994). No falloff, no ambient light, any hit blocks light (the course's rules).

#include "kernel/power.hpp"
#include "kernel/sampling.hpp"
#include "kernel/surface.hpp"
#include "kernel/trace.hpp"

namespace grelha::GRELHA_ISA {

inline std::int64_t light_units(float x, float most) {
  if (!(x == x)) return 0;
  const float c = x > most ? most : x < 0 - most ? 0 - most : x;
  const double u = static_cast<double>(c) * kLightUnit;
  return static_cast<std::int64_t>(u < 0 ? u - .5 : u + .5);
}

inline void add_light(const BandWork& work, std::uint32_t pixel, float r, float g, float b) {
  std::int64_t* const s = work.sums + static_cast<std::size_t>(pixel) * 3;
  s[0] += light_units(r, work.most_light), s[1] += light_units(g, work.most_light), s[2] += light_units(b, work.most_light);
}

/// The pixels whose samples the rays of these sums are.
inline Words<Lanes> pixels_of(const BandWork& work, const std::uint32_t* sums) {
  if (!work.pixels) return load_words<Lanes>(sums) + work.first_pixel;
  std::uint32_t pixel[kWidth<Lanes>];
  for (int k = 0; k < kWidth<Lanes>; ++k) pixel[k] = work.pixels[sums[k]];
  return load_words<Lanes>(pixel);
}

/// Says what comes next, to whoever asks; nothing else depends on it.
inline void enter(const BandWork& work, Phase phase) {
  if (work.observer) work.observer->enter(*work.observer, phase, nullptr);
}
inline void enter(const BandWork& work, Phase phase, const RayArrays& r, int count) {
  if (!work.observer) return;
  const ObservedRays rays{r.ox, r.oy, r.oz, r.dx, r.dy, r.dz, r.t_min, r.t, count};
  work.observer->enter(*work.observer, phase, &rays);
}

struct RayTally {
  std::uint64_t primary = 0, shadow = 0, reflection = 0, refraction = 0;
};

/// Everything a thread's shading needs to know.
struct Shader {
  const SceneView& scene;
  const ShadingView& shading;
  const BandWork& work;
  Counters& counters;
  RayTally& rays;
  Batch& b;
};

/// Fills the hit arrays from rays [0, count); misses send the background. Returns the number of hits.
inline int find_surfaces(const Shader& s, int count) {
  Batch& b = s.b;
  const float* const bg = s.shading.background;
  int hits = 0;
  for (int i = 0; i < count; ++i) {
    if (b.id[i] == kNoPrimitive) {
      add_light(s.work, b.pixel[i], b.wr[i] * bg[0], b.wg[i] * bg[1], b.wb[i] * bg[2]);
      continue;
    }
    const float org[3] = {b.ox[i], b.oy[i], b.oz[i]}, dir[3] = {b.dx[i], b.dy[i], b.dz[i]};
    const Surface f = surface_of(s.scene, b.id[i], org, dir, b.t[i], s.shading.smooth);
    const Vec3<float> d{dir[0], dir[1], dir[2]};
    const bool inside = dot(d, f.normal) > 0;
    const float side = inside ? -1.f : 1.f;
    const Vec3<float> v = normalize(Vec3<float>{0, 0, 0} - d);
    const int h = hits++;
    b.px[h] = f.point.x, b.py[h] = f.point.y, b.pz[h] = f.point.z;
    b.gx[h] = side * f.normal.x, b.gy[h] = side * f.normal.y, b.gz[h] = side * f.normal.z;
    b.nx[h] = side * f.shading.x, b.ny[h] = side * f.shading.y, b.nz[h] = side * f.shading.z;
    b.vx[h] = v.x, b.vy[h] = v.y, b.vz[h] = v.z;
    b.away[h] = f.away, b.inside[h] = inside ? 1.f : 0.f;
    b.hr[h] = b.wr[i], b.hg[h] = b.wg[i], b.hb[h] = b.wb[i];
    b.hit_pixel[h] = b.pixel[i], b.hit_depth[h] = b.depth[i], b.material[h] = f.material;
    if (s.work.plan.on) b.hit_sample[h] = b.sample[i], b.hit_path[h] = b.path[i];
  }
  return hits;
}

inline Vec3<Lanes> load3(const float* x, const float* y, const float* z, int i) {
  return {load<Lanes>(x + i), load<Lanes>(y + i), load<Lanes>(z + i)};
}

/// One material value for each of the hits i, i + 1, ...; the batch's tail repeats stale but valid indices, see pad_tail.
inline Lanes gather(const ShadingView& s, MaterialField field, const std::uint32_t* material) {
  float v[kWidth<Lanes>];
  for (int k = 0; k < kWidth<Lanes>; ++k) v[k] = s.materials.field[field][material[k]];
  return load<Lanes>(v);
}

inline Vec3<Lanes> gather3(const ShadingView& s, MaterialField r, const std::uint32_t* material) {
  return {gather(s, r, material), gather(s, static_cast<MaterialField>(r + 1), material),
          gather(s, static_cast<MaterialField>(r + 2), material)};
}

/// Makes the lanes beyond the last hit harmless: copies of the last one.
inline void pad_tail(Batch& b, int hits, bool sampled) {
  const int end = (hits + kWidth<Lanes> - 1) / kWidth<Lanes> * kWidth<Lanes>, last = hits - 1;
  for (int i = hits; i < end; ++i) {
    b.material[i] = b.material[last];
    if (sampled) b.hit_pixel[i] = b.hit_pixel[last], b.hit_sample[i] = b.hit_sample[last], b.hit_path[i] = b.hit_path[last];
  }
}

inline unsigned lanes_of(int first, int count) {
  const int left = count - first;
  return left >= kWidth<Lanes> ? ~0u >> (32 - kWidth<Lanes>) : (1u << left) - 1u;
}

/// Tells apart the uses of a pair of dimensions along one path; 0 for the first light, or lobe, that a camera ray meets.
template <class Word>
inline Word sample_keys(Word path, std::uint32_t use) {
  const Word key = scatter(path, use) | 1u;
  return use != 0 ? key : path == 0u ? Word{} : key;
}

/// Numbers for an effect at the hits i, i + 1, ..., which takes `count` samples for each of the pixel's: the `number`-th.
inline PairOf<Lanes> hit_samples(const Shader& s, int i, int dimension, std::uint32_t use, int number, int count, const Strata& strata) {
  const Words<Lanes> index = load_words<Lanes>(s.b.hit_sample + i) * static_cast<std::uint32_t>(count) + static_cast<std::uint32_t>(number);
  return sample_pairs<Lanes>(s.work.plan, pixels_of(s.work, s.b.hit_pixel + i), index, dimension,
                             sample_keys(load_words<Lanes>(s.b.hit_path + i), use), strata);
}

/// Points of an area light: lane k's is the `number[k]`-th of hit of[k].
[[gnu::noinline]] inline Vec3<Lanes> light_points(const Shader& s, const int* of, const std::uint32_t* number, const float* light, int light_index) {
  const SamplePlan& plan = s.work.plan;
  std::uint32_t pixel[kWidth<Lanes>], index[kWidth<Lanes>], path[kWidth<Lanes>];
  for (int k = 0; k < kWidth<Lanes>; ++k) {
    pixel[k] = s.b.hit_pixel[of[k]], path[k] = s.b.hit_path[of[k]];
    index[k] = s.b.hit_sample[of[k]] * static_cast<std::uint32_t>(plan.light_rays) + number[k];
  }
  const PairOf<Lanes> p = sample_pairs<Lanes>(plan, pixels_of(s.work, pixel), load_words<Lanes>(index), plan.light,
                                              sample_keys(load_words<Lanes>(path), static_cast<std::uint32_t>(light_index)), plan.light_strata);
  const Lanes a = p.u - Lanes(.5f), c = p.v - Lanes(.5f);
  return {Lanes(light[0]) + (a * Lanes(light[6]) + c * Lanes(light[9])),
          Lanes(light[1]) + (a * Lanes(light[7]) + c * Lanes(light[10])),
          Lanes(light[2]) + (a * Lanes(light[8]) + c * Lanes(light[11]))};
}

/// Traces the first n shadow rays of the batch and adds what those carry that nothing stands in the way of.
inline void light_up(const Shader& s, int n) {
  Batch& b = s.b;
  if (n == 0) return;
  s.rays.shadow += static_cast<unsigned>(n);
  const RayArrays rays{b.lox, b.loy, b.loz, b.ldx, b.ldy, b.ldz, b.lt_min, b.lt, b.lid};
  enter(s.work, Phase::shadow, rays, n);
  trace<true>(s.scene, rays, n, {s.work.packet, s.work.mailbox}, s.counters);
  enter(s.work, Phase::light);
  for (int i = 0; i < n; ++i)
    if (b.lid[i] == kNoPrimitive) add_light(s.work, b.light_pixel[i], b.lr[i], b.lg[i], b.lb[i]);
}

/// Light of one source on all hits: a shadow ray for each that faces it, and what that ray carries if nothing stands in its
/// way; from an area light `light_rays` to each hit, which stand next to each other and carry a share each.
inline void light_hits(const Shader& s, int hits, int light_index, bool area) {
  constexpr int w = kWidth<Lanes>;
  Batch& b = s.b;
  const float* const light = s.shading.lights + kLightFloats * light_index;
  Vec3<Lanes> at{Lanes(light[0]), Lanes(light[1]), Lanes(light[2])};
  const int each = area ? s.work.plan.light_rays : 1, total = hits * each;
  const float share = 1.f / static_cast<float>(each);
  const Vec3<Lanes> color{Lanes(light[3] * share), Lanes(light[4] * share), Lanes(light[5] * share)};
  const Lanes o(0);
  int n = 0, of[w], hit = 0, ray = 0;
  std::uint32_t number[w], material[w];
  for (int i = 0; i < total; i += w) {
    if (n + w > kBatch) light_up(s, n), n = 0;
    for (int k = 0; k < w; ++k) {
      of[k] = hit, number[k] = static_cast<std::uint32_t>(ray), material[k] = b.material[hit];
      if (++ray == each) ray = 0, hit += hit + 1 < hits;
    }
    const auto of_hits = [&](const float* from) {
      if (each == 1) return load<Lanes>(from + i);
      float v[w];
      for (int k = 0; k < w; ++k) v[k] = from[of[k]];
      return load<Lanes>(v);
    };
    const auto three = [&](const float* x, const float* y, const float* z) { return Vec3<Lanes>{of_hits(x), of_hits(y), of_hits(z)}; };
    const Vec3<Lanes> p = three(b.px, b.py, b.pz), g = three(b.gx, b.gy, b.gz), normal = three(b.nx, b.ny, b.nz);
    if (area) at = light_points(s, of, number, light, light_index);
    const Vec3<Lanes> org = p + of_hits(b.away) * g;  // the lit side is the viewer's side
    const Vec3<Lanes> dir = at - org, l = normalize(dir);
    const Lanes nl = dot(normal, l);
    const unsigned lit = bits(both(nl > o, dot(g, l) > o)) & lanes_of(i, total);
    if (lit == 0) continue;
    Vec3<Lanes> c = nl * gather3(s.shading, kDiffuseR, material);
    if (s.shading.highlights) {
      const Vec3<Lanes> half = normalize(l + three(b.vx, b.vy, b.vz));
      const Lanes nh = greater(dot(normal, half), o);
      c = c + power(nh, gather(s.shading, kShine, material)) * gather3(s.shading, kSpecularR, material);
    }
    c = color * (three(b.hr, b.hg, b.hb) * c);
    float out[9][w];
    store(out[0], org.x), store(out[1], org.y), store(out[2], org.z);
    store(out[3], dir.x), store(out[4], dir.y), store(out[5], dir.z);
    store(out[6], c.x), store(out[7], c.y), store(out[8], c.z);
    for (unsigned left = lit; left != 0; left &= left - 1) {
      const int k = __builtin_ctz(left);
      b.lox[n] = out[0][k], b.loy[n] = out[1][k], b.loz[n] = out[2][k];
      b.ldx[n] = out[3][k], b.ldy[n] = out[4][k], b.ldz[n] = out[5][k];
      b.lr[n] = out[6][k], b.lg[n] = out[7][k], b.lb[n] = out[8][k];
      b.light_pixel[n] = b.hit_pixel[of[k]];
      b.lt_min[n] = 0, b.lt[n] = 1;
      ++n;
    }
  }
  light_up(s, n);
}

inline void push(RayStack& stack, const Vec3<float>& org, const Vec3<float>& dir, const Vec3<float>& weight, std::uint32_t pixel,
                 std::uint32_t depth) {
  const int i = stack.size++;
  stack.ox[i] = org.x, stack.oy[i] = org.y, stack.oz[i] = org.z;
  stack.dx[i] = dir.x, stack.dy[i] = dir.y, stack.dz[i] = dir.z;
  stack.wr[i] = weight.x, stack.wg[i] = weight.y, stack.wb[i] = weight.z;
  stack.pixel[i] = pixel, stack.depth[i] = depth;
}

/// Directions in the lobes of the rough mirrors at the hits i, i + 1, ...: the unit mirror directions moved within a disc
/// across them, kept above the surface. Each takes `rays` of them; this is the `ray`-th.
[[gnu::noinline]] inline Vec3<Lanes> lobe_directions(const Shader& s, int i, const Vec3<Lanes>& mirror, const Lanes& roughness, int ray, int rays) {
  const SamplePlan& plan = s.work.plan;
  const PairOf<Lanes> d = disc_point(hit_samples(s, i, plan.gloss, 0, ray, rays, plan.gloss_strata));
  Vec3<Lanes> u, v;
  across(mirror, u, v);
  const Vec3<Lanes> to = mirror + (roughness * d.u) * u + (roughness * d.v) * v, g = load3(s.b.gx, s.b.gy, s.b.gz, i);
  const Lanes under = dot(to, g);
  return normalize(select(under < Lanes(0), to - (under + under) * g, to));
}

/// Sends the reflected and refracted rays of all hits. At the end of the longest path they see the background.
inline void send_on(const Shader& s, RayStack& stack, int hits) {
  Batch& b = s.b;
  const float* const bg = s.shading.background;
  const Lanes o(0), one(1);
  const int around = s.work.plan.gloss_rays;
  const float part = 1.f / static_cast<float>(around + 1);
  for (int i = 0; i < hits; i += kWidth<Lanes>) {
    const Vec3<Lanes> n = load3(b.nx, b.ny, b.nz, i), g = load3(b.gx, b.gy, b.gz, i), v = load3(b.vx, b.vy, b.vz, i);
    const Vec3<Lanes> mirror = gather3(s.shading, kMirrorR, b.material + i);
    Vec3<Lanes> up = mirror;
    Vec3<Lanes> down{o, o, o}, through{o, o, o};
    const Lanes nv = dot(n, v);
    if (s.shading.refracts) {
      const Lanes t = gather(s.shading, kTransmission, b.material + i), ior = gather(s.shading, kIor, b.material + i);
      const Mask<Lanes> clear = t > o, inside = load<Lanes>(b.inside + i) > o;
      const Lanes eta = select(inside, ior, one / ior);
      const Lanes c1 = greater(nv, o), left = one - (eta * eta) * (one - c1 * c1);  // Snell: cos^2 on the other side
      const Mask<Lanes> passes = left >= o;
      const Lanes c2 = square_root(greater(left, o));
      through = (eta * c1 - c2) * n - eta * v;
      Lanes tw = t;
      Vec3<Lanes> rw = mirror;
      if (s.shading.fresnel) {
        const Mask<Lanes> schlick = gather(s.shading, kFresnel, b.material + i) > o;
        const Lanes r = (ior - one) / (ior + one), r0 = r * r;
        const Lanes c = one - select(eta > one, c2, c1), cc = c * c;  // the angle on the thinner side
        const Lanes kr = r0 + (one - r0) * ((cc * cc) * c);
        tw = select(schlick, one - kr, tw);
        rw = select(schlick, Vec3<Lanes>{kr, kr, kr}, rw);
      }
      const Mask<Lanes> refracted = both(clear, passes), total = but_not(clear, passes);
      tw = select(refracted, tw, o);
      down = {tw, tw, tw};
      // On total reflection the mirror ray takes over what would have passed.
      const Mask<Lanes> additive = gather(s.shading, kFresnel, b.material + i) == o;
      const Lanes all = select(additive, t, o), whole = select(additive, o, one);
      up = select(clear, rw, up);
      up = select(total, select(additive, Vec3<Lanes>{up.x + all, up.y + all, up.z + all}, Vec3<Lanes>{whole, whole, whole}), up);
    }
    const Vec3<Lanes> w = load3(b.hr, b.hg, b.hb, i);
    up = w * up, down = w * down;
    Vec3<Lanes> reflected = (nv + nv) * n - v;
    // A smooth normal can send a reflection under the true surface; bend it back above.
    const Lanes under = lesser(dot(reflected, g), o);
    reflected = reflected - (under + under) * g;
    const unsigned in = lanes_of(i, hits);
    const unsigned mirrors = bits(either(either(up.x != o, up.y != o), up.z != o)) & in;
    const unsigned clears = bits(either(either(down.x != o, down.y != o), down.z != o)) & in;
    if ((mirrors | clears) == 0) continue;
    unsigned rough = 0;
    Lanes roughness(0);
    Vec3<Lanes> first = reflected;
    if (s.shading.gloss) {
      roughness = gather(s.shading, kRoughness, b.material + i);
      const Mask<Lanes> spread = roughness > o;
      rough = bits(spread) & mirrors;
      if (rough != 0 && around == 0) first = select(spread, lobe_directions(s, i, reflected, roughness, 0, 1), reflected);
    }
    float r[3][kWidth<Lanes>], q[3][kWidth<Lanes>], u[3][kWidth<Lanes>], d[3][kWidth<Lanes>];
    store(r[0], first.x), store(r[1], first.y), store(r[2], first.z);
    store(q[0], through.x), store(q[1], through.y), store(q[2], through.z);
    store(u[0], up.x), store(u[1], up.y), store(u[2], up.z);
    store(d[0], down.x), store(d[1], down.y), store(d[2], down.z);
    const auto ends = [&](int k) { return b.hit_depth[i + k] >= static_cast<std::uint32_t>(s.work.depth); };
    const auto go = [&](int k, const float (&dir)[3][kWidth<Lanes>], const float (&weight)[3][kWidth<Lanes>], float share,
                        std::uint32_t kind, std::uint32_t branch) {
      const int h = i + k;
      const Vec3<float> p{b.px[h], b.py[h], b.pz[h]}, ng{b.gx[h], b.gy[h], b.gz[h]}, way{dir[0][k], dir[1][k], dir[2][k]};
      if (s.work.plan.on) {
        stack.sample[stack.size] = b.hit_sample[h];
        stack.path[stack.size] = scatter(b.hit_path[h], branch + (kind != 0 ? 0x10001u : 1u));
      }
      push(stack, leave(p, ng, b.away[h], way), way, share * Vec3<float>{weight[0][k], weight[1][k], weight[2][k]}, b.hit_pixel[h],
           (b.hit_depth[h] + 1) | kind);
      ++(kind != 0 ? s.rays.refraction : s.rays.reflection);
    };
    for (unsigned rest = mirrors | clears; rest != 0; rest &= rest - 1) {
      const int k = __builtin_ctz(rest);
      const auto send = [&](const float (&dir)[3][kWidth<Lanes>], const float (&weight)[3][kWidth<Lanes>], float share, std::uint32_t kind) {
        if (!ends(k)) return go(k, dir, weight, share, kind, 0);
        add_light(s.work, b.hit_pixel[i + k], weight[0][k] * bg[0], weight[1][k] * bg[1], weight[2][k] * bg[2]);
      };
      if (mirrors >> k & 1) send(r, u, rough >> k & 1 ? part : 1.f, 0);
      if (clears >> k & 1) send(q, d, 1, kRefracted);
    }
    if (rough == 0) continue;
    for (int j = 0; j < around; ++j) {  // the rays around the mirror direction
      const Vec3<Lanes> lobe = lobe_directions(s, i, reflected, roughness, j, around);
      store(r[0], lobe.x), store(r[1], lobe.y), store(r[2], lobe.z);
      for (unsigned rest = rough; rest != 0; rest &= rest - 1)
        if (const int k = __builtin_ctz(rest); !ends(k)) go(k, r, u, part, 0, static_cast<std::uint32_t>(j + 1));
    }
  }
}

/// Traces and shades the batch: runs of rays that go together, the k-th ending at ends[k]. `phase`: primary or bounce.
inline void shade_batch(const Shader& s, RayStack& stack, const int* ends, int runs, Phase phase) {
  Batch& b = s.b;
  const int count = ends[runs - 1];
  for (int i = 0; i < count; ++i) b.t_min[i] = 0, b.t[i] = kInfinity;
  const TraceOptions options{s.work.packet, s.work.mailbox};
  for (int k = 0, at = 0; k < runs; at = ends[k++]) {
    const RayArrays rays{b.ox + at, b.oy + at, b.oz + at, b.dx + at, b.dy + at, b.dz + at, b.t_min + at, b.t + at, b.id + at};
    enter(s.work, phase, rays, ends[k] - at);
    trace<false>(s.scene, rays, ends[k] - at, options, s.counters);
  }
  enter(s.work, Phase::surface);
  const int hits = find_surfaces(s, count);
  if (hits == 0) return;
  pad_tail(b, hits, s.work.plan.on);
  if (s.shading.emits)
    for (int i = 0; i < hits; ++i) {
      const auto e = [&](MaterialField f) { return s.shading.materials.field[f][b.material[i]]; };
      add_light(s.work, b.hit_pixel[i], b.hr[i] * e(kEmissionR), b.hg[i] * e(kEmissionG), b.hb[i] * e(kEmissionB));
    }
  enter(s.work, Phase::light);
  for (int l = 0; l < s.shading.light_count; ++l) {
    const float* const edges = s.shading.lights + kLightFloats * l + 6;
    bool area = false;
    for (int k = 0; s.shading.area && k < 6; ++k) area |= edges[k] != 0;
    light_hits(s, hits, l, area);
  }
  enter(s.work, Phase::children);
  if (s.shading.reflects) send_on(s, stack, hits);
}

}  // namespace grelha::GRELHA_ISA
