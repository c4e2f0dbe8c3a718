#pragma once
// Whitted shading of a batch of hits: local light with shadow rays, then the reflected and
// refracted rays they send on.
//
// Whitted, "An Improved Illumination Model for Shaded Display", 1980, with Blinn's highlight and,
// for materials that ask for it, Schlick's Fresnel term (1994). No falloff, no ambient light, any
// hit blocks light (the course's rules).

#include "kernel/simd/power.hpp"
#include "kernel/render/sampling.hpp"
#include "kernel/trace/surface.hpp"
#include "kernel/trace/trace.hpp"

namespace grelha::GRELHA_ISA {

/// Light in units of the sums, ties away from zero; what is not a number counts nothing. The
/// compiler's own vectors know which instruction sets can make such integers.
inline void light_units(const Lanes& x, float most, std::int64_t (&units)[kWidth<Lanes>]) {
  constexpr int n = kWidth<Lanes> < 8 ? kWidth<Lanes> : 8;
  using Floats = float __attribute__((vector_size(4 * n)));
  using Doubles = double __attribute__((vector_size(8 * n)));
  using Integers = std::int64_t __attribute__((vector_size(8 * n)));
  float c[kWidth<Lanes>];
  store(c, greater(lesser(select(x == x, x, Lanes(0)), Lanes(most)), Lanes(0 - most)));
  for (int k = 0; k < kWidth<Lanes>; k += n) {
    Floats f;
    __builtin_memcpy(&f, c + k, sizeof f);
    const Doubles u = __builtin_convertvector(f, Doubles) * kLightUnit, half = Doubles{} + .5;
    const Integers i = __builtin_convertvector(u + (u < 0 ? 0 - half : half), Integers);
    __builtin_memcpy(units + k, &i, sizeof i);
  }
}

/// Adds the light of the chosen lanes to their pixels' sums. Where neighbours have one pixel its
/// sum is touched once.
inline void add_light(const BandWork& work,
                      const std::uint32_t* pixel,
                      const Vec3<Lanes>& light,
                      unsigned lanes) {
  if (lanes == 0)
    return;
  std::int64_t r[kWidth<Lanes>], g[kWidth<Lanes>], b[kWidth<Lanes>];
  light_units(light.x, work.most_light, r);
  light_units(light.y, work.most_light, g);
  light_units(light.z, work.most_light, b);
  do {
    const std::uint32_t here = pixel[__builtin_ctz(lanes)];
    std::int64_t sum[3] = {};
    do {
      const int k = __builtin_ctz(lanes);
      sum[0] += r[k];
      sum[1] += g[k];
      sum[2] += b[k];
      lanes &= lanes - 1;
    } while (lanes != 0 && pixel[__builtin_ctz(lanes)] == here);
    std::int64_t* const s = work.sums + static_cast<std::size_t>(here) * 3;
    s[0] += sum[0];
    s[1] += sum[1];
    s[2] += sum[2];
  } while (lanes != 0);
}

/// The pixels whose samples the rays of these sums are.
inline Words<Lanes> pixels_of(const BandWork& work, const Words<Lanes>& sums) {
  return work.pixels ? words_at(work.pixels, sums) : sums + work.first_pixel;
}

/// Says what comes next, to whoever asks; nothing else depends on it.
inline void enter(const BandWork& work, Phase phase) {
  if (work.observer)
    work.observer->enter(*work.observer, phase, nullptr);
}
inline void enter(const BandWork& work, Phase phase, const RayArrays& r, int count) {
  if (!work.observer)
    return;
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

/// Whether shares are more than weights tell: see split().
inline bool keeps_shares(const Shader& s) { return s.shading.gains || s.work.plan.gloss_rays > 0; }

inline Vec3<Lanes> load3(const float* x, const float* y, const float* z, int i) {
  return {load<Lanes>(x + i), load<Lanes>(y + i), load<Lanes>(z + i)};
}

inline Vec3<Lanes> splat(const float* v) { return {Lanes(v[0]), Lanes(v[1]), Lanes(v[2])}; }

/// Lanes of an array of `count` from `first` on.
inline unsigned lanes_of(int first, int count) {
  const int left = count - first;
  return left >= kWidth<Lanes> ? ~0u >> (32 - kWidth<Lanes>) : (1u << left) - 1u;
}

/// Surfaces of rays i, i + 1, ..., which were traced in double.
[[gnu::noinline]] inline Surface<Lanes> surface_in_double(const Shader& s,
                                                          int i,
                                                          const Words<Lanes>& id,
                                                          const Vec3<Lanes>& org,
                                                          const Vec3<Lanes>& dir,
                                                          const Lanes& t) {
  const ExactStart<Lanes> start{load3(s.b.ox_low, s.b.oy_low, s.b.oz_low, i), s.b.whole + i};
  return surface_of<Lanes>(s.scene, id, org, dir, t, s.shading.smooth, start);
}

/// Fills the hit arrays from rays [0, count); misses send the background. Returns the number of
/// hits.
inline int find_surfaces(const Shader& s, int count) {
  Batch& b = s.b;
  const Vec3<Lanes> background = splat(s.shading.background), zero = {Lanes(0), Lanes(0), Lanes(0)};
  int hits = 0;
  for (int i = 0; i < count; i += kWidth<Lanes>) {
    const Words<Lanes> id = load_words<Lanes>(b.id + i);
    const unsigned in = lanes_of(i, count),
                   missed = bits(mask_of(Words<Lanes>(id == kNoPrimitive))) & in;
    const Vec3<Lanes> weight = load3(b.wr, b.wg, b.wb, i);
    add_light(s.work, b.pixel + i, weight * background, missed);
    const Chosen hit(in & ~missed);
    if (hit.count() == 0)
      continue;
    const Vec3<Lanes> d = load3(b.dx, b.dy, b.dz, i);
    const Vec3<Lanes> org = load3(b.ox, b.oy, b.oz, i);
    const Lanes t = load<Lanes>(b.t + i);
    const Surface<Lanes> f = s.work.in_double
                                 ? surface_in_double(s, i, id, org, d, t)
                                 : surface_of<Lanes>(s.scene, id, org, d, t, s.shading.smooth);
    const Mask<Lanes> inside = dot(d, f.normal) > Lanes(0);
    const Lanes side = select(inside, Lanes(-1), Lanes(1));
    const int h = hits;
    hit.store(b.px + h, b.py + h, b.pz + h, f.point);
    if (s.work.in_double)
      hit.store(b.px_low + h, b.py_low + h, b.pz_low + h, f.low);
    hit.store(b.gx + h, b.gy + h, b.gz + h, side * f.normal);
    hit.store(b.nx + h, b.ny + h, b.nz + h, side * f.shading);
    hit.store(b.vx + h, b.vy + h, b.vz + h, normalize(zero - d));
    hit.store(b.away + h, f.away);
    hit.store(b.inside + h, select(inside, Lanes(1), Lanes(0)));
    hit.store(b.hr + h, b.hg + h, b.hb + h, weight);
    if (keeps_shares(s))
      hit.store(b.hit_share + h, load<Lanes>(b.share + i));
    hit.store(b.hit_pixel + h, load_words<Lanes>(b.pixel + i));
    hit.store(b.hit_depth + h, load_words<Lanes>(b.depth + i));
    hit.store(b.material + h, f.material);
    if (s.work.plan.on) {
      hit.store(b.hit_sample + h, load_words<Lanes>(b.sample + i));
      hit.store(b.hit_path + h, load_words<Lanes>(b.path + i));
    }
    hits += hit.count();
  }
  return hits;
}

/// Which hits the lanes are: i, i + 1, ..., or hit i in each of them. Behind the last hit arrays
/// hold what is old, but valid.
template <bool kOne>
struct HitLanes {
  int i;
  Lanes operator()(const float* of) const {
    if constexpr (kOne)
      return Lanes(of[i]);
    else
      return load<Lanes>(of + i);
  }
  Words<Lanes> operator()(const std::uint32_t* of) const {
    if constexpr (kOne)
      return Words<Lanes>{} + of[i];
    else
      return load_words<Lanes>(of + i);
  }
  Vec3<Lanes> operator()(const float* x, const float* y, const float* z) const {
    return {(*this)(x), (*this)(y), (*this)(z)};
  }
};

/// Lanes of which a component is not 0.
inline Mask<Lanes> any_component(const Vec3<Lanes>& a) {
  return either(either(a.x != Lanes(0), a.y != Lanes(0)), a.z != Lanes(0));
}

/// What the hits' materials hold.
template <bool kOne>
inline Lanes gather(const Shader& s, MaterialField field, const HitLanes<kOne>& at) {
  if constexpr (kOne)
    return Lanes(s.shading.materials.field[field][s.b.material[at.i]]);
  else
    return floats_at(s.shading.materials.field[field], at(s.b.material));
}

template <bool kOne>
inline Vec3<Lanes> gather3(const Shader& s, MaterialField r, const HitLanes<kOne>& at) {
  return {gather(s, r, at),
          gather(s, static_cast<MaterialField>(r + 1), at),
          gather(s, static_cast<MaterialField>(r + 2), at)};
}

/// Tells apart the uses of a pair of dimensions along one path; 0 for the first light, or lobe,
/// that a camera ray meets.
template <class Word>
inline Word sample_keys(Word path, std::uint32_t use) {
  const Word key = scatter(path, use) | 1u;
  return use != 0 ? key : path == 0u ? Word{} : key;
}

/// Numbers for an effect at hits, which takes `count` samples for each of the pixel's: those of
/// numbers `number`.
template <bool kOne>
[[gnu::noinline]] inline PairOf<Lanes> hit_samples(const Shader& s,
                                                   const HitLanes<kOne>& at,
                                                   int dimension,
                                                   std::uint32_t use,
                                                   const Words<Lanes>& number,
                                                   int count,
                                                   const Strata& strata) {
  const Words<Lanes> index = at(s.b.hit_sample) * static_cast<std::uint32_t>(count) + number;
  return sample_pairs<Lanes>(s.work.plan,
                             pixels_of(s.work, at(s.b.hit_pixel)),
                             index,
                             dimension,
                             sample_keys(at(s.b.hit_path), use),
                             strata);
}

/// Points of an area light, of numbers `number` at their hits.
template <bool kOne>
inline Vec3<Lanes> light_points(const Shader& s,
                                const HitLanes<kOne>& at,
                                const Words<Lanes>& number,
                                int light_index) {
  const SamplePlan& plan = s.work.plan;
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const PairOf<Lanes> p = hit_samples(s,
                                      at,
                                      plan.light,
                                      static_cast<std::uint32_t>(light_index),
                                      number,
                                      plan.light_rays,
                                      plan.light_strata);
  const Lanes a = p.u - Lanes(.5f), c = p.v - Lanes(.5f);
  return splat(light) + (a * splat(light + 6) + c * splat(light + 9));
}

/// Rays of several samples of a pixel go together by the hundred; of one sample, those from the
/// camera alone (docs/performance.md).
inline TraceOptions options_for(const Shader& s, Phase phase) {
  const bool near = s.work.plan.on || phase == Phase::primary;
  return {near || s.work.packet < kMiddle ? s.work.packet : kMiddle, s.work.mailbox};
}

template <bool kAny>
inline void trace(const Shader& s, const RayArrays& rays, int count, Phase phase) {
  const TraceOptions options = options_for(s, phase);
  if (const TraceLoops* const loops = s.work.in_double)
    (kAny ? loops->occluded : loops->closest)(s.scene, rays, count, options, s.counters);
  else
    trace<kAny>(s.scene, rays, count, options, s.counters);
}

/// Traces the first n shadow rays of the batch and adds what those carry that nothing stands in the
/// way of.
inline void light_up(const Shader& s, int n) {
  Batch& b = s.b;
  if (n == 0)
    return;
  for (int i = 0; i < n; ++i) {
    b.lt_min[i] = 0;
    b.lt[i] = 1;
  }
  s.rays.shadow += static_cast<unsigned>(n);
  RayArrays rays{b.lox, b.loy, b.loz, b.ldx, b.ldy, b.ldz, b.lt_min, b.lt, b.lid};
  if (s.work.in_double) {
    rays.low[0] = b.lox_low;
    rays.low[1] = b.loy_low;
    rays.low[2] = b.loz_low;
  }
  enter(s.work, Phase::shadow, rays, n);
  trace<true>(s, rays, n, Phase::shadow);
  enter(s.work, Phase::light);
  for (int i = 0; i < n; i += kWidth<Lanes>) {
    const unsigned free =
        bits(mask_of(Words<Lanes>(load_words<Lanes>(b.lid + i) == kNoPrimitive))) & lanes_of(i, n);
    add_light(s.work, b.light_pixel + i, load3(b.lr, b.lg, b.lb, i), free);
  }
}

/// Puts a shadow ray to `to` behind the first n for each of the lanes whose hit faces it; returns
/// how many there are then. `share`: of the light's colour that a ray carries.
template <bool kOne>
inline int send_to_light(const Shader& s,
                         const HitLanes<kOne>& at,
                         const Vec3<Lanes>& to,
                         const float* color,
                         float share,
                         unsigned lanes,
                         int n) {
  Batch& b = s.b;
  const Lanes o(0);
  const Vec3<Lanes> g = at(b.gx, b.gy, b.gz), normal = at(b.nx, b.ny, b.nz);
  Vec3<Lanes> org = at(b.px, b.py, b.pz) + at(b.away) * g;  // the lit side is the viewer's side
  Vec3<Lanes> low{o, o, o};
  if (s.work.in_double) {
    const TwoFloats<Lanes> p = moved_exactly<Lanes>(
        {at(b.px, b.py, b.pz), at(b.px_low, b.py_low, b.pz_low)}, g, at(b.away));
    org = p.high;
    low = p.low;
  }
  const Vec3<Lanes> dir = to - org, l = normalize(dir);
  const Lanes nl = dot(normal, l);
  const Chosen lit(bits(both(nl > o, dot(g, l) > o)) & lanes);
  if (lit.count() == 0)
    return n;
  Vec3<Lanes> c = nl * gather3(s, kDiffuseR, at);
  const Vec3<Lanes> specular =
      s.shading.highlights ? gather3(s, kSpecularR, at) : Vec3<Lanes>{o, o, o};
  if (any(any_component(specular))) {
    const Vec3<Lanes> half = normalize(l + at(b.vx, b.vy, b.vz));
    const Lanes nh = greater(dot(normal, half), o);
    c = c + power(nh, gather(s, kShine, at)) * specular;
  }
  c = Vec3<Lanes>{Lanes(color[0] * share), Lanes(color[1] * share), Lanes(color[2] * share)} *
      (at(b.hr, b.hg, b.hb) * c);
  lit.store(b.lox + n, b.loy + n, b.loz + n, org);
  if (s.work.in_double)
    lit.store(b.lox_low + n, b.loy_low + n, b.loz_low + n, low);
  lit.store(b.ldx + n, b.ldy + n, b.ldz + n, dir);
  lit.store(b.lr + n, b.lg + n, b.lb + n, c);
  lit.store(b.light_pixel + n, at(b.hit_pixel));
  n += lit.count();
  if (n + kWidth<Lanes> <= kBatch)
    return n;
  light_up(s, n);
  return 0;
}

/// Light of one source on all hits: a shadow ray for each that faces it, and what that ray carries
/// if nothing stands in its way; from an area light `light_rays` to each hit, which stand next to
/// each other and carry a share each.
inline void light_hits(const Shader& s, int hits, int light_index, bool area) {
  const float* const light = s.shading.lights + kLightFloats * light_index;
  const int each = area ? s.work.plan.light_rays : 1;
  const float share = 1.f / static_cast<float>(each);
  int n = 0;
  if (each == 1)
    for (int i = 0; i < hits; i += kWidth<Lanes>) {
      const HitLanes<false> at{i};
      n = send_to_light(s,
                        at,
                        area ? light_points(s, at, Words<Lanes>{}, light_index) : splat(light),
                        light + 3,
                        share,
                        lanes_of(i, hits),
                        n);
    }
  else
    for (int i = 0; i < hits; ++i)
      for (int j = 0; j < each; j += kWidth<Lanes>) {
        const HitLanes<true> at{i};
        const Vec3<Lanes> to =
            light_points(s, at, counted_words<Lanes>(static_cast<std::uint32_t>(j)), light_index);
        n = send_to_light(s, at, to, light + 3, share, lanes_of(j, each), n);
      }
  light_up(s, n);
}

/// What a ray carries of its sample: a weight a channel, and its share, see split().
struct Carried {
  Vec3<Lanes> weight;
  Lanes share;
};

/// Puts the rays of the chosen hits i, i + 1, ... on the stack.
inline void push(const Shader& s,
                 RayStack& stack,
                 int i,
                 const Chosen& chosen,
                 const Vec3<Lanes>& dir,
                 const Carried& carried,
                 std::uint32_t kind,
                 std::uint32_t branch) {
  Batch& b = s.b;
  const int to = stack.size;
  const Vec3<Lanes> point = load3(b.px, b.py, b.pz, i), g = load3(b.gx, b.gy, b.gz, i);
  const Lanes away = load<Lanes>(b.away + i);
  if (s.work.in_double) {
    const Lanes by = select(dot(dir, g) < Lanes(0), Lanes(0) - away, away);
    const TwoFloats<Lanes> p =
        moved_exactly<Lanes>({point, load3(b.px_low, b.py_low, b.pz_low, i)}, g, by);
    chosen.store(stack.ox + to, stack.oy + to, stack.oz + to, p.high);
    chosen.store(stack.ox_low + to, stack.oy_low + to, stack.oz_low + to, p.low);
  } else {
    chosen.store(stack.ox + to, stack.oy + to, stack.oz + to, leave(point, g, away, dir));
  }
  chosen.store(stack.dx + to, stack.dy + to, stack.dz + to, dir);
  chosen.store(stack.wr + to, stack.wg + to, stack.wb + to, carried.weight);
  if (keeps_shares(s))
    chosen.store(stack.share + to, carried.share);
  chosen.store(stack.pixel + to, load_words<Lanes>(b.hit_pixel + i));
  chosen.store(stack.depth + to, (load_words<Lanes>(b.hit_depth + i) + 1u) | kind);
  if (s.work.plan.on) {
    chosen.store(stack.sample + to, load_words<Lanes>(b.hit_sample + i));
    chosen.store(stack.path + to,
                 scatter(load_words<Lanes>(b.hit_path + i), branch + (kind != 0 ? 0x10001u : 1u)));
  }
  stack.size += chosen.count();
  (kind != 0 ? s.rays.refraction : s.rays.reflection) += static_cast<unsigned>(chosen.count());
}

/// Directions in the lobes of the rough mirrors at the hits i, i + 1, ...: the unit mirror
/// directions moved within a disc across them, kept above the surface. Each takes `rays` of them;
/// this is the `ray`-th.
[[gnu::noinline]] inline Vec3<Lanes> lobe_directions(
    const Shader& s, int i, const Vec3<Lanes>& mirror, const Lanes& roughness, int ray, int rays) {
  const SamplePlan& plan = s.work.plan;
  const Words<Lanes> number = Words<Lanes>{} + static_cast<std::uint32_t>(ray);
  const PairOf<Lanes> d = disc_point(
      hit_samples(s, HitLanes<false>{i}, plan.gloss, 0, number, rays, plan.gloss_strata));
  Vec3<Lanes> u, v;
  across(mirror, u, v);
  const Vec3<Lanes> to = mirror + (roughness * d.u) * u + (roughness * d.v) * v,
                    g = load3(s.b.gx, s.b.gy, s.b.gz, i);
  const Lanes under = dot(to, g);
  return normalize(select(under < Lanes(0), to - (under + under) * g, to));
}

/// What the reflected and the refracted ray of a hit carry; `up`, `down`: what the material sends
/// on of what it gets.
///
/// By its share a ray goes on or ends. It is the weight of the brightest channel, but for two
/// cases: of a material that sends on more than it gets the two have shares of one, so that all
/// shares of a sample together never grow, and rays that fan out in a lobe have the share of one in
/// their place, since they end together.
inline void split(const Shader& s,
                  int i,
                  const Vec3<Lanes>& up,
                  const Vec3<Lanes>& down,
                  Carried& reflected,
                  Carried& refracted) {
  const Vec3<Lanes> w = load3(s.b.hr, s.b.hg, s.b.hb, i);
  reflected.weight = w * up;
  refracted.weight = w * down;
  reflected.share = largest(reflected.weight);
  refracted.share = largest(refracted.weight);
  if (!keeps_shares(s))
    return;
  const Lanes r = largest(up), t = largest(down),
              share = load<Lanes>(s.b.hit_share + i) / greater(r + t, Lanes(1));
  reflected.share = share * r;
  refracted.share = share * t;
}

/// Least weights that a fan of rays in a lobe must have together; else one goes in its place.
inline constexpr float kFanWeights = 8;

/// Sends the reflected and refracted rays of all hits. At the end of the longest path they see the
/// background, and where what they could bring is less than would show; docs/sampling.md derives
/// how much less.
inline void send_on(const Shader& s, RayStack& stack, int hits) {
  Batch& b = s.b;
  const Vec3<Lanes> background = splat(s.shading.background);
  const Words<Lanes> last = Words<Lanes>{} + static_cast<std::uint32_t>(s.work.depth);
  const Lanes o(0), one(1), least(s.work.min_weight / s.shading.brightest);
  const int around = s.work.plan.gloss_rays;
  const float part = 1.f / static_cast<float>(around + 1);
  for (int i = 0; i < hits; i += kWidth<Lanes>) {
    const HitLanes<false> at{i};
    const Vec3<Lanes> mirror = gather3(s, kMirrorR, at);
    const Lanes t = s.shading.refracts ? gather(s, kTransmission, at) : o;
    if (none(either(any_component(mirror), t > o)))
      continue;
    const Vec3<Lanes> n = load3(b.nx, b.ny, b.nz, i), g = load3(b.gx, b.gy, b.gz, i),
                      v = load3(b.vx, b.vy, b.vz, i);
    Vec3<Lanes> up = mirror;
    Vec3<Lanes> down{o, o, o}, through{o, o, o};
    const Lanes nv = dot(n, v);
    if (s.shading.refracts) {
      const Lanes ior = gather(s, kIor, at);
      const Mask<Lanes> clear = t > o, inside = load<Lanes>(b.inside + i) > o;
      const Lanes eta = select(inside, ior, one / ior);
      // Snell: cos^2 on the other side
      const Lanes c1 = greater(nv, o), left = one - (eta * eta) * (one - c1 * c1);
      const Mask<Lanes> passes = left >= o;
      const Lanes c2 = square_root(greater(left, o));
      through = (eta * c1 - c2) * n - eta * v;
      Lanes tw = t;
      Vec3<Lanes> rw = mirror;
      if (s.shading.fresnel) {
        const Mask<Lanes> schlick = gather(s, kFresnel, at) > o;
        const Lanes r = (ior - one) / (ior + one), r0 = r * r;
        // the angle on the thinner side
        const Lanes c = one - select(eta > one, c2, c1), cc = c * c;
        const Lanes kr = r0 + (one - r0) * ((cc * cc) * c);
        tw = select(schlick, one - kr, tw);
        rw = select(schlick, Vec3<Lanes>{kr, kr, kr}, rw);
      }
      const Mask<Lanes> refracted = both(clear, passes), total = but_not(clear, passes);
      tw = select(refracted, tw, o);
      down = {tw, tw, tw};
      // On total reflection the mirror ray takes over what would have passed.
      const Mask<Lanes> additive = gather(s, kFresnel, at) == o;
      const Lanes all = select(additive, t, o), whole = select(additive, o, one);
      up = select(clear, rw, up);
      up = select(total,
                  select(additive,
                         Vec3<Lanes>{up.x + all, up.y + all, up.z + all},
                         Vec3<Lanes>{whole, whole, whole}),
                  up);
    }
    Carried reflection, refraction;
    split(s, i, up, down, reflection, refraction);
    Vec3<Lanes> reflected = (nv + nv) * n - v;
    // A smooth normal can send a reflection under the true surface; bend it back above.
    const Lanes under = lesser(dot(reflected, g), o);
    reflected = reflected - (under + under) * g;
    const unsigned in = lanes_of(i, hits);
    const unsigned mirrors = bits(any_component(reflection.weight)) & in;
    const unsigned clears = bits(any_component(refraction.weight)) & in;
    if ((mirrors | clears) == 0)
      continue;
    const unsigned end = bits(mask_of(Words<Lanes>(load_words<Lanes>(b.hit_depth + i) >= last)));
    const unsigned mirrors_end = end | bits(reflection.share < least),
                   clears_end = end | bits(refraction.share < least);
    add_light(s.work, b.hit_pixel + i, reflection.weight * background, mirrors & mirrors_end);
    add_light(s.work, b.hit_pixel + i, refraction.weight * background, clears & clears_end);
    const Chosen on_mirrors(mirrors & ~mirrors_end), on_clears(clears & ~clears_end);
    Mask<Lanes> rough = o != o;
    if (s.shading.gloss)
      rough = gather(s, kRoughness, at) > o;
    const Mask<Lanes> many =
        around == 0 ? o != o
                    : but_not(rough, largest(reflection.weight) < Lanes(kFanWeights) * least);
    const Chosen on_rough(bits(rough) & mirrors & ~mirrors_end),
        on_many(bits(many) & mirrors & ~mirrors_end);
    const Lanes roughness = on_rough.count() != 0 ? gather(s, kRoughness, at) : o;
    Vec3<Lanes> first = reflected;
    if (on_rough.count() != on_many.count())
      first = select(
          but_not(rough, many), lobe_directions(s, i, reflected, roughness, 0, 1), reflected);
    push(s,
         stack,
         i,
         on_mirrors,
         first,
         {select(many, Lanes(part), one) * reflection.weight, reflection.share},
         0,
         0);
    push(s, stack, i, on_clears, through, refraction, kRefracted, 0);
    // the rays around the mirror direction
    for (int j = 0; j < around && on_many.count() != 0; ++j)
      push(s,
           stack,
           i,
           on_many,
           lobe_directions(s, i, reflected, roughness, j, around),
           {Lanes(part) * reflection.weight, reflection.share},
           0,
           static_cast<std::uint32_t>(j + 1));
  }
}

/// Traces and shades the batch: runs of rays that go together, the k-th ending at ends[k]. `phase`:
/// primary or bounce.
inline void shade_batch(const Shader& s, RayStack& stack, const int* ends, int runs, Phase phase) {
  Batch& b = s.b;
  const int count = ends[runs - 1];
  for (int i = 0; i < count; ++i) {
    b.t_min[i] = 0;
    b.t[i] = kInfinity;
  }
  for (int k = 0, at = 0; k < runs; at = ends[k++]) {
    RayArrays rays{b.ox + at,
                   b.oy + at,
                   b.oz + at,
                   b.dx + at,
                   b.dy + at,
                   b.dz + at,
                   b.t_min + at,
                   b.t + at,
                   b.id + at};
    if (s.work.in_double) {
      rays.low[0] = b.ox_low + at;
      rays.low[1] = b.oy_low + at;
      rays.low[2] = b.oz_low + at;
      rays.whole = b.whole + at;
    }
    enter(s.work, phase, rays, ends[k] - at);
    trace<false>(s, rays, ends[k] - at, phase);
  }
  enter(s.work, Phase::surface);
  const int hits = find_surfaces(s, count);
  if (hits == 0)
    return;
  if (s.shading.emits)
    for (int i = 0; i < hits; i += kWidth<Lanes>)
      add_light(s.work,
                b.hit_pixel + i,
                load3(b.hr, b.hg, b.hb, i) * gather3(s, kEmissionR, HitLanes<false>{i}),
                lanes_of(i, hits));
  enter(s.work, Phase::light);
  for (int l = 0; l < s.shading.light_count; ++l) {
    const float* const edges = s.shading.lights + kLightFloats * l + 6;
    bool area = false;
    for (int k = 0; s.shading.area && k < 6; ++k)
      area |= edges[k] != 0;
    light_hits(s, hits, l, area);
  }
  enter(s.work, Phase::children);
  if (s.shading.reflects)
    send_on(s, stack, hits);
}

}  // namespace grelha::GRELHA_ISA
