// Compiled once per instruction set, see CMakeLists.txt: GRELHA_ISA names it, GRELHA_FUSED is set
// where products and sums may fuse.
#define GRELHA_ISA_avx2_fused 3
#define GRELHA_ISA_avx512_fused 4
#include "perf/precision_loops.hpp"

#include "kernel/triangle/triangle.hpp"

namespace grelha::GRELHA_ISA {
namespace {

/// Source  Möller & Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
template <class Real>
inline Mask<Real> hit_moeller_trumbore(const Vec3<Real>& org,
                                       const Vec3<Real>& dir,
                                       const Vec3<Real>& a,
                                       const Vec3<Real>& b,
                                       const Vec3<Real>& c,
                                       Real& t) {
  const Real o(0), one(1);
  const Vec3<Real> e1 = b - a, e2 = c - a, p = cross(dir, e2), s = org - a, q = cross(s, e1);
  const Real det = dot(e1, p), inverse = one / det;
  const Real u = dot(s, p) * inverse, v = dot(dir, q) * inverse;
  t = dot(e2, q) * inverse;
  return both(both(both(u >= o, v >= o), both(u + v <= one, det != o)), t > o);
}

template <class Real>
inline Real widened(const float* p) {
  Scalar<Real> v[kWidth<Real>];
  for (int i = 0; i < kWidth<Real>; ++i)
    v[i] = static_cast<Scalar<Real>>(p[i]);
  return load<Real>(v);
}

template <class Real, bool kWatertight>
void loop(const perf::Pairs& pairs, perf::PairHits& hits) {
  using perf::kGroup;
  for (int g = 0; g < pairs.groups(); ++g) {
    const int k = pairs.axis[static_cast<std::size_t>(g)], kx = k == 2 ? 0 : k + 1,
              ky = k == 0 ? 2 : k - 1;
    const int permuted[3] = {kx, ky, k};
    for (int lane = 0; lane < kGroup; lane += kWidth<Real>) {
      const int at = g * kGroup + lane;
      const auto ray = [&](const std::vector<float>(&v)[3]) {
        return Vec3<Real>{widened<Real>(&v[kx][static_cast<std::size_t>(at)]),
                          widened<Real>(&v[ky][static_cast<std::size_t>(at)]),
                          widened<Real>(&v[k][static_cast<std::size_t>(at)])};
      };
      const Vec3<Real> org = ray(pairs.org), dir = ray(pairs.dir);
      const Shear<Real> shear{dir.x / dir.z, dir.y / dir.z, Real(1) / dir.z};
      Real best(1e30f), which(-1);
      for (int i = 0; i < kGroup; ++i) {
        const std::size_t from = static_cast<std::size_t>(g * kGroup + i);
        const auto corner = [&](const std::vector<float>(&v)[3]) {
          return Vec3<Real>{
              Real(v[permuted[0]][from]), Real(v[permuted[1]][from]), Real(v[permuted[2]][from])};
        };
        const auto ray_and_triangle = [&] {
          return RayAndTriangle<Real>{
              org, dir, {corner(pairs.a), corner(pairs.b), corner(pairs.c)}};
        };
        Real t(0);
        Mask<Real> hit;
        if constexpr (kWatertight)
          hit = hit_triangle<false>(ray_and_triangle, shear, Real(0), best, t);
        else
          hit = hit_moeller_trumbore<Real>(
              org, dir, corner(pairs.a), corner(pairs.b), corner(pairs.c), t);
        hit = both(hit, t < best);
        if (none(hit))
          continue;
        best = select(hit, t, best);
        which = select(hit, Real(static_cast<float>(i)), which);
      }
      Scalar<Real> t[kWidth<Real>], id[kWidth<Real>];
      store(t, best);
      store(id, which);
      for (int i = 0; i < kWidth<Real>; ++i) {
        hits.t[static_cast<std::size_t>(at + i)] = static_cast<double>(t[i]);
        hits.triangle[static_cast<std::size_t>(at + i)] = static_cast<int>(id[i]);
      }
    }
  }
}

bool runs_here() {
#if GRELHA_ISA_NUMBER == 3
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#elif GRELHA_ISA_NUMBER == 4
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
  return true;
#endif
}

}  // namespace
}  // namespace grelha::GRELHA_ISA

#define GRELHA_TEXT_(x) #x
#define GRELHA_TEXT(x) GRELHA_TEXT_(x)
#ifdef GRELHA_FUSED
#define GRELHA_IS_FUSED true
#else
#define GRELHA_IS_FUSED false
#endif

namespace grelha::perf {
const PrecisionLoops GRELHA_JOIN(GRELHA_JOIN(k_, GRELHA_ISA), _precision) = {
    GRELHA_TEXT(GRELHA_ISA_NAME),
    GRELHA_IS_FUSED,
    GRELHA_ISA::runs_here,
    {{GRELHA_ISA::loop<GRELHA_ISA::Lanes, false>, GRELHA_ISA::loop<GRELHA_ISA::Lanes, true>},
     {GRELHA_ISA::loop<GRELHA_ISA::DoubleLanes, false>,
      GRELHA_ISA::loop<GRELHA_ISA::DoubleLanes, true>}}};
}  // namespace grelha::perf
