#pragma once
// Embree 3 or 4, whichever CMake found, by the same names: each takes hints about rays in its own
// way.

#if GRELHA_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace grelha::perf {

#if GRELHA_EMBREE >= 4

/// The hints that Embree gets with a query: arguments or a context.
struct EmbreeHint {
  RTCIntersectArguments closest;
  RTCOccludedArguments any;

  explicit EmbreeHint(bool coherent) {
    rtcInitIntersectArguments(&closest);
    rtcInitOccludedArguments(&any);
    closest.flags = any.flags =
        coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  }
};

/// Finds the nearest hit of one ray, or of the rays of a packet whose element in `valid` is -1.
inline void intersect(RTCScene s, EmbreeHint& hint, RTCRayHit& r) {
  rtcIntersect1(s, &r, &hint.closest);
}
inline void intersect(const int* valid, RTCScene s, EmbreeHint& hint, RTCRayHit8& r) {
  rtcIntersect8(valid, s, &r, &hint.closest);
}
inline void intersect(const int* valid, RTCScene s, EmbreeHint& hint, RTCRayHit16& r) {
  rtcIntersect16(valid, s, &r, &hint.closest);
}
/// Tests the rays for occlusion: tfar is -infinity after a hit.
inline void occlude(RTCScene s, EmbreeHint& hint, RTCRay& r) {
  rtcOccluded1(s, &r, &hint.any);
}
inline void occlude(const int* valid, RTCScene s, EmbreeHint& hint, RTCRay8& r) {
  rtcOccluded8(valid, s, &r, &hint.any);
}
inline void occlude(const int* valid, RTCScene s, EmbreeHint& hint, RTCRay16& r) {
  rtcOccluded16(valid, s, &r, &hint.any);
}

#else

struct EmbreeHint {
  RTCIntersectContext context;

  explicit EmbreeHint(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
};

inline void intersect(RTCScene s, EmbreeHint& hint, RTCRayHit& r) {
  rtcIntersect1(s, &hint.context, &r);
}
inline void intersect(const int* valid, RTCScene s, EmbreeHint& hint, RTCRayHit8& r) {
  rtcIntersect8(valid, s, &hint.context, &r);
}
inline void intersect(const int* valid, RTCScene s, EmbreeHint& hint, RTCRayHit16& r) {
  rtcIntersect16(valid, s, &hint.context, &r);
}
inline void occlude(RTCScene s, EmbreeHint& hint, RTCRay& r) {
  rtcOccluded1(s, &hint.context, &r);
}
inline void occlude(const int* valid, RTCScene s, EmbreeHint& hint, RTCRay8& r) {
  rtcOccluded8(valid, s, &hint.context, &r);
}
inline void occlude(const int* valid, RTCScene s, EmbreeHint& hint, RTCRay16& r) {
  rtcOccluded16(valid, s, &hint.context, &r);
}

#endif

}  // namespace grelha::perf
