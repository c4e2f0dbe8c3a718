#pragma once
// The functions of lanes.hpp for doubles. Spelled out, as xsimd's own templates of the same names
// would be as good a match for one over both. Included by lanes.hpp, in its place.

namespace grelha::GRELHA_ISA {

template <class A>
inline SimdDouble<A> select(const SimdDoubleMask<A>& m,
                            const SimdDouble<A>& a,
                            const SimdDouble<A>& b) {
  return xsimd::select(m, a, b);
}
template <class A>
inline SimdDoubleMask<A> both(const SimdDoubleMask<A>& a, const SimdDoubleMask<A>& b) {
  return a & b;
}
template <class A>
inline SimdDoubleMask<A> either(const SimdDoubleMask<A>& a, const SimdDoubleMask<A>& b) {
  return a | b;
}
template <class A>
inline SimdDouble<A> square_root(const SimdDouble<A>& a) {
  return xsimd::sqrt(a);
}
template <class A>
inline void load(const double* p, SimdDouble<A>& r) {
  r = SimdDouble<A>::load_unaligned(p);
}
template <class A>
inline void store(double* p, const SimdDouble<A>& a) {
  a.store_unaligned(p);
}
#if GRELHA_ISA_NUMBER == 2
inline DoubleLanes lesser(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm_min_pd(a.data, b.data));
}
inline DoubleLanes greater(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm_max_pd(a.data, b.data));
}
inline unsigned bits(const LaneTraits<DoubleLanes>::Mask& m) {
  return unsigned(_mm_movemask_pd(m.data));
}
inline LaneTraits<DoubleLanes>::Mask but_not(const LaneTraits<DoubleLanes>::Mask& a,
                                             const LaneTraits<DoubleLanes>::Mask& b) {
  return LaneTraits<DoubleLanes>::Mask(_mm_andnot_pd(b.data, a.data));
}
#elif GRELHA_ISA_NUMBER == 3
inline DoubleLanes lesser(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm256_min_pd(a.data, b.data));
}
inline DoubleLanes greater(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm256_max_pd(a.data, b.data));
}
inline unsigned bits(const LaneTraits<DoubleLanes>::Mask& m) {
  return unsigned(_mm256_movemask_pd(m.data));
}
inline LaneTraits<DoubleLanes>::Mask but_not(const LaneTraits<DoubleLanes>::Mask& a,
                                             const LaneTraits<DoubleLanes>::Mask& b) {
  return LaneTraits<DoubleLanes>::Mask(_mm256_andnot_pd(b.data, a.data));
}
#else
inline DoubleLanes lesser(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm512_min_pd(a.data, b.data));
}
inline DoubleLanes greater(const DoubleLanes& a, const DoubleLanes& b) {
  return DoubleLanes(_mm512_max_pd(a.data, b.data));
}
inline unsigned bits(const LaneTraits<DoubleLanes>::Mask& m) { return unsigned(m.data); }
inline LaneTraits<DoubleLanes>::Mask but_not(const LaneTraits<DoubleLanes>::Mask& a,
                                             const LaneTraits<DoubleLanes>::Mask& b) {
  return LaneTraits<DoubleLanes>::Mask(static_cast<__mmask8>(a.data & ~b.data));
}
#endif

template <class A>
inline bool any(const SimdDoubleMask<A>& m) {
  return bits(m) != 0;
}
template <class A>
inline bool none(const SimdDoubleMask<A>& m) {
  return bits(m) == 0;
}

}  // namespace grelha::GRELHA_ISA
